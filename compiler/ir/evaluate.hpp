// SPDX-License-Identifier: MIT
//
// Evaluates an expression of scalar literals as a device would: 32-bit floats with one rounding per
// operation, integers that wrap. It gives no value where devices may differ: division by zero, shifts past
// the width, conversions out of range, results or operands that are NaN, infinite or denormal.
#pragma once

#include <cstdint>
#include <optional>

#include "ir/ir.hpp"

namespace skc::ir {

enum class Constants : std::uint8_t {
  Keep,         ///< a named constant has no value, so that its name stays in the program
  LookThrough,
};

/// The result's bits, as in ir::Literal.
std::optional<std::uint32_t> evaluate(const Module& module, const Expr& expr, Constants constants);

}  // namespace skc::ir
