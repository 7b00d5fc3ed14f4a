// SPDX-License-Identifier: MIT
//
// Reads the parts of one of Clang's diagnostics: names and types among its arguments, and the source text of
// the ranges that it marks. Decides nothing about messages.
#pragma once

#include <string>
#include <vector>

#include <clang/AST/Type.h>
#include <clang/Basic/Diagnostic.h>
#include <llvm/ADT/StringRef.h>

namespace skc::frontend {

/// The text of an argument that is a name or a string; "" for other arguments.
std::string nameIn(const clang::Diagnostic& diagnostic, unsigned argument);

/// The arguments that are types, in their order.
std::vector<clang::QualType> typesIn(const clang::Diagnostic& diagnostic);

/// The source text of one of the marked ranges; "" if there are fewer.
llvm::StringRef textOf(const clang::Diagnostic& diagnostic, unsigned range = 0);

/// The source text from the diagnostic's location to the end of the file, without macros' expansions.
llvm::StringRef textAt(const clang::Diagnostic& diagnostic);

/// The source text from the start of the file to the diagnostic's location, without macros' expansions.
llvm::StringRef textBefore(const clang::Diagnostic& diagnostic);

/// The identifier at the start of a text.
llvm::StringRef nameAt(llvm::StringRef text);

/// The text up to the bracket that closes the one at its start, both included; "" if it opens with none.
llvm::StringRef bracketedAt(llvm::StringRef text);

/// True if the type is a class of the prelude whose name starts like this.
bool isOfClass(clang::QualType type, llvm::StringRef name);

/// The number of components of a vector; 1 for other types, 0 for a null type.
unsigned widthOf(clang::QualType type);

/// A type as .sk files write it: "float3", "int".
std::string spellingOf(clang::QualType type);

}  // namespace skc::frontend
