// SPDX-License-Identifier: MIT
//
// The identities of the operators by which reduces fold.
#pragma once

#include "ir/ir.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {

/// The neutral element of an associative operator of a FoldPattern, for a component of this type.
ir::ExprPtr neutralOf(FoldOp op, ir::Scalar scalar);

/// Whether folding a value twice is the same as folding it once, as for min: then a value from which runs start bounds
/// the result, but always gives the same one.
bool isIdempotent(FoldOp op);

}  // namespace skc
