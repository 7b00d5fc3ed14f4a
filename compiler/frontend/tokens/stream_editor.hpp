// SPDX-License-Identifier: MIT
//
// Edits a declaration of streams. From
//
//   stream float u<height, 2 * n>, v<n>;
//
// Clang gets the type of each stream, and the values of extents that are more than a name, to check them:
//
//   static const auto __sk_constant3 __attribute__((unused)) = 2 * n; extern float u; extern float v;
#pragma once

#include <vector>

#include <clang/Lex/Token.h>

#include "frontend/tokens/syntax.hpp"
#include "frontend/tokens/token_cursor.hpp"
#include "support/diagnostics.hpp"

namespace skc::frontend {

class StreamEditor {
 public:
  /// `constants` numbers the generated constants.
  StreamEditor(TokenBuilder builder, Diagnostics& diagnostics, DeclarationSyntax& syntax, int& constants)
      : builder_(builder), diagnostics_(diagnostics), syntax_(syntax), constants_(constants) {}

  /// Takes the declaration, from `stream` to its `;`, and appends its replacement. Reports a wrong
  /// declaration, and appends nothing for it.
  void edit(TokenCursor& cursor, std::vector<clang::Token>& out);

 private:
  using Tokens = std::vector<clang::Token>;

  static void takeType(TokenCursor& cursor, Tokens& type);
  bool takeDeclarator(TokenCursor& cursor, const Tokens& type, Tokens& out);
  bool takeExtents(TokenCursor& cursor, std::vector<Tokens>& extents);
  ExtentSyntax extent(const Tokens& written, Tokens& out);
  bool fail(Diag diag, const clang::Token& location, std::initializer_list<std::string_view> arguments = {});

  TokenBuilder builder_;
  Diagnostics& diagnostics_;
  DeclarationSyntax& syntax_;
  int& constants_;
};

}  // namespace skc::frontend
