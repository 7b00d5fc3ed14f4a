// SPDX-License-Identifier: MIT
//
// Edits one parameter list: determines each parameter's role, removes Brook's syntax from its tokens and
// records what it meant. The expressions of [[border(v)]], [[range(lo, hi)]] and a reduce's identity move into generated
// constants, where Clang checks them like any other.
#pragma once

#include <string_view>
#include <vector>

#include <clang/Lex/Token.h>

#include "frontend/tokens/comma_indices.hpp"
#include "frontend/tokens/syntax.hpp"
#include "frontend/tokens/token_cursor.hpp"
#include "support/diagnostics.hpp"

namespace clang {
class Preprocessor;
}

namespace skc::frontend {

class ParameterEditor {
 public:
  /// Appends generated constants to `before`; `constants` numbers them.
  ParameterEditor(clang::Preprocessor& preprocessor, Diagnostics& diagnostics, DeclarationSyntax& syntax,
                  int& constants, std::vector<clang::Token>& before)
      : preprocessor_(preprocessor),
        builder_(preprocessor),
        diagnostics_(diagnostics),
        syntax_(syntax),
        constants_(constants),
        before_(before) {}

  /// `T x<>` without a qualifier.
  struct Input {
    clang::Token first, name;
  };
  /// The inputs in the list edited last.
  const std::vector<Input>& inputs() const { return inputs_; }
  const std::vector<IndexedParameter>& indexed() const { return indexed_; }

  /// `declared` and the result include the parentheses.
  std::vector<clang::Token> edit(const std::vector<clang::Token>& declared, FunctionKind kind);

  /// Appends the member of a struct that `declared`, without its `;`, declares as a parameter: `[[wrap]] float4 sky[][]`,
  /// `spec bool spheres`. Reports what a bundle cannot have, and appends nothing for it.
  void editMember(const std::vector<clang::Token>& declared, std::vector<clang::Token>& out);

 private:
  using Tokens = std::vector<clang::Token>;
  struct ParameterParts;

  bool takeParts(const Tokens& parameter, ParameterParts& parts);
  void editParameter(const Tokens& parameter, FunctionKind kind, Tokens& out);
  bool takeAttributes(const Tokens& parameter, std::size_t& at, ParameterParts& parts);
  bool takeAttribute(const Tokens& parameter, std::size_t& at, ParameterParts& parts);
  bool takeBorder(const Tokens& parameter, std::size_t& at, ParameterParts& parts);
  bool takeHalo(const Tokens& parameter, std::size_t& at, ParameterParts& parts);
  bool takeRange(const Tokens& parameter, std::size_t& at, ParameterParts& parts);
  void takeQualifier(const Tokens& parameter, std::size_t& at, ParameterParts& parts);
  bool takeDeclarator(const Tokens& parameter, std::size_t& at, ParameterParts& parts);
  bool hasSecondQualifier(const ParameterParts& parts);
  bool hasLateQualifier(const ParameterParts& parts);
  bool takeSuffix(const Tokens& parameter, std::size_t& at, ParameterParts& parts);
  static std::vector<FixIt> addedBrackets(const ParameterParts& parts);
  static std::vector<FixIt> removedBrackets(const ParameterParts& parts);
  static std::vector<FixIt> asAccumulator(const ParameterParts& parts, std::string_view word);
  bool resolveRole(ParameterParts& parts, FunctionKind kind);
  bool resolveAppendOutput(ParameterParts& parts, FunctionKind kind);
  bool allowsRange(const ParameterParts& parts, FunctionKind kind);
  std::string generateConstant(const Tokens& type, const Tokens& value, clang::SourceLocation location);
  void print(const ParameterParts& parts, FunctionKind kind, Tokens& out, bool isMember = false);

  clang::Preprocessor& preprocessor_;
  TokenBuilder builder_;
  Diagnostics& diagnostics_;
  DeclarationSyntax& syntax_;
  int& constants_;
  std::vector<clang::Token>& before_;
  std::vector<Input> inputs_;
  std::vector<IndexedParameter> indexed_;
};

}  // namespace skc::frontend
