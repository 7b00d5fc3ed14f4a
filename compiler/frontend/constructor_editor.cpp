// SPDX-License-Identifier: MIT
#include "frontend/constructor_editor.hpp"

#include <algorithm>

#include "frontend/prelude.hpp"

namespace skc::frontend {

using clang::Token;
namespace tok = clang::tok;

void ConstructorEditor::copy(TokenCursor& cursor, Tokens& out) {
  const Token token = cursor.take();
  noteAlias(token, cursor);
  noteBraces(token, out);
  if (token.is(tok::identifier) && cursor.at(tok::l_paren)) {
    const std::string vector = vectorNamedBy(token);
    if (!vector.empty()) {
      out.push_back(maker_.word(vectorConstructorName(vector), token.getLocation()));
      out.back().setLength(token.getLength());
      return;
    }
    if (initialisesVariable(cursor, out)) {
      out.push_back(token);
      out.push_back(maker_.make(tok::equal, token.getLocation()));
      out.push_back(maker_.word(vectorConstructorName(declared_), token.getLocation()));
      return;
    }
  }
  noteDeclaration(token, cursor);
  out.push_back(token);
}

/// "float4", also by an alias; "" for any other token.
std::string ConstructorEditor::vectorNamedBy(const Token& token) const {
  if (token.isNot(tok::identifier)) return {};
  const auto alias = std::find_if(aliases_.rbegin(), aliases_.rend(), [&](const Alias& known) {
    return known.name == token.getIdentifierInfo() && isVisible(known);
  });
  if (alias != aliases_.rend()) return alias->vector;
  const std::string name = nameOf(token);
  return isVectorTypeName(name) ? name : std::string();
}

/// `using Color = float4;` or `typedef float4 Color;`
void ConstructorEditor::noteAlias(const Token& token, const TokenCursor& cursor) {
  const bool isUsing = token.is(tok::kw_using) && cursor.at(tok::identifier) &&
                       cursor.peek(1).is(tok::equal) && cursor.peek(3).is(tok::semi);
  const bool isTypedef =
      token.is(tok::kw_typedef) && cursor.peek(1).is(tok::identifier) && cursor.peek(2).is(tok::semi);
  if (!isUsing && !isTypedef) return;
  const std::string vector = vectorNamedBy(cursor.peek(isUsing ? 2 : 0));
  const clang::IdentifierInfo* name = cursor.peek(isUsing ? 0 : 1).getIdentifierInfo();
  if (vector.empty()) return;
  aliases_.push_back({name, vector, {}});
  for (const Brace& brace : braces_) aliases_.back().scope.push_back(brace.name);
}

bool ConstructorEditor::isVisible(const Alias& alias) const {
  if (alias.scope.size() > braces_.size()) return false;
  return std::equal(alias.scope.begin(), alias.scope.end(), braces_.begin(),
                    [](const std::string& name, const Brace& brace) { return name == brace.name; });
}

void ConstructorEditor::noteBraces(const Token& token, const Tokens& out) {
  if (token.isOneOf(tok::kw_struct, tok::kw_class, tok::kw_union, tok::kw_enum)) sawRecord_ = true;
  if (sawNamespace_ && token.is(tok::identifier)) namespace_ += "::" + nameOf(token);
  if (token.is(tok::kw_namespace)) sawNamespace_ = true;
  if (token.is(tok::l_brace)) {
    const bool isInside = !braces_.empty() && braces_.back().holdsStatements && !sawRecord_;
    const bool isFunction = !out.empty() && out.back().isOneOf(tok::r_paren, tok::kw_const, tok::kw_noexcept);
    braces_.push_back({sawNamespace_ ? namespace_ : std::to_string(bracesSeen_++), isInside || isFunction});
  } else if (token.is(tok::r_brace) && !braces_.empty()) {
    braces_.pop_back();
  }
  if (token.isOneOf(tok::l_brace, tok::r_brace, tok::semi)) {
    sawRecord_ = sawNamespace_ = false;
    namespace_.clear();
  }
}

/// Follows `float2 a = f(x, y), b` in a body to its end.
void ConstructorEditor::noteDeclaration(const Token& token, const TokenCursor& cursor) {
  if (token.isOneOf(tok::l_paren, tok::l_square, tok::l_brace)) ++depth_;
  if (token.isOneOf(tok::r_paren, tok::r_square, tok::r_brace)) --depth_;
  if (token.is(tok::semi) || depth_ < 0 || !areStatements()) declared_.clear();
  if (declared_.empty() && areStatements() && cursor.at(tok::identifier)) {
    declared_ = vectorNamedBy(token);
    depth_ = 0;
  }
}

/// Whether the name that was taken is that of a variable, and the parentheses that follow hold its value: in
/// a body, where nobody declares functions.
bool ConstructorEditor::initialisesVariable(const TokenCursor& cursor, const Tokens& out) const {
  if (declared_.empty() || depth_ != 0 || out.empty()) return false;
  if (out.back().isNot(tok::comma) && vectorNamedBy(out.back()).empty()) return false;
  if (cursor.peek(1).is(tok::r_paren)) return false;
  int depth = 0;
  for (std::size_t i = 0;; ++i) {
    const Token& token = cursor.peek(i);
    if (token.isOneOf(tok::eof, tok::semi, tok::l_brace, tok::r_brace)) return false;
    if (token.is(tok::l_paren)) ++depth;
    if (token.is(tok::r_paren) && --depth == 0) return cursor.peek(i + 1).isOneOf(tok::semi, tok::comma);
  }
}

}  // namespace skc::frontend
