// SPDX-License-Identifier: MIT
//
// Runs a function on numbers at compile time, to see what it computes. Floats are computed as doubles,
// without any device's roundings, and integers with 32 bits. There is no result if a function reads streams
// by index, does anything else that has no value here, or takes too many steps.
#pragma once

#include <optional>
#include <vector>

#include "ir/ir.hpp"

namespace skc {

/// All scalars of a value in order: an integer as its value, a bool as 0 or 1.
using Numbers = std::vector<double>;

/// The final values of the function's parameters.
std::optional<std::vector<Numbers>> tryFunction(const ir::Module& module, ir::FunctionId id,
                                                std::vector<Numbers> arguments);

/// The value of a constant expression.
std::optional<Numbers> tryConstant(const ir::Module& module, const ir::Expr& expr);

}  // namespace skc
