// SPDX-License-Identifier: MIT
//
// The identities of the operators that reduces fold by.
#pragma once

#include "ir/ir.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {

/// The identity of an associative operator of a FoldPattern, for a component type.
ir::ExprPtr neutralOf(FoldOp op, ir::Scalar scalar);

/// True if folding a value twice equals folding it once, as for min: a given initial value then bounds the
/// result, but the result is always the same.
bool isIdempotent(FoldOp op);

/// True if every accumulator of a reduce has an identity.
bool hasIdentities(const ir::Kernel& kernel);

}  // namespace skc
