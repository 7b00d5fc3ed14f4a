// SPDX-License-Identifier: MIT
//
// For tests: runs functions for several elements at once, one per lane, and checks that the values of lanes relate as the
// analysis of uniform values says.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/uniformity.hpp"
#include "ir/ir.hpp"
#include "transforms/interpreter.hpp"

namespace skc {

struct Lanes {
  std::size_t count;
  bool inFull;  ///< as in InterpretedLanes
  std::size_t firstIndex;  ///< of lane 0, along x
  const analysis::Uniformity* shapes = nullptr;  ///< of the kernel, if they are to be checked
};

struct LanesResult {
  std::vector<Numbers> parameters;  ///< their final values
  std::vector<Numbers> pushed;  ///< one list per lane
};

/// Throws std::runtime_error if a value has another shape than the analysis says, or if control flow diverges, does not end,
/// or meets what the interpreter does not know.
LanesResult interpretLanes(const ir::Module& module, ir::FunctionId id, std::vector<Numbers> arguments,
                           const Lanes& lanes);

}  // namespace skc
