// SPDX-License-Identifier: MIT
//
// The value of an expression of scalar literals, computed as the device would: 32-bit floats with one
// rounding per operation, integers that wrap. There is no value where devices may differ: division
// by zero, shifts past the width, conversions out of range, results or operands that are NaN,
// infinite or denormal.
#pragma once

#include <cstdint>
#include <optional>

#include "ir/ir.hpp"

namespace skc::ir {

enum class Constants : std::uint8_t {
  Keep,         ///< a named constant has no value here, so that its name stays in the program
  LookThrough,
};

/// The bits of ir::Literal.
std::optional<std::uint32_t> evaluate(const Module& module, const Expr& expr, Constants constants);

}  // namespace skc::ir
