// SPDX-License-Identifier: MIT
//
// Splits a program into tokens just well enough to mutate it: every byte is in exactly one token.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fuzz {

enum class TokenKind { Space, Word, Number, Mark };

struct Token {
  TokenKind kind;      ///< Mark for comments and strings
  std::string text;
};

std::vector<Token> tokensOf(std::string_view text);
std::string join(const std::vector<Token>& tokens);

}  // namespace fuzz
