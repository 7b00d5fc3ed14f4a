// SPDX-License-Identifier: MIT
//
// Expressions of doubles as GLSL that is right for native doubles and for pairs of floats, because all
// of it is calls: `sk_add(a, b)`, never `a + b`. What a call stands for on one component is the
// assembler's (runtime/src/assemble/glsl/doubles.hpp); what it is on vectors, and what follows from others,
// is defined here, as polyfills of the body. Both forms have single components as members: `v.x`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "glsl/polyfills.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

std::string doubleLiteral(const ir::Literal& literal);
std::string doubleNegated(Polyfills& polyfills, ir::Type type, const std::string& operand);
/// Of + - * / and comparisons; the result of a comparison of vectors is a bool vector.
std::string doubleBinary(Polyfills& polyfills, ir::BinaryOp op, ir::Type lhs, ir::Type rhs,
                         const std::string& a, const std::string& b);
/// To or from double, of equal width.
std::string doubleConverted(Polyfills& polyfills, ir::Type from, ir::Type to, const std::string& operand);
/// A vector of parts whose components add up to its width, or of one scalar.
std::string doubleVector(Polyfills& polyfills, ir::Type type, const std::vector<ir::Type>& parts,
                         const std::vector<std::string>& texts);
std::string doubleIntrinsic(Polyfills& polyfills, ir::Intrinsic intrinsic, const std::vector<ir::Type>& types,
                            const std::vector<std::string>& texts);

/// Several components of a vector.
std::string doubleSwizzle(Polyfills& polyfills, ir::Type base, const std::vector<std::uint8_t>& components,
                          const std::string& vector);
/// The component at a computed index, an int or uint.
std::string doubleComponent(Polyfills& polyfills, ir::Type base, const std::string& vector,
                            const std::string& index);
/// `vector` with these components, or with the one at a computed index, replaced by `value`.
std::string doubleWith(Polyfills& polyfills, ir::Type base, const std::vector<std::uint8_t>& components,
                       const std::string& vector, const std::string& value);
std::string doubleWithComponent(Polyfills& polyfills, ir::Type base, const std::string& vector,
                                const std::string& index, const std::string& value);

}  // namespace skc::emit
