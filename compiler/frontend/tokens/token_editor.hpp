// SPDX-License-Identifier: MIT
//
// Turns the preprocessed tokens of a .sk file into C++ that Clang's parser accepts. Only tokens of
// declarations change, and every token keeps its source location, so that diagnostics keep theirs:
//
//   kernel void f(float k, [[wrap]] float u[][], float x<>, out float v<>) { v = x * float2(1, k).y; }
//   void f(const float k, gather_2d<float> u, const float x, float& v) { v = x * __sk_make_float2(1, k).y; }
//
// What it removes is recorded in DeclarationSyntax. It checks the syntax of declarations, never types.
#pragma once

#include <vector>

#include <clang/Lex/Token.h>

#include "frontend/tokens/syntax.hpp"
#include "support/diagnostics.hpp"

namespace clang {
class Preprocessor;
}

namespace skc::frontend {

struct EditedTokens {
  std::vector<clang::Token> tokens;
  DeclarationSyntax syntax;
};

/// `tokens` is the whole translation unit, including prelude and eof. Errors are reported at their tokens;
/// after an error, do not parse the result.
EditedTokens editTokens(const std::vector<clang::Token>& tokens, clang::Preprocessor& preprocessor,
                        Diagnostics& diagnostics);

}  // namespace skc::frontend
