// SPDX-License-Identifier: MIT
//
// Operations that GLSL leaves undefined for some operands and the language defines for all. Tells which of
// them may have such operands, and so need more than GLSL's operator.
#pragma once

#include "ir/ir.hpp"

namespace skc::emit {

/// True for an integer quotient or remainder, unless the divisor is known to be neither 0 nor, for ints, -1.
bool mayDivideBadly(const ir::Module& module, ir::BinaryOp op, const ir::Expr& lhs, const ir::Expr& rhs);

/// True for a shift, unless the count is known to be 0 to 31.
bool mayShiftTooFar(const ir::Module& module, ir::BinaryOp op, const ir::Expr& count);

/// True for a conversion of reals to int or uint, unless the value is known to be in range.
bool mayNotHold(const ir::Module& module, ir::Type to, const ir::Expr& operand);

}  // namespace skc::emit
