// SPDX-License-Identifier: MIT
//
// Makes floats of floating-point literals without suffix, by giving their tokens one. Clang's own option,
// -cl-single-precision-constant, casts them instead, and templates forget that cast.
//
//   x * 2.5     ->     x * 2.5f            at the place of `2.5`, where the source still says so
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <clang/Lex/Token.h>

namespace clang {
class Preprocessor;
}

namespace skc::frontend {

void suffixFloats(std::vector<clang::Token>& tokens, clang::Preprocessor& preprocessor);

/// A floating-point literal without its digit separators and its suffix, and that suffix.
struct LiteralParts {
  std::string digits;
  std::string_view suffix;   ///< "", "f", "F", "l" or "L"; static
};
LiteralParts literalParts(std::string text);

}  // namespace skc::frontend
