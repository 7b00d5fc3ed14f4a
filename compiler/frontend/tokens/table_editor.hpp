// SPDX-License-Identifier: MIT
//
// Edits the attribute [[table(lo, hi, n, linear)]] in front of a helper function. Its arguments may be any
// constant expressions; they become constants in front of the function.
#pragma once

#include <optional>
#include <vector>

#include "frontend/tokens/syntax.hpp"
#include "frontend/tokens/token_cursor.hpp"
#include "support/diagnostics.hpp"

namespace skc::frontend {

/// True if the attributes that follow begin with a table.
bool namesTable(const TokenCursor& cursor);

/// Consumes `tokens` attribute tokens and appends the constants to `out`; returns nullopt after reporting an
/// error. `constants` numbers the file's generated constants.
std::optional<TableSyntax> takeTable(TokenCursor& cursor, std::size_t tokens, const TokenBuilder& builder,
                                     Diagnostics& diagnostics, int& constants,
                                     std::vector<clang::Token>& out);

}  // namespace skc::frontend
