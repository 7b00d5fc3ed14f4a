// SPDX-License-Identifier: MIT
//
// The sums of floats of a reduce: accumulators, or members of them, that elements are added to, and that partial results
// are added to as well, whether the compiler or the author says how they combine. What else the reduce does to other
// members does not matter.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/ir.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {

/// A float or a vector of them.
struct FloatSum {
  ir::VarId accumulator;
  std::vector<std::uint32_t> members;  ///< way from the accumulator to it
  ir::Type type;
  unsigned components;  ///< bit i: component i is a sum; the others are not folded by +

  /// Whether a part of a fold is of its components.
  bool holds(const FoldPart& part) const;
};

/// Those of a reduce, in the order of its parameters and of their members. All that its statements do to them is to add what
/// is made from no accumulator, outside of the heads of loops, and all that what combines does is to add those of its
/// inputs.
std::vector<FloatSum> floatSums(const ir::Module& module, ir::KernelId id);

/// The same of one accumulator of a reduce: that of another reduce with the same number.
ir::VarId sameAccumulator(const ir::Kernel& of, ir::VarId accumulator, const ir::Kernel& in);

}  // namespace skc
