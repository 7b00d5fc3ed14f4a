// SPDX-License-Identifier: MIT
#include "frontend/tokens/token_cursor.hpp"

#include <algorithm>
#include <iterator>

#include <clang/Lex/Preprocessor.h>

#include "frontend/prelude.hpp"

namespace skc::frontend {

using clang::Token;
namespace tok = clang::tok;

namespace {

/// Whether a token can follow the parameters of a template.
bool beginsDeclaration(const clang::Token& token) {
  return token.isOneOf(clang::tok::coloncolon, clang::tok::l_square) || token.getIdentifierInfo() != nullptr;
}

}  // namespace

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
    depth -= closedLists(token);
    if (depth == 0) return i;
    if (depth < 0) return 0;
  }
  return 0;
}

std::size_t nameAtEnd(const std::vector<clang::Token>& tokens) {
  if (tokens.empty()) return 0;
  const std::size_t last = tokens.size() - 1;
  if (closedLists(tokens[last]) == 0) return tokens[last].is(clang::tok::identifier) ? last : 0;
  constexpr std::size_t longest = 256;
  int depth = 0;
  int parentheses = 0;
  for (std::size_t i = last; i > 0 && last - i < longest; --i) {
    if (tokens[i].is(clang::tok::r_paren)) ++parentheses;
    if (tokens[i].is(clang::tok::l_paren)) --parentheses;
    if (parentheses > 0) continue;
    depth += closedLists(tokens[i]);
    if (tokens[i].isNot(clang::tok::less) || --depth > 0) continue;
    return depth == 0 && tokens[i - 1].is(clang::tok::identifier) ? i - 1 : 0;
  }
  return 0;
}

std::size_t TokenCursor::endOfList(std::size_t less) const {
  const std::size_t at = position_ + less;
  const std::size_t end = at > 0 && at < tokens_.size() ? frontend::endOfList(tokens_, at) : 0;
  return end == 0 ? 0 : end - position_;
}

std::size_t TokenCursor::templateParameters(
    const llvm::SmallPtrSetImpl<const clang::IdentifierInfo*>& templates) const {
  const auto isKnown = [&](const clang::Token& name) { return templates.contains(name.getIdentifierInfo()); };
  if (const std::size_t count = templateParameters(isKnown); count != 0) return count;
  // members of other templates, whose declarations nobody has looked at
  return templateParameters([](const clang::Token&) { return true; });
}

std::size_t TokenCursor::templateParameters(FunctionRef<bool(const clang::Token&)> opensAfter) const {
  constexpr std::size_t longest = 1024;   // tokens; bounds the time for many unclosed `<`
  int lists = 0;
  int brackets = 0;
  for (std::size_t i = 0; i < longest && !at(i, clang::tok::eof); ++i) {
    const clang::Token& token = peek(i);
    if (token.isOneOf(clang::tok::l_paren, clang::tok::l_square, clang::tok::l_brace)) ++brackets;
    if (token.isOneOf(clang::tok::r_paren, clang::tok::r_square, clang::tok::r_brace) && --brackets < 0)
      return 0;
    if (brackets > 0) continue;
    if (token.is(clang::tok::semi)) return 0;
    if (token.is(clang::tok::less)) {
      const bool opens = i == 0 || at(i - 1, clang::tok::kw_template) ||
                         (i > 1 && at(i - 2, clang::tok::kw_template)) ||
                         (at(i - 1, clang::tok::identifier) && opensAfter(peek(i - 1)));
      if (opens) ++lists;
    }
    lists -= closedLists(token);
    if (lists < 0) return 0;
    if (lists == 0) return beginsDeclaration(peek(i + 1)) ? i + 1 : 0;
  }
  return 0;
}

Token TokenBuilder::make(tok::TokenKind kind, clang::SourceLocation location) const {
  Token token;
  token.startToken();
  token.setKind(kind);
  token.setLocation(location);
  token.setLength(0);
  return token;
}

Token TokenBuilder::word(llvm::StringRef name, clang::SourceLocation location) const {
  clang::IdentifierInfo* info = preprocessor_.getIdentifierInfo(name);
  Token token = make(info->getTokenID(), location);
  token.setIdentifierInfo(info);
  return token;
}

