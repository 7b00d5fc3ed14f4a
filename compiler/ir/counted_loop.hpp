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

/// How many rounds a counted loop over integers takes, unless it is left early. None where it is no such
/// loop, or does not end.
std::optional<std::int64_t> roundsOf(const Module& module, const Loop& loop);

}  // namespace skc::ir
