// SPDX-License-Identifier: MIT
//
// Runs kernels with variable or scatter outputs: the passes of assemble/append/append_passes.hpp, in order, and the operands
// of these passes, whether they are drawn or dispatched (append_dispatch.hpp). A DeviceScope must be open.
#pragma once

#include <vector>

#include "assemble/condition.hpp"
#include "call/resolved_call.hpp"
#include "gl_device/program/variant.hpp"
#include "sk/program.hpp"

namespace sk {

/// Whether an argument is the stream of a scatter output that the call needs.
bool isScattered(const ResolvedCall& call, std::size_t i);

/// Unpacks the streams that the call writes in part or in any order. A DeviceScope must be open.
void unpackWritten(const ResolvedCall& call);

/// One operand per argument; those of variable outputs are empty.
std::vector<Operand> appendOperands(const ResolvedCall& call);

/// If elements push at most this often, a list has room for the largest possible
/// number of entries, and the call does not wait for their number.
inline constexpr std::int32_t mostRoom = 4;
/// Whether the list of a variable output, or of records, has that room on a device whose textures have this size.
bool hasRoom(const program::Parameter& pushed, std::int64_t elements, std::int32_t textureSize);

/// Throws sk::Error: there are more pushes than sk::mostPushes.
[[noreturn]] void failForPushes(const program::Kernel& kernel, const program::Parameter& appendOutput);

class GlDevice;

/// Whether a kernel has a variable or a scatter output.
bool hasAppendOutputs(const program::Kernel& kernel);

/// Runs a kernel over its domain, which is not empty.
void runWithAppendOutputs(GlDevice& device, const ResolvedCall& call);

/// Runs such a kernel over an empty domain: its variable outputs become empty.
void runOverNothing(const ResolvedCall& call);

}  // namespace sk
