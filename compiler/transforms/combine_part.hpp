// SPDX-License-Identifier: MIT
//
// Builds the statement that combines two partial results for one part of a fold.
#pragma once

#include "ir/ir.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {

/// `total op= partial` for the part's member or components. Both are variables of `function` with the
/// accumulator's type.
ir::Stmt combinePart(const ir::Module& module, const ir::Function& function, const FoldPart& part,
                     ir::VarId partial, ir::VarId total);

}  // namespace skc