void TokenBuilder::constant(const std::string& name, const std::vector<Token>& type,
                            const std::vector<Token>& value, clang::SourceLocation location,
                            std::vector<Token>& out) const {
  out.push_back(word("static", location));
  out.push_back(word("const", location));
  out.insert(out.end(), type.begin(), type.end());
  out.push_back(word(name, location));
  out.push_back(word("__attribute__", location));
  out.push_back(make(tok::l_paren, location));
  out.push_back(make(tok::l_paren, location));
  out.push_back(word("unused", location));
  out.push_back(make(tok::r_paren, location));
  out.push_back(make(tok::r_paren, location));
  out.push_back(make(tok::equal, location));
  for (std::size_t i = 0; i < value.size(); ++i) {
    Token token = value[i];
    const bool isCalled = i + 1 < value.size() && value[i + 1].is(tok::l_paren);
    if (token.is(tok::identifier) && isCalled && isVectorTypeName(nameOf(token))) {
      token.setIdentifierInfo(preprocessor_.getIdentifierInfo(vectorConstructorName(nameOf(token))));
    }
    out.push_back(token);
  }
  out.push_back(make(tok::semi, location));
}

std::vector<std::vector<Token>> splitAtCommas(const std::vector<Token>& declared) {
  std::vector<std::vector<Token>> parts(1);
  int depth = 0;
  bool isValue = false;   // after `=`, `<` is a comparison, but in `Pair<int, int>{0, 1}`
  for (std::size_t i = 1; i + 1 < declared.size(); ++i) {
    const Token& token = declared[i];
    if (token.isOneOf(tok::l_paren, tok::l_square, tok::l_brace)) ++depth;
    if (token.isOneOf(tok::r_paren, tok::r_square, tok::r_brace)) --depth;
    if (token.is(tok::equal)) isValue = true;
    std::size_t end = token.is(tok::less) ? endOfList(declared, i) : 0;
    if (isValue && !(end + 1 < declared.size() && declared[end + 1].isOneOf(tok::l_brace, tok::l_paren)))
      end = 0;
    if (end != 0) {
      parts.back().insert(parts.back().end(), declared.begin() + static_cast<std::ptrdiff_t>(i),
                          declared.begin() + static_cast<std::ptrdiff_t>(end) + 1);
      i = end;
      continue;
    }
    if (token.is(tok::comma) && depth == 0) {
      isValue = false;
      parts.emplace_back();
    } else {
      parts.back().push_back(token);
    }
  }
  if (parts.size() == 1 && parts.front().empty()) parts.clear();
  return parts;
}

std::optional<std::size_t> gatherIn(const std::vector<Token>& type) {
  const std::size_t at = !type.empty() && type.front().is(tok::kw_const) ? 1 : 0;
  const bool isGather = type.size() > at + 3 && isWord(type[at], "gather") && type[at + 1].is(tok::less);
  return isGather ? std::optional(at) : std::nullopt;
}

bool mayBeAlias(const std::vector<Token>& type) {
  const std::string name = nameOf(type.back());
  constexpr std::string_view scalars[] = {"uint",   "half",   "uchar",   "ushort",
                                          "unorm8", "snorm8", "unorm16", "snorm16"};
  return type.back().is(tok::greater) || (type.back().is(tok::identifier) && !isVectorTypeName(name) &&
                                          std::ranges::find(scalars, name) == std::end(scalars));
}

std::vector<Token> elementTypeOf(const std::vector<Token>& type) {
  const std::optional<std::size_t> gather = gatherIn(type);
  if (!gather) return type;
  int depth = 0;
  const std::size_t first = *gather + 2;
  for (std::size_t i = first; i < type.size(); ++i) {
    if (type[i].is(tok::less)) ++depth;
    depth -= closedLists(type[i]);
    if (type[i].is(tok::comma) && depth == 0)
      return {type.begin() + static_cast<std::ptrdiff_t>(first),
              type.begin() + static_cast<std::ptrdiff_t>(i)};
  }
  return type;
}

}  // namespace skc::frontend
