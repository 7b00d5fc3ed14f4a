// SPDX-License-Identifier: MIT
//
// Folds in one dispatch, as a kernel computes its elements: each is read once, its outputs are stored, and what it contributes
// to the accumulators is folded by the work groups (assemble/reduce/group_fold.hpp). For kernels with folded outputs, and for
// reductions that read more than the elements of inputs.
#pragma once

#include <span>

#include "call/resolved_call.hpp"
#include "gl_device/gl_device.hpp"

namespace sk {

/// Whether foldInGroups() can fold a reduction without outputs, and is the faster way.
bool gathersInGroups(GlDevice& device, const ResolvedReduction& call);

/// Writes the outputs and the accumulators, which are streams, of a call for which GlDevice::foldsBesideOutputs() or
/// gathersInGroups() is true, or of the compensated variant of such a call. A DeviceScope must be open, and compute programs
/// selected.
void foldInGroups(GlDevice& device, const ResolvedReduction& call);
/// The same, of a reduction to values, which `values` gets: one texel of each plane of its accumulators.
void foldInGroups(GlDevice& device, const ResolvedReduction& call, std::span<RenderTarget> values);

}  // namespace sk
