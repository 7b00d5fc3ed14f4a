// SPDX-License-Identifier: MIT
//
// Finds all errors in the arguments of a call before any of it runs. Each check throws sk::Error, which names
// the kernel, the parameters and the shapes.
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
/// overlapping outputs. Returns their device and the call, without options. Returns nullopt if there is
/// nothing to do: there is no variable or scatter output, and either spec parameters switch off all element
/// outputs or the domain is empty.
std::optional<CheckedCall> checkCall(const program::Kernel& kernel, std::span<const Argument> arguments);

}  // namespace sk
