// SPDX-License-Identifier: MIT
#include "frontend/tokens/stream_editor.hpp"

#include <fmt/format.h>

#include "frontend/clang_loc.hpp"

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

}  // namespace skc::frontend
