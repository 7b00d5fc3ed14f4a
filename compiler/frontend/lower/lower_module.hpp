// SPDX-License-Identifier: MIT
//
// From Clang's checked tree to the IR: collects the declarations of the file, lowers every function
// of the user's, and makes kernels of those that the token editor marked.
#pragma once

#include <string>

#include "frontend/tokens/syntax.hpp"
#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace clang {
class Sema;
}

namespace skc::frontend {

/// The result is only meaningful where `diagnostics` has no errors afterwards.
ir::Module lowerModule(clang::Sema& sema, const DeclarationSyntax& syntax, const std::string& file,
                       Diagnostics& diagnostics);

}  // namespace skc::frontend
