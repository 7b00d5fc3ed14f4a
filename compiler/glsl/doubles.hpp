// SPDX-License-Identifier: MIT
//
// Turns operations on doubles into calls, so that the GLSL works both for native doubles and for pairs of floats: `sk_add(a, b)`,
// never `a + b`. The assembler defines the functions for one component (runtime/src/assemble/glsl/double_intrinsics.hpp); polyfills are
// those for vectors, and functions derived from them. In both representations, single components are members: `v.x`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "glsl/polyfills.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

/// The text of a literal.
std::string doubleLiteral(const ir::Literal& literal);
/// -a.
ir::ExprPtr doubleNegated(Polyfills& polyfills, ir::ExprPtr operand);
/// + - * / and comparisons; comparing vectors gives a bool vector.
ir::ExprPtr doubleBinary(Polyfills& polyfills, ir::BinaryOp op, ir::ExprPtr a, ir::ExprPtr b);
/// Converts to or from double, at equal width.
ir::ExprPtr doubleConverted(Polyfills& polyfills, ir::Type to, ir::ExprPtr operand);
/// A double or a vector from parts whose components add up to its width, or from one scalar.
ir::ExprPtr doubleVector(Polyfills& polyfills, ir::Type type, std::vector<ir::ExprPtr> parts);
ir::ExprPtr doubleIntrinsic(Polyfills& polyfills, ir::Intrinsic intrinsic, std::vector<ir::ExprPtr> args);

/// Several components of a vector.
ir::ExprPtr doubleSwizzle(Polyfills& polyfills, const std::vector<std::uint8_t>& components,
                          ir::ExprPtr vector);
/// The component at a computed index: an int of a component of the vector.
ir::ExprPtr doubleComponent(Polyfills& polyfills, ir::ExprPtr vector, ir::ExprPtr index);
/// `vector` with these components, or the one at a computed index, replaced by `value`.
ir::ExprPtr doubleWith(Polyfills& polyfills, const std::vector<std::uint8_t>& components, ir::ExprPtr vector,
                       ir::ExprPtr value);
ir::ExprPtr doubleWithComponent(Polyfills& polyfills, ir::ExprPtr vector, ir::ExprPtr index,
                                ir::ExprPtr value);

}  // namespace skc::emit
