// SPDX-License-Identifier: MIT
//
// Kernels with variable or scatter outputs: the passes of assemble/append/append_passes.hpp, in their order. A scope of the
// device must be open.
#pragma once

#include "call/resolved_call.hpp"
#include "sk/program.hpp"

namespace sk {

class GlDevice;

/// Whether a kernel has a variable or a scatter output.
bool hasAppendOutputs(const program::Kernel& kernel);

/// Runs a kernel over its domain, which is not empty.
void runWithAppendOutputs(GlDevice& device, const ResolvedCall& call);

/// What such a kernel leaves where there is no element: variable outputs of size 0.
void runOverNothing(const ResolvedCall& call);

}  // namespace sk
