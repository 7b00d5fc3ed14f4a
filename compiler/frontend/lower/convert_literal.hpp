// SPDX-License-Identifier: MIT
//
// Converts literals when they are lowered, because `v = 1` reads better as 1.0 than as float(1).
#pragma once

#include "ir/ir.hpp"

namespace skc::frontend {

/// The literal of another scalar type that `e`, a scalar literal, becomes; null where the conversion stays in the program.
ir::ExprPtr convertLiteral(const ir::Expr& e, ir::Scalar to);

}  // namespace skc::frontend
