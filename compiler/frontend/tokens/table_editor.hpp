// SPDX-License-Identifier: MIT
//
// The attribute [[table(lo, hi, n, linear)]] in front of a helper function. Its numbers, which are any constant expressions,
// become constants in front of the function.
#pragma once

#include <optional>
#include <vector>

#include "frontend/tokens/syntax.hpp"
#include "frontend/tokens/token_cursor.hpp"
#include "frontend/tokens/token_maker.hpp"
#include "support/diagnostics.hpp"

namespace skc::frontend {

/// Whether the attributes that follow begin with one of a table.
bool namesTable(const TokenCursor& cursor);

/// Takes the attributes that follow, which are so many tokens, and adds the constants to `out`; nothing, and told, where they
/// are not one of a table as it should be. `constants` counts those of the file.
std::optional<TableSyntax> takeTable(TokenCursor& cursor, std::size_t tokens, const TokenMaker& maker,
                                     Diagnostics& diagnostics, int& constants,
                                     std::vector<clang::Token>& out);

}  // namespace skc::frontend
