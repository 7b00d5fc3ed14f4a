// SPDX-License-Identifier: MIT
#include "frontend/tokens/token_builder.hpp"

#include <clang/Lex/Preprocessor.h>

#include "frontend/prelude.hpp"
#include "frontend/tokens/token_cursor.hpp"

namespace skc::frontend {

using clang::Token;
namespace tok = clang::tok;

Token TokenBuilder::make(tok::TokenKind kind, clang::SourceLocation place) const {
  Token token;
  token.startToken();
  token.setKind(kind);
  token.setLocation(place);
  token.setLength(0);
  return token;
}

Token TokenBuilder::word(llvm::StringRef name, clang::SourceLocation place) const {
  clang::IdentifierInfo* info = preprocessor_.getIdentifierInfo(name);
  Token token = make(info->getTokenID(), place);
  token.setIdentifierInfo(info);
  return token;
}

void TokenBuilder::constant(const std::string& name, const std::vector<Token>& type,
                            const std::vector<Token>& value, clang::SourceLocation place,
                            std::vector<Token>& out) const {
  out.push_back(word("static", place));
  out.push_back(word("const", place));
  out.insert(out.end(), type.begin(), type.end());
  out.push_back(word(name, place));
  out.push_back(word("__attribute__", place));
  out.push_back(make(tok::l_paren, place));
  out.push_back(make(tok::l_paren, place));
  out.push_back(word("unused", place));
  out.push_back(make(tok::r_paren, place));
  out.push_back(make(tok::r_paren, place));
  out.push_back(make(tok::equal, place));
  for (std::size_t i = 0; i < value.size(); ++i) {
    Token token = value[i];
    const bool isCalled = i + 1 < value.size() && value[i + 1].is(tok::l_paren);
    if (token.is(tok::identifier) && isCalled && isVectorTypeName(nameOf(token))) {
      token.setIdentifierInfo(preprocessor_.getIdentifierInfo(vectorConstructorName(nameOf(token))));
    }
    out.push_back(token);
  }
  out.push_back(make(tok::semi, place));
}

}  // namespace skc::frontend
