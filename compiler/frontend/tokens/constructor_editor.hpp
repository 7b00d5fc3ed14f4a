// SPDX-License-Identifier: MIT
//
// Copies tokens, and turns vector constructors, which Clang's vectors do not have, into calls:
//
//   float4(v.xy, 0, 1)        __sk_make_float4(v.xy, 0, 1)
//   float2 a(3, 4), b(1);     float2 a = __sk_make_float2(3, 4), b = __sk_make_float2(1);
//   using Color = float4;     using Color = float4;
//   Color(1, 0, 0, 1)         __sk_make_float4(1, 0, 0, 1)        in the scope of the alias, or as ns::Color
#pragma once

#include <string>
#include <vector>

#include <clang/Lex/Token.h>

#include "frontend/tokens/token_cursor.hpp"

namespace skc::frontend {

class ConstructorEditor {
 public:
  explicit ConstructorEditor(TokenBuilder builder) : builder_(builder) {}

  /// Takes one token and appends its replacement.
  void copy(TokenCursor& cursor, std::vector<clang::Token>& out);

 private:
  using Tokens = std::vector<clang::Token>;
  /// A name as written: where it begins, and "::a::b::c".
  struct Name {
    std::size_t begin;
    std::string path;
    bool isGlobal = false;   ///< preceded by `::`
  };
  struct Alias {
    std::string path;    ///< names of the enclosing braces, then its own
    std::string vector;
  };
  struct Brace {
    std::string name;    ///< "::a" of a namespace, which may be reopened; else unique
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
  std::vector<Alias> aliases_;
  std::vector<Brace> braces_;     ///< open ones
  int bracesSeen_ = 0;
  std::string namespace_;         ///< the name after `namespace`, until its brace
  bool sawNamespace_ = false;
  bool sawRecord_ = false;        ///< `struct` or similar, in this statement
  bool sawConst_ = false;         ///< `const` or `constexpr`, in this statement
  bool sawConstraint_ = false;    ///< `requires`, in this declaration
  std::string declared_;          ///< vector type of the variables being declared, or empty
  int depth_ = 0;                 ///< of parentheses and brackets, in this declaration
};

}  // namespace skc::frontend
