// SPDX-License-Identifier: MIT
//
// Kernels with variable or scatter outputs: the passes of assemble/sinks.hpp, in their order. A scope of the
// device must be open.
#pragma once

#include <span>

#include "sk/call.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"

namespace sk {

class GlDevice;

/// Whether a kernel has a variable or a scatter output.
bool hasSinks(const program::Kernel& kernel);

/// Runs a kernel over `domain`, which is not empty. The arguments have been checked.
void runWithSinks(GlDevice& device, const program::Kernel& kernel, std::span<const Argument> arguments,
                  const Shape& domain);

/// What such a kernel leaves where there is no element: variable outputs of size 0.
void runOverNothing(const program::Kernel& kernel, std::span<const Argument> arguments);

}  // namespace sk
