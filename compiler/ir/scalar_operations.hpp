// SPDX-License-Identifier: MIT
//
// What operators, conversions and intrinsics compute of single scalars, as docs/language.md defines them, for everything that
// interprets the IR. A scalar is a double here, which represents every bool (as 0 or 1), integer and float. Results of real
// numbers are not rounded to float: interpreters differ in that, and round as each of them has to.
#pragma once

#include <cstdint>
#include <optional>

#include "ir/ir.hpp"

namespace skc::ir {

/// The integer whose bits are the low bits of `value`.
double wrapped(Scalar scalar, std::int64_t value);

double valueOf(Scalar scalar, const Literal& literal);

/// A conversion from a real number to an integer truncates and saturates, and NaN becomes 0. One to a real number keeps the
/// value, also if the type cannot represent it.
double converted(Scalar from, Scalar to, double value);

double computed(UnaryOp op, Scalar scalar, double x);

/// Integers wrap; x / 0 is x and x % 0 is 0; shift counts are taken modulo 32. `scalar` is the type of the left operand. Returns
/// nullopt if its type has no such operator.
std::optional<double> computed(BinaryOp op, Scalar scalar, double x, double y);

/// Intrinsics that are computed component by component and never round. Returns nullopt for all others.
std::optional<double> computed(Intrinsic intrinsic, Scalar scalar, double x, double y, double z);

}  // namespace skc::ir
