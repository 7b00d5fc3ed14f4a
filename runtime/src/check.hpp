// SPDX-License-Identifier: MIT
//
// Everything that can be wrong with the arguments of a call, found before any of it runs. Each check
// throws sk::Error naming the kernel, the parameters and the shapes.
#pragma once

#include <span>

#include "assemble/condition.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"

namespace sk {

class DeviceState;

/// The values of the Spec parameters among arguments that are not null.
assemble::SpecValues specsOf(const program::Kernel& kernel, std::span<const Argument> arguments);

/// Checks the arguments of a kernel: number, streams, device, element types, ranks, shapes, planes,
/// outputs that overlap. Returns the device of all of them, null
/// where the call has nothing to do: no element output that the spec parameters leave, and no variable or scatter
/// output, or an empty domain without the latter.
DeviceState* checkCall(const program::Kernel& kernel, std::span<const Argument> arguments);

/// The shape that a kernel runs over: that of its outputs, or, where it has only variable and scatter outputs,
/// of its inputs without those that repeat, and iterators that have one. The arguments have been checked, or are about to be.
Shape domainOf(const program::Kernel& kernel, std::span<const Argument> arguments,
               const assemble::SpecValues& specs);

}  // namespace sk
