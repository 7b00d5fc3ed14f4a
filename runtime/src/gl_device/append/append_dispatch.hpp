// SPDX-License-Identifier: MIT
//
// Runs kernels with append outputs as compute programs (assemble/append/append_groups.hpp): one dispatch, with one before it if
// plain stores need owners or if room for pushes must be known. A DeviceScope must be open.
#pragma once

#include "call/resolved_call.hpp"

namespace sk {

class GlDevice;

/// Runs a call over its domain, which is not empty; its compute programs are selected. Returns false, and has no effect, if
/// compute programs cannot run it: they write no textures with layers, no more images than the device has, and at most
/// one region of a stream. Throws sk::Error if memory is exhausted or the driver rejects a program.
bool dispatchAppends(GlDevice& device, const ResolvedCall& call);

}  // namespace sk
