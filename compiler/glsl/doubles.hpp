// SPDX-License-Identifier: MIT
//
// Prints expressions of doubles as GLSL that works both for native doubles and for pairs of floats, because
// all operations are calls: `sk_add(a, b)`, never `a + b`. The assembler defines the calls for one component
// (runtime/src/assemble/glsl/double_intrinsics.hpp); this code defines them for vectors, and the functions derived from
// them, as polyfills of the body. In both representations, single components are members: `v.x`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "glsl/polyfills.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

std::string doubleLiteral(const ir::Literal& literal);
std::string doubleNegated(Polyfills& polyfills, ir::Type type, const std::string& operand);
/// + - * / and comparisons; comparing vectors gives a bool vector.
std::string doubleBinary(Polyfills& polyfills, ir::BinaryOp op, ir::Type lhs, ir::Type rhs,
                         const std::string& a, const std::string& b);
/// Converts to or from double, at equal width.
std::string doubleConverted(Polyfills& polyfills, ir::Type from, ir::Type to, const std::string& operand);
/// A vector from parts whose components add up to its width, or from one scalar.
std::string doubleVector(Polyfills& polyfills, ir::Type type, const std::vector<ir::Type>& parts,
                         const std::vector<std::string>& texts);
std::string doubleIntrinsic(Polyfills& polyfills, ir::Intrinsic intrinsic, const std::vector<ir::Type>& types,
                            const std::vector<std::string>& texts);

/// Several components of a vector.
std::string doubleSwizzle(Polyfills& polyfills, ir::Type base, const std::vector<std::uint8_t>& components,
                          const std::string& vector);
/// The component at a computed index: an int of a component of the vector.
std::string doubleComponent(Polyfills& polyfills, ir::Type base, const std::string& vector,
                            const std::string& index);
/// `vector` with these components, or the one at a computed index, replaced by `value`.
std::string doubleWith(Polyfills& polyfills, ir::Type base, const std::vector<std::uint8_t>& components,
                       const std::string& vector, const std::string& value);
std::string doubleWithComponent(Polyfills& polyfills, ir::Type base, const std::string& vector,
                                const std::string& index, const std::string& value);

}  // namespace skc::emit
