// SPDX-License-Identifier: MIT
//
// Which operands of floats a driver's compiler may know, so that it might take `x + 0.0` for x or `x * 0.0` for 0.
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
bool comparesWholeWithZero(ir::BinaryOp op, const ir::Expr& lhs, const ir::Expr& rhs);

}  // namespace skc::emit
