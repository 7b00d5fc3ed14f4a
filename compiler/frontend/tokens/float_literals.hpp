// SPDX-License-Identifier: MIT
//
// Makes floating-point literals without a suffix floats, by adding a suffix to their tokens. Clang's own
// option, -cl-single-precision-constant, casts them instead, and templates forget that cast.
//
//   x * 2.5     ->     x * 2.5f            with the source location of `2.5`
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

/// A floating-point literal without digit separators and suffix, and its suffix.
struct LiteralParts {
  std::string digits;
  std::string_view suffix;   ///< "", "f", "F", "l" or "L"; static storage
};
LiteralParts literalParts(std::string text);

}  // namespace skc::frontend
