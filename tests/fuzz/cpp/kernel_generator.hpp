// SPDX-License-Identifier: MIT
//
// Generates kernels: with parameters of every kind, of any rank, and such as other kernels call.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cpp/body.hpp"
#include "cpp/generator.hpp"
#include "cpp/stream_types.hpp"

namespace fuzz::cpp {

class KernelGenerator {
 public:
  KernelGenerator(Unit& unit, const StreamTypes& streams, Program& program)
      : unit_(unit), random_(unit.random), types_(unit.types), streams_(streams), program_(program) {}

  /// Kernel `number` calls the functions that no kernel has called before, as far as there is room.
  void addKernel(int number);
  /// A kernel that others call.
  void addInnerKernel();

 private:
  std::vector<Field> pickParameters(bool isOfAnyRank);
  void declareKernel(Body& body, const std::vector<Field>& parameters);
  std::string run(const std::string& name, const std::vector<Field>& parameters, int rank) const;
  void add(NodePtr node) { program_.root->children.push_back(std::move(node)); }

  Unit& unit_;
  Random& random_;
  Types& types_;
  const StreamTypes& streams_;
  Program& program_;
};

}  // namespace fuzz::cpp
