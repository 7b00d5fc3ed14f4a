// SPDX-License-Identifier: MIT
//
// Turns operations on wide values into calls: on doubles, so that the GLSL works both for native doubles and for pairs of floats,
// and on integers of 64 bits, which are two words: `sk_add(a, b)`, never `a + b`. The assembler defines the functions for one
// component (runtime/src/assemble/glsl); polyfills are those for vectors, and functions derived from them. Single components of a
// vector are members: `v.x`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "glsl/polyfills.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

/// The text of a literal.
std::string wideText(ir::Scalar scalar, const ir::Literal& literal);
/// -a and ~a.
ir::ExprPtr wideUnary(Polyfills& polyfills, ir::UnaryOp op, ir::ExprPtr operand);
/// Arithmetic and comparisons; comparing vectors gives a bool vector.
ir::ExprPtr wideBinary(Polyfills& polyfills, ir::BinaryOp op, ir::ExprPtr a, ir::ExprPtr b);
/// Converts to or from a wide type, at equal width.
ir::ExprPtr wideConverted(Polyfills& polyfills, ir::Type to, ir::ExprPtr operand);
/// A scalar or a vector from parts whose components add up to its width, or from one scalar.
ir::ExprPtr wideVector(Polyfills& polyfills, ir::Type type, std::vector<ir::ExprPtr> parts);
ir::ExprPtr wideIntrinsic(Polyfills& polyfills, ir::Intrinsic intrinsic, std::vector<ir::ExprPtr> args);

/// Several components of a vector.
ir::ExprPtr wideSwizzle(Polyfills& polyfills, const std::vector<std::uint8_t>& components,
                        ir::ExprPtr vector);
/// The component at a computed index: an int of a component of the vector.
ir::ExprPtr wideComponent(Polyfills& polyfills, ir::ExprPtr vector, ir::ExprPtr index);
/// `vector` with these components, or the one at a computed index, replaced by `value`.
ir::ExprPtr wideWith(Polyfills& polyfills, const std::vector<std::uint8_t>& components, ir::ExprPtr vector,
                     ir::ExprPtr value);
ir::ExprPtr wideWithComponent(Polyfills& polyfills, ir::ExprPtr vector, ir::ExprPtr index, ir::ExprPtr value);

}  // namespace skc::emit
