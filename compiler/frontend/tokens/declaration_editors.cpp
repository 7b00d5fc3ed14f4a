// SPDX-License-Identifier: MIT
#include "frontend/tokens/declaration_editors.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "frontend/clang_loc.hpp"
#include "frontend/prelude.hpp"

namespace skc::frontend {

using clang::Token;
namespace tok = clang::tok;

void StreamEditor::edit(TokenCursor& cursor, Tokens& out) {
  cursor.take();   // `stream`
  Tokens type;
  takeType(cursor, type);
  Tokens edited;
  bool isWellFormed = !type.empty() || fail(Diag::StreamDeclaration, cursor.peek());
  for (bool isLast = false; isWellFormed && !isLast;) {
    isWellFormed = takeDeclarator(cursor, type, edited);
    isLast = !isWellFormed || cursor.at(tok::semi);
    if (!isLast) cursor.take();   // the comma
  }
  if (isWellFormed) out.insert(out.end(), edited.begin(), edited.end());
  while (!cursor.atEndOfDeclaration()) cursor.take();
  if (cursor.at(tok::semi)) cursor.take();
}

/// Takes what precedes the first name: `float` or `Pair<float>`.
void StreamEditor::takeType(TokenCursor& cursor, Tokens& type) {
  while (!cursor.atEndOfDeclaration()) {
    std::size_t count = 1;
    if (cursor.at(1, tok::less)) {
      const bool isType = type.empty() || type.back().isOneOf(tok::coloncolon, tok::kw_const, tok::kw_struct);
      const std::size_t end = isType ? cursor.endOfList(1) : 0;
      if (end == 0 || !cursor.at(end + 1, tok::identifier) || !cursor.at(end + 2, tok::less)) return;
      count = end + 1;
    }
    for (; count > 0; --count) type.push_back(cursor.take());
  }
}

/// Takes `name<extents>` before a comma or a semicolon.
bool StreamEditor::takeDeclarator(TokenCursor& cursor, const Tokens& type, Tokens& out) {
  if (!cursor.at(tok::identifier) || cursor.peek(1).isNot(tok::less)) {
    return fail(Diag::StreamDeclaration, cursor.peek());
  }
  const Token name = cursor.take();
  cursor.take();
  std::vector<Tokens> extents;
  if (!takeExtents(cursor, extents)) return false;
  if (cursor.peek().isOneOf(tok::equal, tok::l_brace, tok::l_paren)) {
    return fail(Diag::StreamValue, cursor.peek(), {nameOf(name)});
  }
  if (!cursor.at(tok::comma) && !cursor.at(tok::semi)) return fail(Diag::StreamDeclaration, cursor.peek());
  if (extents.empty() || extents.size() > 4) {
    return fail(Diag::StreamRank, name, {nameOf(name), std::to_string(extents.size())});
  }
  StreamSyntax stream;
  for (const Tokens& written : extents) stream.extents.push_back(extent(written, out));
  syntax_.add(name.getLocation(), std::move(stream));
  out.push_back(builder_.word("extern", name.getLocation()));
  out.insert(out.end(), type.begin(), type.end());
  out.push_back(name);
  out.push_back(builder_.make(tok::semi, name.getLocation()));
  return true;
}

/// Takes the extents and the `>`.
bool StreamEditor::takeExtents(TokenCursor& cursor, std::vector<Tokens>& extents) {
  int depth = 0;
  bool isBegun = false;
  while (true) {
    const Token& token = cursor.peek();
    if (token.isOneOf(tok::eof, tok::semi, tok::l_brace, tok::r_brace)) break;
    if (depth == 0 && token.isOneOf(tok::comma, tok::greater)) {
      const bool isEmpty = extents.empty() && !isBegun && token.is(tok::greater);
      if (!isEmpty && !isBegun) break;   // an empty extent
      isBegun = false;
      if (cursor.take().is(tok::greater)) return true;
      if (cursor.at(tok::greater)) break;
      continue;
    }
    if (token.isOneOf(tok::l_paren, tok::l_square)) ++depth;
    if (token.isOneOf(tok::r_paren, tok::r_square)) --depth;
    if (!isBegun) extents.emplace_back();
    isBegun = true;
    // `Count<int>::value`, `count<int>()`
    std::size_t end = token.is(tok::less) ? cursor.endOfList(0) : 0;
    if (!cursor.at(end + 1, tok::coloncolon) && !cursor.at(end + 1, tok::l_paren)) end = 0;
    for (std::size_t i = 0; i <= end; ++i) extents.back().push_back(cursor.take());
  }
  return fail(Diag::StreamExtents, cursor.peek());
}

ExtentSyntax StreamEditor::extent(const Tokens& written, Tokens& out) {
  const clang::SourceLocation location = written.front().getLocation();
  if (written.size() == 1 && written.front().is(tok::identifier)) {
    return {location, written.front().getIdentifierInfo(), {}};
  }
  ExtentSyntax extent{location, nullptr, fmt::format("__sk_constant{}", constants_++)};
  builder_.constant(extent.constant, {builder_.word("auto", location)}, written, location, out);
  return extent;
}

bool StreamEditor::fail(Diag diag, const Token& location, std::initializer_list<std::string_view> arguments) {
  diagnostics_.report(diag, locOf(location), arguments);
  return false;
}

namespace {

/// True for the last token of a type in front of a name.
bool endsType(const Token& token) {
  return token.isOneOf(tok::identifier, tok::greater, tok::kw_float, tok::kw_double, tok::kw_int,
                       tok::kw_unsigned, tok::kw_char, tok::kw_short, tok::kw_long, tok::kw_bool);
}

}  // namespace

bool atLocalStream(const TokenCursor& cursor, const Token& before, Diagnostics& diagnostics) {
  if (!cursor.at(tok::identifier) || cursor.peek(1).isNot(tok::less)) return false;
  const bool isEmpty = cursor.peek(2).is(tok::greater);
  const bool isDeclared = endsType(before) || (isEmpty && before.is(tok::comma));
  if (!isDeclared) return false;
  if (isEmpty && cursor.peek(3).isOneOf(tok::comma, tok::semi)) return true;
  const std::size_t end = isEmpty ? 0 : cursor.endOfList(1);
  const bool isTemplate = end != 0 && cursor.at(end + 1, tok::identifier);  // `const Pair<float> p = ...;`
  if (!isTemplate) diagnostics.report(Diag::LocalStreamForm, locOf(cursor.peek()), {nameOf(cursor.peek())});
  return false;
}

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
  if (constructsIndices_ && isWord(token, "index") && cursor.at(tok::less)) {
    const std::size_t end = cursor.endOfList(0);
    if (end != 0 && cursor.at(end + 1, tok::l_paren))
      out.back() = builder_.word(vectorConstructorName("index"), token.getLocation());
    return;
  }
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

namespace tok = clang::tok;

namespace {

/// Splits `( ... )` at commas outside inner brackets.
std::vector<std::vector<Token>> argumentsOf(const std::vector<Token>& parenthesized) {
  std::vector<std::vector<Token>> arguments(1);
  int depth = 0;
  for (std::size_t i = 1; i + 1 < parenthesized.size(); ++i) {
    const Token& token = parenthesized[i];
    if (token.isOneOf(tok::l_paren, tok::l_square, tok::l_brace)) ++depth;
    if (token.isOneOf(tok::r_paren, tok::r_square, tok::r_brace)) --depth;
    if (depth == 0 && token.is(tok::comma)) {
      arguments.emplace_back();
    } else {
      arguments.back().push_back(token);
    }
  }
  return arguments;
}

bool isInterpolation(const std::vector<Token>& argument) {
  return argument.size() == 1 && (isWord(argument[0], "linear") || isWord(argument[0], "cubic"));
}

/// Checks for low, high, intervals and the interpolation.
bool areWellFormed(const std::vector<std::vector<Token>>& arguments) {
  if (arguments.size() != 4 || !isInterpolation(arguments[3])) return false;
  return !arguments[0].empty() && !arguments[1].empty() && !arguments[2].empty();
}

}  // namespace

bool namesTable(const TokenCursor& cursor) { return isWord(cursor.peek(2), "table"); }

std::optional<TableSyntax> takeTable(TokenCursor& cursor, std::size_t tokens, const TokenBuilder& builder,
                                     Diagnostics& diagnostics, int& constants, std::vector<Token>& out) {
  std::vector<Token> attribute;
  for (std::size_t i = 0; i < tokens; ++i) attribute.push_back(cursor.take());
  // [ [ table ( ... ) ] ]
  const Token name = attribute[2];
  const bool isCall = attribute.size() > 7 && attribute[3].is(tok::l_paren) &&
                      attribute[attribute.size() - 3].is(tok::r_paren);
  const std::vector<std::vector<Token>> arguments =
      isCall ? argumentsOf({attribute.begin() + 3, attribute.end() - 2}) : std::vector<std::vector<Token>>();
  if (!areWellFormed(arguments)) {
    diagnostics.report(Diag::TableForm, locOf(name));
    return std::nullopt;
  }
  const auto constant = [&](llvm::StringRef type, const std::vector<Token>& value) {
    const std::string constantName = fmt::format("__sk_constant{}", constants++);
    builder.constant(constantName, {builder.word(type, value.front().getLocation())}, value,
                     value.front().getLocation(), out);
    return constantName;
  };
  TableSyntax table;
  table.low = constant("float", arguments[0]);
  table.high = constant("float", arguments[1]);
  table.intervals = constant("int", arguments[2]);
  table.isCubic = isWord(arguments[3][0], "cubic");
  return table;
}

}  // namespace skc::frontend
