// SPDX-License-Identifier: MIT
#include "frontend/tokens/bundle_editor.hpp"

#include "frontend/prelude.hpp"

namespace skc::frontend {

using clang::Token;
namespace tok = clang::tok;
using Tokens = std::vector<Token>;

namespace {

/// True for a qualifier of parameters, before a type and a name.
bool isQualifierAt(const TokenCursor& cursor, std::size_t at) {
  for (const llvm::StringRef word : {"spec", "out", "inout", "reduce", "scan", "iter", "vout"}) {
    if (isWord(cursor.peek(at), word))
      return startsType(cursor.peek(at + 1)) && !cursor.at(at + 2, tok::equal);
  }
  return false;
}

/// The index of what follows the attributes from here on.
std::size_t behindAttributes(const TokenCursor& cursor) {
  std::size_t at = 0;
  while (cursor.at(at, tok::l_square) && cursor.at(at + 1, tok::l_square)) {
    while (!cursor.peek(at).isOneOf(tok::semi, tok::eof) &&
           !(cursor.at(at, tok::r_square) && cursor.at(at + 1, tok::r_square))) {
      ++at;
    }
    at += 2;
  }
  return at;
}

/// Each declarator of `T a[], b[][]` as a declaration of its own.
std::vector<Tokens> declaratorsOf(const Tokens& declared) {
  std::vector<Tokens> members(1);
  Tokens head;  // what precedes the first name
  int depth = 0;
  for (const Token& token : declared) {
    if (token.isOneOf(tok::l_paren, tok::l_square, tok::l_brace, tok::less)) ++depth;
    if (token.isOneOf(tok::r_paren, tok::r_square, tok::r_brace)) --depth;
    depth -= closedLists(token);
    if (token.isNot(tok::comma) || depth > 0) {
      members.back().push_back(token);
      continue;
    }
    if (head.empty()) {
      head = members.front();
      while (!head.empty() && head.back().isOneOf(tok::l_square, tok::r_square)) head.pop_back();
      if (!head.empty()) head.pop_back();
    }
    members.push_back(head);
  }
  return members;
}

}  // namespace

void BundleEditor::edit(TokenCursor& cursor, Tokens& out) {
  while (editMember(cursor, out)) {
  }
}

/// Edits `[[wrap]] float4 sky[][], ground[];` or `spec bool spheres;`; returns false for any other member.
bool BundleEditor::editMember(TokenCursor& cursor, Tokens& out) {
  const std::size_t start = behindAttributes(cursor);
  std::size_t end = start;
  while (!cursor.peek(end).isOneOf(tok::semi, tok::l_brace, tok::r_brace, tok::eof)) ++end;
  if (!cursor.at(end, tok::semi)) return false;
  bool isOurs = start > 0 || isQualifierAt(cursor, start);
  for (std::size_t i = start; i < end; ++i) {
    if (cursor.at(i, tok::l_paren)) return false;  // a function
    const bool hasBrackets = cursor.at(i, tok::l_square) && cursor.at(i + 1, tok::r_square);
    const bool isElement = cursor.at(i, tok::less) && cursor.at(i + 1, tok::greater);
    isOurs = isOurs || hasBrackets || isElement;
  }
  if (!isOurs) return false;
  Tokens declared;
  for (std::size_t i = 0; i < end; ++i) declared.push_back(cursor.take());
  const Token semicolon = cursor.take();
  for (const Tokens& member : declaratorsOf(declared)) {
    parameters_.editMember(member, out);
    out.push_back(semicolon);
  }
  return true;
}

bool hasListsOnly(const TokenCursor& cursor, llvm::StringRef name) {
  for (std::size_t i = 0; cursor.peek(i).isNot(tok::eof); ++i) {
    const bool isNamed = isWord(cursor.peek(i), name);
    const bool isMember = i > 0 && cursor.peek(i - 1).isOneOf(tok::period, tok::arrow, tok::coloncolon);
    if (isNamed && (isMember || !cursor.at(i + 1, tok::less))) return false;
  }
  return true;
}

llvm::StringSet<> declaredInPlace(const TokenCursor& cursor) {
  llvm::StringSet<> names;
  int depth = 0;  // of braces and parentheses: C++ itself prefers the names of namespaces
  bool declaresStreams = false, declaresTemplate = false;
  Token before = cursor.peek();
  for (std::size_t i = 0; cursor.peek(i).isNot(tok::eof); before = cursor.peek(i), ++i) {
    const Token& token = cursor.peek(i);
    if (token.isOneOf(tok::l_paren, tok::l_brace)) ++depth;
    if (token.isOneOf(tok::r_paren, tok::r_brace)) --depth;
    if (before.isOneOf(tok::semi, tok::r_brace) || i == 0) {
      declaresStreams = isWord(token, "stream");
      declaresTemplate = token.is(tok::kw_template);
    }
    if (depth > 0 || token.isNot(tok::identifier)) continue;
    const std::string name = nameOf(token);
    if (!isYielding(name) && !(declaresTemplate && isYieldingToTemplates(name))) continue;
    const bool isListed = cursor.at(i + 1, tok::less);  // `gather<float, 2>`, or the extents of a stream
    const bool isBehindType =
        startsType(before) && !before.isOneOf(tok::coloncolon, tok::kw_inline, tok::kw_static,
                                              tok::kw_constexpr, tok::kw_const, tok::kw_typename);
    if (declaresStreams ? isListed : isBehindType && !isListed) names.insert(name);
  }
  return names;
}

}  // namespace skc::frontend
