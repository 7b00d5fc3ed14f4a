// SPDX-License-Identifier: MIT
//
// Estimates what code costs, or how large it is, relative to an operation on one component. Each question brings its own weights
// and limit. (What a pass of a kernel costs, with its memory and trip counts, is estimated in split/cost.hpp.)
#pragma once

#include <cstdint>
#include <span>

#include "ir/ir.hpp"

namespace skc::ir {

struct OpWeights {
  std::uint32_t node = 0;  ///< of every expression
  std::uint32_t operation = 0, intrinsic = 0;  ///< for each component
  std::uint32_t gather = 0, sample = 0;  ///< of one read
  std::uint32_t append = 0;  ///< of a Push, Scatter or Print
  bool countsCalls = true;  ///< a function weighs at each of its calls; else once
};

/// True for what processors compute with an instruction or a few: a Unary, Binary, Select or Convert.
bool isOperation(const Expr& expr);

/// The weight of statements and of the functions that they call. At most `limit`, which a loop weighs, too.
std::uint32_t weigh(const Module& module, std::span<const Stmt> statements, const OpWeights& weights,
                    std::uint32_t limit);

}  // namespace skc::ir
