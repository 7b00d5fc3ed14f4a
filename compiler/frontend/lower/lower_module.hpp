// SPDX-License-Identifier: MIT
//
// Lowers Clang's checked tree to the IR: collects the file's declarations, lowers the user's functions, and
// turns those that the token editor marked into kernels.
#pragma once

#include <string>

#include "frontend/tokens/syntax.hpp"
#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace clang {
class Sema;
}

namespace skc::frontend {

/// The result is meaningful only if `diagnostics` has no errors afterwards.
ir::Module lowerModule(clang::Sema& sema, const DeclarationSyntax& syntax, const std::string& file,
                       Diagnostics& diagnostics);

}  // namespace skc::frontend
