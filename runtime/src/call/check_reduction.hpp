// SPDX-License-Identifier: MIT
//
// Finds all errors in the arguments of a reduction before any of it runs. Each check throws sk::Error, which
// names the reduction, the parameters and the shapes.
#pragma once

#include <optional>
#include <span>

#include "assemble/program/texture_units.hpp"
#include "call/resolved_call.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"

namespace sk {

/// What the passes of a reduction read besides the inputs and gathers of `kernel`, its fold or the kernel that combines its
/// partial results, in a call whose streams that stand for uniforms have `uniforms` planes.
assemble::OtherUnits otherUnits(const program::Kernel& kernel, std::size_t uniforms, bool isScan, bool hasRows);

/// Checks the arguments of a reduction: streams, devices, element types, shapes, planes; that identities
/// exist if the domain is empty; and, without `values`, that the shape of the results divides the inputs'
/// shape in exactly one way. Of a scan, checks that the results have the shape of the inputs, and that identities
/// exist if it is exclusive. The options of the returned reduction are the defaults. `placed` has passed argumentsIn().
ResolvedReduction checkReduction(const program::Reduction& reduction, std::span<const Argument> arguments,
                                 std::span<void* const> values, const std::optional<ScanOrder>& scan = {},
                                 const FoldedBox& placed = {});

}  // namespace sk
