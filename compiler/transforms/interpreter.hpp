// SPDX-License-Identifier: MIT
//
// Runs a function on numbers at compile time, to see what it computes. Floats are computed as doubles,
// without any device's roundings, and integers with their own bits. There is no result if a function does
// something that has no value here, or takes too many steps. Constants are folded elsewhere (ir/evaluate.hpp), from the same
// operators (ir/scalar_operations.hpp): with what only some operands tell, and only where all devices agree.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "ir/ir.hpp"

namespace skc {

/// All scalars of a value in order: an integer as its value, a bool as 0 or 1. With several lanes, those of one after the other.
using Numbers = std::vector<double>;

/// What a kernel's entry reads besides its arguments.
struct InterpretedStreams {
  using Index = std::array<std::int64_t, 4>;  ///< x first; 0 in dimensions that the stream has not
  /// Element `index`, which may be outside, of the stream that a parameter of the kernel stands for.
  std::function<Numbers(ir::VarId param, const Index& index)> read;
  Index index = {};  ///< of the element in every stream
  Index extent = {1, 1, 1, 1};  ///< of every stream
};

/// The elements that a function computes at once, one per lane, as native code does after predicate. Control flow is uniform,
/// else there is no result.
struct InterpretedLanes {
  std::size_t count =
      1;  ///< the first lane has the index of InterpretedStreams, the next one the next along x
  bool inFull = false;  ///< `&&`, `||` and `?:` evaluate all their operands; required for more than one lane
  /// A variable's value before its first assignment; 0 if empty.
  std::function<Numbers(ir::FunctionId, ir::VarId)> unassigned = {};
  /// Called with each value that a variable gets.
  std::function<void(ir::FunctionId, ir::VarId, const Numbers&)> assigned = {};
  /// Called for each push of a scalar; if empty, a function that pushes has no result.
  std::function<void(std::size_t lane, double value)> pushed = {};
};

/// The final values of the function's parameters. `steps` is what may be spent, and is reduced by what was.
std::optional<std::vector<Numbers>> interpret(const ir::Module& module, ir::FunctionId id,
                                              std::vector<Numbers> arguments,
                                              const InterpretedStreams& streams, int& steps,
                                              const InterpretedLanes& lanes = {});

/// The value of a constant expression.
std::optional<Numbers> interpretConstant(const ir::Module& module, const ir::Expr& expr);

}  // namespace skc
