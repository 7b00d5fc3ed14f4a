// SPDX-License-Identifier: MIT
//
// Cuts a program into tokens just well enough to mutate it: every byte is in exactly one piece.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fuzz {

enum class TokenKind { Space, Word, Number, Mark };

struct Token {
  TokenKind kind;      ///< comments and strings are Marks
  std::string text;
};

std::vector<Token> tokensOf(std::string_view text);
std::string join(const std::vector<Token>& tokens);

}  // namespace fuzz
