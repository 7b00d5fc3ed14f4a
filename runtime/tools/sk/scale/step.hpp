// SPDX-License-Identifier: MIT
//
// Turns kernels of a .sk file into the calls of a step: what their descriptors say of gathers, in the terms of model.hpp. It
// sets no rates.
#pragma once

#include <string>
#include <vector>

#include "accuracy/file/kernel_library.hpp"
#include "accuracy/file/ranges.hpp"
#include "scale/model.hpp"
#include "sk/library.hpp"

namespace sk_tool {

struct StepOptions {
  std::vector<std::string> kernels;  ///< in the order of the step; empty: each that can be distributed, once
  std::vector<std::string> constants;  ///< gathers that no step changes, as PARAM or KERNEL.PARAM
  Ranges ranges;  ///< has the values of spec parameters
};

struct StepOfFile {
  ScaledStep step;
  std::vector<Subject> subjects;  ///< one for each call
  std::vector<std::string> leftOut;  ///< why, for kernels that nobody named
};

/// Throws std::runtime_error if a named kernel does not exist or cannot be distributed, or if no kernel can be.
StepOfFile stepOf(const sk::program::Library& library, const Extents& grid, const StepOptions& options);

}  // namespace sk_tool
