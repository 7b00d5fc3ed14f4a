// SPDX-License-Identifier: MIT
//
// What is known of operands, by GLSL's compilers and by us: floats that a driver's compiler may know, so that it might take
// `x + 0.0` for x or `x * 0.0` for 0; and operands that may be among those for which GLSL leaves an operation undefined.
#pragma once

#include <cstdint>

#include "ir/ir.hpp"

namespace skc::emit {

/// True for the bits of the floats 0 and -0.
bool isZero(std::uint32_t bits);

/// True for a literal, or a vector of literals.
bool isLiteral(const ir::Expr& expr);

/// True for a constant that is a float or a vector, or the part of a constant that is the first to be one, if it may hold 0.
bool mayBeKnownZero(const ir::Module& module, const ir::Expr& expr);

/// True for a float or a vector whose value a compiler may know, so that it might multiply by its rounded reciprocal, where it
/// divides an expression of this function. Powers of two, whose reciprocals are exact, do not matter, nor do operations, which
/// hide their values.
bool mayBeKnownDivisor(const ir::Module& module, const ir::Kernel& kernel, ir::FunctionId function,
                       const ir::Expr& expr);

/// True for functions of which compilers know what they undo: sqrt(x) * sqrt(x) is x to them.
bool mayCancel(ir::Intrinsic intrinsic);

/// True if no compiler can know the value, since the expression reads what only the running program has.
bool isUnknown(const ir::Expr& expr);

/// True for a literal that is no negative int.
bool isNonNegative(const ir::Expr& expr);

/// True for a literal that is 0 or -0 as a float.
bool isLiteralZero(const ir::Expr& expr);

/// True for `floor(x) == 0`, `ceil(x) + y != 0` and the like, which Polyfills::nonzero() must decide: some drivers take the
/// value for known.
bool comparesRoundedWithZero(ir::BinaryOp op, const ir::Expr& lhs, const ir::Expr& rhs);

// Operations that GLSL leaves undefined for some operands and the language defines for all. Tells which of
// them may have such operands, and so need more than GLSL's operator.

/// True for an integer quotient or remainder, unless the divisor is known to be neither 0 nor, for ints, -1.
bool mayDivideBadly(const ir::Module& module, ir::BinaryOp op, const ir::Expr& lhs, const ir::Expr& rhs);

/// True for a shift, unless the count is known to be 0 to 31.
bool mayShiftTooFar(const ir::Module& module, ir::BinaryOp op, const ir::Expr& count);

/// True for a conversion of reals to int or uint, unless the value is known to be in range.
bool mayNotHold(const ir::Module& module, ir::Type to, const ir::Expr& operand);

}  // namespace skc::emit
