// SPDX-License-Identifier: MIT
//
// Everything that can be wrong with the arguments of a reduction, found before any of it runs. Each check
// throws sk::Error naming the reduce, the parameters and the shapes.
#pragma once

#include <span>

#include "assemble/condition.hpp"
#include "call/check_call.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"

namespace sk {

struct CheckedReduction {
  DeviceState& device;
  Shape domain;      ///< of the inputs together
  Shape blocks = {}; ///< their numbers in each dimension of the domain, for a reduction to streams
};

/// Planes that a kernel of a reduction reads; an input of what combines has those of an accumulator.
std::size_t planesRead(const program::Kernel& kernel, const assemble::SpecValues& specs);

/// Checks the arguments of a reduction to values: streams, devices, element types, shapes, planes, and that
/// there are identities where there is no element.
CheckedReduction checkReduction(const program::Reduction& reduction, std::span<const Argument> arguments);

/// The same to streams, and that their shape divides the inputs' in one way.
CheckedReduction checkReductionToStreams(const program::Reduction& reduction,
                                         std::span<const Argument> arguments);

}  // namespace sk
