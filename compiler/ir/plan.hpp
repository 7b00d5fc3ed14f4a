// SPDX-License-Identifier: MIT
//
// Plans: the passes by which a kernel runs that exceeds the limits of a target (split/plan_passes.hpp).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ir/type.hpp"

namespace skc::ir {

using KernelId = std::uint32_t;

/// What a target can read and write in one pass.
struct Limits {
  std::uint32_t drawBuffers = 0;  ///< planes that a pass may write
  std::uint32_t textureUnits = 0;  ///< planes that a pass may read
  bool operator==(const Limits&) const = default;
};

/// A value that one pass of a plan writes and later ones read: a local variable of the whole kernel.
struct Temporary {
  std::string name;
  Type type;
  double computeCost;  ///< cost of computing it once, see split/cost.hpp
  std::uint32_t readers;  ///< passes that read it
};

/// The argument for a parameter of a pass: an argument of the whole kernel, or a temporary.
struct PassOperand {
  bool isTemporary;
  std::uint32_t index;
};
struct Pass {
  KernelId kernel;  ///< Kernel::pass is set there
  std::vector<PassOperand> operands;  ///< one per parameter
  double cost;
};

/// A plane of an argument of the whole kernel.
struct ArgumentPlane {
  std::uint32_t argument, plane;
  bool operator==(const ArgumentPlane&) const = default;
};
/// Planes of one texel format that are copied to the layers of one texture, and so share a texture unit.
struct Stack {
  Type type;
  std::vector<ArgumentPlane> layers;
};

/// The passes, in order, by which a kernel runs that exceeds the limits of a target.
struct Plan {
  Limits limits;  ///< what its passes need
  std::vector<Temporary> temporaries;
  std::vector<Stack> stacks;
  std::vector<Pass> passes;
  double cost = 0;
  double costWithoutTemporaries = 0;  ///< if every value were computed wherever it is needed
};

}  // namespace skc::ir
