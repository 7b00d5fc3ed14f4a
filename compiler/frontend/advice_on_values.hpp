// SPDX-License-Identifier: MIT
//
// Advice on values: streams where an element is meant, vectors where a number is meant, and operators that
// kernels do not have.
#pragma once

#include <string>

#include "frontend/advice.hpp"

namespace skc::frontend {

Advice adviceOnValues(const clang::Diagnostic& diagnostic, const DeclarationSyntax* syntax);

/// The first intrinsic that a piece of source text calls; "" if it calls none.
std::string intrinsicCalledIn(llvm::StringRef text);

}  // namespace skc::frontend
