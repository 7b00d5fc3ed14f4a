// SPDX-License-Identifier: MIT
//
// The operands of a kernel with append outputs, whether its passes are drawn or dispatched.
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

}  // namespace sk
