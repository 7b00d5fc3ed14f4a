// SPDX-License-Identifier: MIT
//
// Evaluates an expression of scalar literals as a device would: floats with one rounding per operation, integers
// that wrap. It gives no value where devices may differ: division by zero, shifts past the width, conversions out of range,
// results or operands that are NaN, infinite or denormal.
#pragma once

#include <cstdint>
#include <optional>

#include "ir/ir.hpp"

namespace skc::ir {

enum class Constants : std::uint8_t {
  Keep,  ///< a named constant has no value, so that its name stays in the program
  LookThrough,
};

/// The result's bits, as in ir::Literal, if they are the same in all variants of a kernel: whether its floats are halves, floats or
/// doubles, and its literals are rounded to these. 0.5 * 0.25 has a value, and 0.1 > 0, but not 0.1 * 3.
std::optional<std::uint32_t> evaluate(const Module& module, const Expr& expr, Constants constants);

/// The result's bits where floats are floats.
std::optional<std::uint32_t> evaluateInFloat(const Module& module, const Expr& expr, Constants constants);

}  // namespace skc::ir
