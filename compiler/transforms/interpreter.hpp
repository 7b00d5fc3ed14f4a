// SPDX-License-Identifier: MIT
//
// Runs a function on numbers at compile time, to see what it computes. Floats are computed as doubles,
// without any device's roundings, and integers with their own bits. There is no result if a function does
// something that has no value here, or takes too many steps.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "ir/ir.hpp"

namespace skc {

/// All scalars of a value in order: an integer as its value, a bool as 0 or 1.
using Numbers = std::vector<double>;

/// What a kernel's entry reads besides its arguments.
struct InterpretedStreams {
  using Index = std::array<std::int64_t, 4>;  ///< x first; 0 in dimensions that the stream has not
  /// Element `index`, which may be outside, of the stream that a parameter of the kernel stands for.
  std::function<Numbers(ir::VarId param, const Index& index)> read;
  Index index = {};  ///< of the element in every stream
  Index extent = {1, 1, 1, 1};  ///< of every stream
};

/// The final values of the function's parameters. `steps` is what may be spent, and is reduced by what was.
std::optional<std::vector<Numbers>> interpret(const ir::Module& module, ir::FunctionId id,
                                              std::vector<Numbers> arguments,
                                              const InterpretedStreams& streams, int& steps);

/// The value of a constant expression.
std::optional<Numbers> interpretConstant(const ir::Module& module, const ir::Expr& expr);

}  // namespace skc
