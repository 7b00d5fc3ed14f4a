// SPDX-License-Identifier: MIT
//
// Runs kernels with variable or scatter outputs: the passes of assemble/append/append_passes.hpp, in order. A
// DeviceScope must be open.
#pragma once

#include "call/resolved_call.hpp"
#include "sk/program.hpp"

namespace sk {

class GlDevice;

/// Whether a kernel has a variable or a scatter output.
bool hasAppendOutputs(const program::Kernel& kernel);

/// Runs a kernel over its domain, which is not empty.
void runWithAppendOutputs(GlDevice& device, const ResolvedCall& call);

/// Runs such a kernel over an empty domain: its variable outputs become empty.
void runOverNothing(const ResolvedCall& call);

}  // namespace sk
