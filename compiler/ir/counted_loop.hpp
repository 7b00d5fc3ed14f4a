// SPDX-License-Identifier: MIT
//
// Loops whose number of rounds is written in the program: `for (int i = 0; i < 5; ++i)` with constants,
// i untouched inside.
#pragma once

#include <cstdint>
#include <optional>

#include "ir/ir.hpp"

namespace skc::ir {

/// Whether a loop takes as many rounds for any element, unless it is left early.
bool isCounted(const Module& module, const Loop& loop);

/// The counter of a counted loop over integers: `first` in the first of `count` rounds, then `step` more in each.
struct Rounds {
  VarId counter;
  Type type;
  std::int64_t first, step, count;

  /// The counter in round number `round`, as an expression.
  ExprPtr value(std::int64_t round, Loc loc = {}) const;
};

/// None where a loop is not counted, or does not end.
std::optional<Rounds> roundsIn(const Module& module, const Loop& loop);

/// How many rounds a counted loop over integers takes, unless it is left early. None where it is no such
/// loop, or does not end.
std::optional<std::int64_t> roundsOf(const Module& module, const Loop& loop);

}  // namespace skc::ir
