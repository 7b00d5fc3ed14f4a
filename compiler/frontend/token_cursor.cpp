// SPDX-License-Identifier: MIT
#include "frontend/token_cursor.hpp"

namespace skc::frontend {

std::vector<clang::Token> TokenCursor::takeParenthesized() {
  std::vector<clang::Token> taken;
  int parentheses = 0;
  int braces = 0;
  do {
    const clang::Token& token = peek();
    if (token.is(clang::tok::eof) || (token.is(clang::tok::semi) && braces == 0)) return {};
    if (token.is(clang::tok::l_brace)) ++braces;
    if (token.is(clang::tok::r_brace) && --braces < 0) return {};
    if (token.is(clang::tok::l_paren)) ++parentheses;
    if (token.is(clang::tok::r_paren)) --parentheses;
    taken.push_back(take());
  } while (parentheses > 0);
  return taken;
}

}  // namespace skc::frontend
