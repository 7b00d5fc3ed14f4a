// SPDX-License-Identifier: MIT
//
// Runs cases on the devices of a process.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "numbers/bounds.hpp"
#include "numbers/case.hpp"
#include "sk/sk.hpp"

namespace fuzz::numbers {

/// The names of targets: native, glsl330, glsl430, essl300, essl310, webgl2.
extern const std::vector<std::string> targetNames;

/// Whether a target can run a case: some have no doubles, rows, or contraction.
bool canRun(const std::string& target, const Case& one);

/// Whether a case folds to values, and not to streams.
bool isToValue(const Case& one);
/// The shapes of the streams that a case writes.
std::vector<std::vector<std::int64_t>> outputShapes(const Case& one);

Arithmetic arithmeticOf(const std::string& target, const Case& one);

class Devices {
 public:
  /// The results of a case: a list for each output. Throws sk::Error.
  std::vector<Values> run(const std::string& target, const Case& one);
  /// How a target computes a case. Whether it rounds quotients is tried once.
  Arithmetic arithmetic(const std::string& target, const Case& one);

 private:
  bool roundsQuotients(const std::string& target);
  sk::Device& device(const std::string& target, const Case& one);

  std::map<std::string, sk::Device> devices_;
  std::map<std::string, bool> roundsQuotients_;
};

}  // namespace fuzz::numbers
