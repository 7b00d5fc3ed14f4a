// SPDX-License-Identifier: MIT
//
// Runs a function on numbers while skc compiles, to see what it computes. Floats are computed as doubles, without the
// roundings of any device, and integers with 32 bits. There is no result where a function reads streams by index or does
// anything else that has no value here, or takes too many steps.
#pragma once

#include <optional>
#include <vector>

#include "ir/ir.hpp"

namespace skc {

/// All scalars of a value, one after the other: an integer as what it is, a bool as 0 or 1.
using Numbers = std::vector<double>;

/// What the function's parameters are at its end.
std::optional<std::vector<Numbers>> tryFunction(const ir::Module& module, ir::FunctionId id,
                                                std::vector<Numbers> arguments);

/// The value of an expression of constants.
std::optional<Numbers> tryConstant(const ir::Module& module, const ir::Expr& expr);

}  // namespace skc
