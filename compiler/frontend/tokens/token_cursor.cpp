// SPDX-License-Identifier: MIT
#include "frontend/tokens/token_cursor.hpp"

#include <algorithm>

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

std::vector<clang::Token> TokenCursor::peekBraced() const {
  std::vector<clang::Token> braced;
  int depth = 0;
  do {
    braced.push_back(peek(braced.size()));
    if (braced.back().is(clang::tok::l_brace)) ++depth;
    if (braced.back().is(clang::tok::r_brace)) --depth;
  } while (depth > 0 && braced.back().isNot(clang::tok::eof));
  return braced;
}

std::size_t endOfList(const std::vector<clang::Token>& tokens, std::size_t less) {
  if (tokens[less - 1].isNot(clang::tok::identifier)) return 0;
  constexpr std::size_t longest = 256;   // tokens; bounds the time for many unclosed `<`
  int depth = 0;
  int parentheses = 0;
  for (std::size_t i = less; i < std::min(tokens.size(), less + longest); ++i) {
    const clang::Token& token = tokens[i];
    if (token.isOneOf(clang::tok::equal, clang::tok::l_brace, clang::tok::semi, clang::tok::greaterequal))
      return 0;
    if (token.is(clang::tok::l_paren)) ++parentheses;
    if (token.is(clang::tok::r_paren) && --parentheses < 0) return 0;
    if (parentheses > 0) continue;
    if (token.is(clang::tok::less)) ++depth;
    if (token.is(clang::tok::greater) && --depth == 0) return i;
  }
  return 0;
}

}  // namespace skc::frontend
