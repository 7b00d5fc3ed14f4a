// SPDX-License-Identifier: MIT
//
// Edits a declaration of streams. From
//
//   stream float u<height, 2 * n>, v<n>;
//
// Clang gets the type of each stream, and the values of extents that are more than a name, to check them:
//
//   static const auto __sk_constant3 __attribute__((unused)) = 2 * n; extern float u; extern float v;
//
// Copies tokens, and turns vector constructors, which Clang's vectors do not have, into calls:
//
//   float4(v.xy, 0, 1)        __sk_make_float4(v.xy, 0, 1)
//   float2 a(3, 4), b(1);     float2 a = __sk_make_float2(3, 4), b = __sk_make_float2(1);
//   using Color = float4;     using Color = float4;
//   Color(1, 0, 0, 1)         __sk_make_float4(1, 0, 0, 1)        in the scope of the alias, or as ns::Color
//   index<N>(p, 0)            __sk_make_index<N>(p, 0)
//
// Edits the attribute [[table(lo, hi, n, linear)]] in front of a helper function. Its arguments may be any
// constant expressions; they become constants in front of the function.
#pragma once

#include <optional>
#include <string>
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

/// True at the `t` of `t<>` in the body of a pipeline, behind the token `before`, where it declares a stream. Reports
/// streams with extents or values.
bool atLocalStream(const TokenCursor& cursor, const clang::Token& before, Diagnostics& diagnostics);

class ConstructorEditor {
 public:
  explicit ConstructorEditor(TokenBuilder builder) : builder_(builder) {}

  /// Takes one token and appends its replacement.
  void copy(TokenCursor& cursor, std::vector<clang::Token>& out);
  /// `index` may be a name of the program, and `index<...>(...)` a comparison.
  void keepIndex() { constructsIndices_ = false; }

 private:
  using Tokens = std::vector<clang::Token>;
  /// A name as written: where it begins, and "::a::b::c".
  struct Name {
    std::size_t begin;
    std::string path;
    bool isGlobal = false;  ///< preceded by `::`
  };
  struct Alias {
    std::string path;  ///< names of the enclosing braces, then its own
    std::string vector;
  };
  struct Brace {
    std::string name;  ///< "::a" of a namespace, which may be reopened; else unique
    bool holdsStatements;
  };

  static Name nameEndingAt(const Tokens& tokens, std::size_t end);
  std::string vectorNamed(const Name& name) const;
  void noteAlias(const Tokens& out);
  std::string openScope() const;
  bool areStatements() const { return !braces_.empty() && braces_.back().holdsStatements; }
  void noteBraces(const Tokens& out);
  void noteDeclaration(const TokenCursor& cursor, const Tokens& out);
  bool initialisesVariable(const TokenCursor& cursor, const Tokens& out) const;

  TokenBuilder builder_;
  bool constructsIndices_ = true;
  std::vector<Alias> aliases_;
  std::vector<Brace> braces_;  ///< open ones
  int bracesSeen_ = 0;
  std::string namespace_;  ///< the name after `namespace`, until its brace
  bool sawNamespace_ = false;
  bool sawRecord_ = false;  ///< `struct` or similar, in this statement
  bool sawConst_ = false;  ///< `const` or `constexpr`, in this statement
  bool sawConstraint_ = false;  ///< `requires`, in this declaration
  std::string declared_;  ///< vector type of the variables being declared, or empty
  int depth_ = 0;  ///< of parentheses and brackets, in this declaration
};

/// True if the attributes that follow begin with a table.
bool namesTable(const TokenCursor& cursor);

/// Consumes `tokens` attribute tokens and appends the constants to `out`; returns nullopt after reporting an
/// error. `constants` numbers the file's generated constants.
std::optional<TableSyntax> takeTable(TokenCursor& cursor, std::size_t tokens, const TokenBuilder& builder,
                                     Diagnostics& diagnostics, int& constants,
                                     std::vector<clang::Token>& out);

}  // namespace skc::frontend
