// SPDX-License-Identifier: MIT
//
// Finds all errors in the arguments of a reduction before any of it runs. Each check throws sk::Error, which
// names the reduction, the parameters and the shapes.
#pragma once

#include <optional>
#include <span>

#include "assemble/condition.hpp"
#include "call/resolved_reduction.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"

namespace sk {

/// The planes that a kernel of a reduction reads. An input of `combine` has the planes of an accumulator.
std::size_t planesRead(const program::Kernel& kernel, const assemble::SpecValues& specs);

/// Checks the arguments of a reduction: streams, devices, element types, shapes, planes; that identities
/// exist if the domain is empty; and, without `values`, that the shape of the results divides the inputs'
/// shape in exactly one way. Of a scan, checks that the results have the shape of the inputs, and that identities
/// exist if it is exclusive. The options of the returned reduction are the defaults. `placed` has passed argumentsIn().
ResolvedReduction checkReduction(const program::Reduction& reduction, std::span<const Argument> arguments,
                                 std::span<void* const> values, const std::optional<ScanOrder>& scan = {},
                                 const FoldedBox& placed = {});

}  // namespace sk
