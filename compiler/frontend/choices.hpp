// SPDX-License-Identifier: MIT
//
// Parses the attributes in front of a kernel: [[precision(extended), accumulate(exact), intrinsics(fast), variants(views, half)]].
#pragma once

#include <cstddef>

#include "frontend/tokens/token_cursor.hpp"
#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc::frontend {

/// The number of tokens in the attributes that follow, [[...]] [[...]]; 0 if there are none.
std::size_t endOfChoices(const TokenCursor& cursor);

/// True if the first attribute is one of these, not one of C++'s.
bool namesChoice(const TokenCursor& cursor);

/// Consumes the attributes, `tokens` tokens in all, and reports errors in them.
ir::Choices takeChoices(TokenCursor& cursor, std::size_t tokens, Diagnostics& diagnostics);

}  // namespace skc::frontend
