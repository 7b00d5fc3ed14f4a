// SPDX-License-Identifier: MIT
//
// Everything that can be wrong with the arguments of a reduction, found before any of it runs. Each check
// throws sk::Error naming the reduce, the parameters and the shapes.
#pragma once

#include <span>

#include "assemble/condition.hpp"
#include "call/resolved_reduction.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"

namespace sk {

/// Planes that a kernel of a reduction reads; an input of what combines has those of an accumulator.
std::size_t planesRead(const program::Kernel& kernel, const assemble::SpecValues& specs);

/// Checks the arguments of a reduction: streams, devices, element types, shapes, planes, that there are identities where there
/// is no element, and, without values, that the shape of the results divides the inputs' in one way. The options are the
/// default ones.
ResolvedReduction checkReduction(const program::Reduction& reduction, std::span<const Argument> arguments,
                                 std::span<void* const> values);

}  // namespace sk
