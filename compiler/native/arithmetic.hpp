// SPDX-License-Identifier: MIT
//
// The language's operators and conversions of one scalar, in all lanes: as docs/language.md defines them for every operand.
// Arithmetic of integers wraps; a quotient by 0 is the dividend and the remainder 0; a shift counts modulo 32; a real number
// becomes the nearest integer towards 0 that the type holds, and NaN 0.
#pragma once

#include "ir/ir.hpp"
#include "native/lanes.hpp"

namespace skc::native {

Part unary(Lanes& lanes, ir::UnaryOp op, ir::Scalar scalar, const Part& operand);
/// Both operands are of the type `scalar`, except that a shift's count may be the other integer type. `&&` and `||`
/// evaluate both.
Part binary(Lanes& lanes, ir::BinaryOp op, ir::Scalar scalar, const Part& lhs, const Part& rhs);
Part convert(Lanes& lanes, ir::Scalar from, ir::Scalar to, const Part& operand);

}  // namespace skc::native
