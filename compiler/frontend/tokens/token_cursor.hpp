// SPDX-License-Identifier: MIT
//
// A position in a token sequence that ends with eof, small queries about tokens, and a builder of tokens that the user did
// not write.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <clang/Basic/IdentifierTable.h>
#include <clang/Lex/Token.h>
#include <llvm/ADT/SmallPtrSet.h>

#include "support/function_ref.hpp"

namespace clang {
class Preprocessor;
}

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

/// Whether a token may begin a type.
inline bool startsType(const clang::Token& token) {
  return token.is(clang::tok::coloncolon) ||
         (!token.isAnnotation() && !token.isLiteral() && token.getIdentifierInfo() != nullptr);
}

/// The parameters between the parentheses of a list: its tokens, split at commas outside any bracket.
std::vector<std::vector<clang::Token>> splitAtCommas(const std::vector<clang::Token>& declared);

/// How many template lists a token closes: two for the `>>` of `Pair<Pair<T>>`.
inline int closedLists(const clang::Token& token) {
  return token.is(clang::tok::greater) ? 1 : token.is(clang::tok::greatergreater) ? 2 : 0;
}

/// The index of the `>` or `>>` that closes the list opened at `less`; 0 if that `<` opens no list.
std::size_t endOfList(const std::vector<clang::Token>& tokens, std::size_t less);

/// The index of the name in `void f` or, with arguments of a template, `void f<Pair<float>>`; 0 if no name ends the tokens.
std::size_t nameAtEnd(const std::vector<clang::Token>& tokens);

/// The index of `gather` in `gather<T, rank>` and `const gather<T, rank>`; nullopt in other types.
std::optional<std::size_t> gatherIn(const std::vector<clang::Token>& type);
/// Whether a type may be another name of a gather's, which lowering will know.
bool mayBeAlias(const std::vector<clang::Token>& type);
/// The type of a gather's elements: of `gather<T, rank>`, T.
std::vector<clang::Token> elementTypeOf(const std::vector<clang::Token>& type);

class TokenCursor {
 public:
  explicit TokenCursor(const std::vector<clang::Token>& tokens) : tokens_(tokens) {}

  /// The token `ahead` of the current one; eof at and past the end.
  const clang::Token& peek(std::size_t ahead = 0) const {
    return tokens_[std::min(position_ + ahead, tokens_.size() - 1)];
  }
  bool at(clang::tok::TokenKind kind) const { return peek().is(kind); }
  bool at(std::size_t ahead, clang::tok::TokenKind kind) const { return peek(ahead).is(kind); }
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
  /// How far ahead the token is that closes the list opened by the `<` that is `less` ahead; 0 if that opens none.
  std::size_t endOfList(std::size_t less) const;
  /// The number of tokens of the `<...>` of a template, which begins here; 0 if nothing closes it. `templates` are the names
  /// that are known to be templates: `N < 3` is a comparison otherwise.
  std::size_t templateParameters(const llvm::SmallPtrSetImpl<const clang::IdentifierInfo*>& templates) const;

 private:
  /// The same, if the names of which opensAfter(name) is true have lists.
  std::size_t templateParameters(FunctionRef<bool(const clang::Token&)> opensAfter) const;

  const std::vector<clang::Token>& tokens_;
  std::size_t position_ = 0;
};

/// Builds tokens at source locations of tokens that the user wrote.
class TokenBuilder {
 public:
  explicit TokenBuilder(clang::Preprocessor& preprocessor) : preprocessor_(preprocessor) {}

  clang::Token make(clang::tok::TokenKind kind, clang::SourceLocation location) const;
  /// An identifier or keyword with this spelling.
  clang::Token word(llvm::StringRef name, clang::SourceLocation location) const;
  /// Appends `static const T NAME __attribute__((unused)) = value;` to `out`.
  void constant(const std::string& name, const std::vector<clang::Token>& type,
                const std::vector<clang::Token>& value, clang::SourceLocation location,
                std::vector<clang::Token>& out) const;

 private:
  clang::Preprocessor& preprocessor_;
};

}  // namespace skc::frontend
