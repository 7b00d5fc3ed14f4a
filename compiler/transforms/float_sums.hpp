// SPDX-License-Identifier: MIT
//
// Finds the float sums of a reduce: accumulators, or members of them, to which elements are added, and to
// which partial results are added as well, whether the compiler or the author combines them. Other members
// may be folded in any way.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/ir.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {

/// A float or a vector of floats.
struct FloatSum {
  ir::VarId accumulator;
  std::vector<std::uint32_t> members;  ///< path from the accumulator
  ir::Type type;
  unsigned components;  ///< bit i: component i is a sum; other components are not folded by +

  /// True if a part of a fold consists of components of this sum.
  bool holds(const FoldPart& part) const;
};

/// The sums of a reduce, in the order of its parameters and their members. Outside of loop heads, the
/// reduce's statements only add values to them that depend on no accumulator, and the combining reduce only
/// adds the corresponding inputs.
std::vector<FloatSum> floatSums(const ir::Module& module, ir::KernelId id);

/// Maps an accumulator of one reduce to the accumulator of another with the same number.
ir::VarId sameAccumulator(const ir::Kernel& of, ir::VarId accumulator, const ir::Kernel& in);

}  // namespace skc
