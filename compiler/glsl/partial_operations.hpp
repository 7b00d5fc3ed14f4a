// SPDX-License-Identifier: MIT
//
// Operations that GLSL leaves undefined for some operands, and that the language defines for all: which of them need
// more than GLSL's operator, since their operands may be such.
#pragma once

#include "ir/ir.hpp"

namespace skc::emit {

/// A quotient or remainder of integers, unless the divisor is known to be neither 0 nor, of ints, -1.
bool mayDivideBadly(const ir::Module& module, ir::BinaryOp op, const ir::Expr& lhs, const ir::Expr& rhs);

/// A shift, unless the count is known to be 0 to 31.
bool mayShiftTooFar(const ir::Module& module, ir::BinaryOp op, const ir::Expr& count);

/// A conversion of reals to int or uint, unless the value is known to be one of theirs.
bool mayNotHold(const ir::Module& module, ir::Type to, const ir::Expr& operand);

}  // namespace skc::emit
