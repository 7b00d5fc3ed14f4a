// SPDX-License-Identifier: MIT
//
// A position in a token sequence that ends with eof, and small queries about tokens.
#pragma once

#include <string>
#include <vector>

#include <clang/Basic/IdentifierTable.h>
#include <clang/Lex/Token.h>

namespace skc::frontend {

/// Spelling of an identifier or keyword, else "".
inline std::string nameOf(const clang::Token& token) {
  if (token.isAnnotation() || token.isLiteral()) return {};
  const clang::IdentifierInfo* name = token.getIdentifierInfo();
  return name ? name->getName().str() : std::string();
}

inline bool isWord(const clang::Token& token, llvm::StringRef word) {
  return token.is(clang::tok::identifier) && token.getIdentifierInfo()->getName() == word;
}

/// The index of the `>` that closes the list opened at `less`; 0 if that `<` opens no list.
std::size_t endOfList(const std::vector<clang::Token>& tokens, std::size_t less);

class TokenCursor {
 public:
  explicit TokenCursor(const std::vector<clang::Token>& tokens) : tokens_(tokens) {}

  /// The token `ahead` of the current one; eof at and past the end.
  const clang::Token& peek(std::size_t ahead = 0) const {
    return tokens_[std::min(position_ + ahead, tokens_.size() - 1)];
  }
  bool at(clang::tok::TokenKind kind) const { return peek().is(kind); }
  bool atEndOfDeclaration() const {
    return peek().isOneOf(clang::tok::eof, clang::tok::semi, clang::tok::l_brace, clang::tok::r_brace);
  }
  clang::Token take() {
    const clang::Token token = peek();
    if (position_ + 1 < tokens_.size()) ++position_;
    return token;
  }
  /// The tokens of the `{ ... }` that follows, up to its closing brace or the end.
  std::vector<clang::Token> peekBraced() const;
  /// Takes `( ... )` with its parentheses; empty if no `)` closes it before a brace or the end.
  std::vector<clang::Token> takeParenthesized();

 private:
  const std::vector<clang::Token>& tokens_;
  std::size_t position_ = 0;
};

}  // namespace skc::frontend
