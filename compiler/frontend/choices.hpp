// SPDX-License-Identifier: MIT
//
// Attributes in front of a kernel: [[precision(extended), accumulate(exact), intrinsics(fast)]].
#pragma once

#include <cstddef>

#include "frontend/tokens/token_cursor.hpp"
#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc::frontend {

/// How many tokens the attributes are that follow, [[...]] [[...]]; 0 where there are none.
std::size_t endOfChoices(const TokenCursor& cursor);

/// Whether the first of them is one of these, and none of C++'s.
bool namesChoice(const TokenCursor& cursor);

/// Takes all of them, which are so many tokens; tells what is wrong.
ir::Choices takeChoices(TokenCursor& cursor, std::size_t tokens, Diagnostics& diagnostics);

}  // namespace skc::frontend
