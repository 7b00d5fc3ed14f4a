// SPDX-License-Identifier: MIT
//
// Our words in place of Clang's, where Clang's message is about C++ and the mistake is about kernels: names
// from other languages (advice_on_names), indices, conversions, conditions and operators (advice_on_values).
// Advice is a row of diagnostics.def. It depends on nothing but the diagnostic and the declarations.
#pragma once

#include <string>
#include <vector>

#include <clang/Basic/Diagnostic.h>

#include "frontend/tokens/syntax.hpp"

namespace skc::frontend {

/// Our replacement for one of Clang's messages.
struct Advice {
  std::string text = {};  ///< "" keeps Clang's own
  std::vector<clang::FixItHint> fixIts = {};
  bool explainsLine = false;  ///< what Clang reports later on the same line follows from this
  bool isOfMainFile = false;  ///< shown at the inclusion in the main file that leads there
  bool keepsNotes = false;    ///< Clang's notes follow, such as where the other declaration is
};

/// `syntax` is null until the file's declarations are known.
Advice adviceOn(const clang::Diagnostic& diagnostic, const DeclarationSyntax* syntax);

/// Advice on names that kernels do not have, on headers, and on directives.
Advice adviceOnNames(const clang::Diagnostic& diagnostic);

/// Advice on values: streams where an element is meant, vectors where a number is meant, and operators that kernels do not
/// have.
Advice adviceOnValues(const clang::Diagnostic& diagnostic, const DeclarationSyntax* syntax);

/// The first intrinsic that a piece of source text calls; "" if it calls none.
std::string intrinsicCalledIn(llvm::StringRef text);

}  // namespace skc::frontend
