// SPDX-License-Identifier: MIT
#include "frontend/tokens/constructor_editor.hpp"

#include <algorithm>

#include "frontend/prelude.hpp"

namespace skc::frontend {

using clang::Token;
namespace tok = clang::tok;

namespace {

/// True if parentheses that begin with these tokens hold parameters, not values.
bool beginsParameters(const Token& first, const Token& second) {
  const bool isType =
      isVectorTypeName(nameOf(first)) || first.isOneOf(tok::kw_const, tok::kw_bool, tok::kw_int,
                                                       tok::kw_unsigned, tok::kw_float, tok::kw_double);
  const bool isValue = second.isOneOf(tok::l_paren, tok::l_brace);
  return (isType && !isValue) || (first.is(tok::identifier) && second.is(tok::identifier));
}

}  // namespace

void ConstructorEditor::copy(TokenCursor& cursor, Tokens& out) {
  out.push_back(cursor.take());
  const Token token = out.back();
  if (token.is(tok::semi)) noteAlias(out);
  noteBraces(out);
  const bool isDeclarator = cursor.peek(1).is(tok::amp);  // `float4 (&w)[2]`
  if (token.is(tok::identifier) && cursor.at(tok::l_paren) && !isDeclarator) {
    const Name name = nameEndingAt(out, out.size());
    const std::string vector = vectorNamed(name);
    if (!vector.empty()) {
      out.resize(name.begin);
      out.push_back(builder_.word(vectorConstructorName(vector), token.getLocation()));
      out.back().setLength(token.getLength());
      return;
    }
    if (initialisesVariable(cursor, out)) {
      out.push_back(builder_.make(tok::equal, token.getLocation()));
      out.push_back(builder_.word(vectorConstructorName(declared_), token.getLocation()));
      return;
    }
  }
  noteDeclaration(cursor, out);
}

/// Parses the qualified name `a::b::c` whose last token is before `end`.
ConstructorEditor::Name ConstructorEditor::nameEndingAt(const Tokens& tokens, std::size_t end) {
  Name name{end, {}};
  while (name.begin > 0 && tokens[name.begin - 1].is(tok::identifier)) {
    name.path = "::" + nameOf(tokens[--name.begin]) + name.path;
    if (name.begin == 0 || tokens[name.begin - 1].isNot(tok::coloncolon)) break;
    --name.begin;
    name.isGlobal = name.begin == 0 || tokens[name.begin - 1].isNot(tok::identifier);
  }
  return name;
}

/// The vector type that a name or an alias denotes, such as "float4"; "" for any other name.
std::string ConstructorEditor::vectorNamed(const Name& name) const {
  std::string scope = name.isGlobal ? "" : openScope();
  for (std::size_t open = name.isGlobal ? 0 : braces_.size();; --open) {
    const auto alias = std::find_if(aliases_.rbegin(), aliases_.rend(),
                                    [&](const Alias& known) { return known.path == scope + name.path; });
    if (alias != aliases_.rend()) return alias->vector;
    if (open == 0) break;
    scope.resize(scope.size() - braces_[open - 1].name.size());
  }
  const std::string word = name.path.empty() ? "" : name.path.substr(2);
  return isVectorTypeName(word) ? word : std::string();
}

/// Records `using Color = float4;` or `typedef float4 Color;` at the end of `out`.
void ConstructorEditor::noteAlias(const Tokens& out) {
  const auto from = [&](std::size_t back) { return out.size() < back ? Token() : out[out.size() - back]; };
  const bool isTypedef = from(2).is(tok::identifier) && from(3).is(tok::identifier);
  const Name type = nameEndingAt(out, out.size() - (isTypedef ? 2 : 1));
  const auto before = [&](std::size_t back) { return type.begin < back ? Token() : out[type.begin - back]; };
  if (isTypedef ? before(1).isNot(tok::kw_typedef)
                : before(1).isNot(tok::equal) || before(3).isNot(tok::kw_using)) {
    return;
  }
  const std::string vector = vectorNamed(type);
  if (!vector.empty())
    aliases_.push_back({openScope() + "::" + nameOf(isTypedef ? from(2) : before(2)), vector});
}

/// The names of all open braces, outermost first.
std::string ConstructorEditor::openScope() const {
  std::string scope;
  for (const Brace& brace : braces_) scope += brace.name;
  return scope;
}

void ConstructorEditor::noteBraces(const Tokens& out) {
  const Token& token = out.back();
  if (token.isOneOf(tok::kw_struct, tok::kw_class, tok::kw_union, tok::kw_enum)) sawRecord_ = true;
  if (token.isOneOf(tok::kw_const, tok::kw_constexpr)) sawConst_ = true;
  if (token.is(tok::kw_requires)) {
    sawConstraint_ = true;
    sawRecord_ = false;   // the `class` of a template's parameter
  }
  if (sawNamespace_ && token.is(tok::identifier)) namespace_ += "::" + nameOf(token);
  if (token.is(tok::kw_namespace)) sawNamespace_ = true;
  if (token.is(tok::l_brace)) {
    const bool isInside = !braces_.empty() && braces_.back().holdsStatements && !sawRecord_;
    const bool isFunction =
        (out.size() > 1 && out[out.size() - 2].isOneOf(tok::r_paren, tok::kw_const, tok::kw_noexcept)) ||
        (sawConstraint_ && !sawRecord_);
    braces_.push_back(
        {sawNamespace_ ? namespace_ : "{" + std::to_string(bracesSeen_++), isInside || isFunction});
  } else if (token.is(tok::r_brace) && !braces_.empty()) {
    braces_.pop_back();
  }
  if (token.isOneOf(tok::l_brace, tok::r_brace, tok::semi)) {
    sawRecord_ = sawNamespace_ = sawConst_ = sawConstraint_ = false;
    namespace_.clear();
  }
}

/// Tracks a declaration such as `float2 a = f(x, y), b` to its end.
void ConstructorEditor::noteDeclaration(const TokenCursor& cursor, const Tokens& out) {
  const Token& token = out.back();
  const bool mayDeclare = areStatements() || sawConst_;
  if (token.isOneOf(tok::l_paren, tok::l_square, tok::l_brace)) ++depth_;
  if (token.isOneOf(tok::r_paren, tok::r_square, tok::r_brace)) --depth_;
  if (token.is(tok::semi) || depth_ < 0 || !mayDeclare) declared_.clear();
  if (declared_.empty() && mayDeclare && cursor.at(tok::identifier)) {
    declared_ = vectorNamed(nameEndingAt(out, out.size()));
    depth_ = 0;
  }
}

/// True if the name at the end of `out` is a variable's and the parentheses that follow hold its initial
/// value: in a body, where functions are not declared, or for a constant.
bool ConstructorEditor::initialisesVariable(const TokenCursor& cursor, const Tokens& out) const {
  if (declared_.empty() || depth_ != 0 || out.size() < 2) return false;
  const Token& before = out[out.size() - 2];
  if (before.isNot(tok::comma) && vectorNamed(nameEndingAt(out, out.size() - 1)).empty()) return false;
  if (cursor.peek(1).is(tok::r_paren)) return false;
  if (!areStatements() && beginsParameters(cursor.peek(1), cursor.peek(2))) return false;
  int depth = 0;
  for (std::size_t i = 0;; ++i) {
    const Token& token = cursor.peek(i);
    if (token.isOneOf(tok::eof, tok::semi, tok::l_brace, tok::r_brace)) return false;
    if (token.is(tok::l_paren)) ++depth;
    if (token.is(tok::r_paren) && --depth == 0) return cursor.peek(i + 1).isOneOf(tok::semi, tok::comma);
  }
}

}  // namespace skc::frontend
