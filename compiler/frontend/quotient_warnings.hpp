// SPDX-License-Identifier: MIT
//
// Warns of quotients of integer literals that become floats: `1/2 * x` is 0, as in C++, and hardly ever meant.
#pragma once

#include <clang/AST/ASTContext.h>

#include "support/diagnostics.hpp"

namespace skc::frontend {

/// Checks every function and constant of the program, but not the prelude.
void warnOfQuotients(clang::ASTContext& context, Diagnostics& diagnostics);

}  // namespace skc::frontend
