// SPDX-License-Identifier: MIT
//
// Edits the members of structs that are parameters of kernels, which makes the struct a bundle. From
//
//   struct Scene { [[wrap]] float4 sky[][], ground[]; spec bool spheres; View view; };
//
// Clang gets
//
//   struct Scene { gather_2d<float4> sky; gather_1d<float4> ground; bool spheres; View view; };
#pragma once

#include <vector>

#include <clang/Lex/Token.h>
#include <llvm/ADT/StringSet.h>

#include "frontend/tokens/parameter_editor.hpp"
#include "frontend/tokens/token_cursor.hpp"

namespace skc::frontend {

class BundleEditor {
 public:
  explicit BundleEditor(ParameterEditor& parameters) : parameters_(parameters) {}

  /// Takes the members from here on that only bundles have, and appends their replacements.
  void edit(TokenCursor& cursor, std::vector<clang::Token>& out);

 private:
  bool editMember(TokenCursor& cursor, std::vector<clang::Token>& out);

  ParameterEditor& parameters_;
};

/// Whether `<` follows the name wherever the program has it, so that it can be no variable.
bool hasListsOnly(const TokenCursor& cursor, llvm::StringRef name);

/// The names of the prelude which the program declares for itself, outside of any namespace (isYielding()).
llvm::StringSet<> declaredInPlace(const TokenCursor& cursor);

}  // namespace skc::frontend
