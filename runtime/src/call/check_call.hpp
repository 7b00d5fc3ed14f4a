// SPDX-License-Identifier: MIT
//
// Everything that can be wrong with the arguments of a call, found before any of it runs. Each check
// throws sk::Error naming the kernel, the parameters and the shapes.
#pragma once

#include <optional>
#include <span>

#include "call/resolved_call.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"

namespace sk {

class DeviceState;

struct CheckedCall {
  DeviceState& device;
  ResolvedCall call;
};

/// Checks the arguments of a kernel: number, streams, device, element types, ranks, shapes, planes,
/// outputs that overlap. Returns the device of all of them and the call, without options; nothing where the call has
/// nothing to do: no element output that the spec parameters leave, and no variable or scatter output, or an empty
/// domain without the latter.
std::optional<CheckedCall> checkCall(const program::Kernel& kernel, std::span<const Argument> arguments);

}  // namespace sk
