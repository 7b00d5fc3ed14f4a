// SPDX-License-Identifier: MIT
//
// Loops with a constant trip count: `for (int i = 0; i < 5; ++i)`, where the body does not change i.
#pragma once

#include <cstdint>
#include <optional>

#include "ir/ir.hpp"

namespace skc::ir {

/// True if the trip count is the same for every element, unless the loop is left early.
bool isCounted(const Module& module, const Loop& loop);

/// The counter of a counted loop over integers: `first`, first + step, ..., `count` values in all.
struct CountedLoop {
  VarId counter;
  Type type;
  std::int64_t first, step, count;

  /// The counter's value in iteration `iteration`, from 0, as an expression.
  ExprPtr value(std::int64_t iteration, Loc loc = {}) const;
};

/// Returns nullopt if the loop is not counted or does not end.
std::optional<CountedLoop> countedLoop(const Module& module, const Loop& loop);

/// The trip count of a counted loop over integers, unless it is left early; nullopt if the loop is not
/// counted or does not end.
std::optional<std::int64_t> tripCount(const Module& module, const Loop& loop);

}  // namespace skc::ir
