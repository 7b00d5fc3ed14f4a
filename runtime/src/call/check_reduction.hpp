// SPDX-License-Identifier: MIT
//
// Finds all errors in the arguments of a reduction before any of it runs. Each check throws sk::Error, which
// names the reduction, the parameters and the shapes.
//
// Checks of arguments in rows of different lengths (sk::Rows). Each throws sk::Error, which names the kernel and the
// parameter or the row.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "assemble/condition.hpp"
#include "assemble/program/texture_units.hpp"
#include "call/resolved_call.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"

namespace sk {

/// The most tables of rows that a pass reads, each a plane.
inline constexpr std::size_t rowTables = 2;

/// The rows that all inputs of a reduction are in; null if none is.
const RowsState* rowsOf(const program::Kernel& fold, std::span<const Argument> arguments,
                        const assemble::SpecValues& specs);

/// A call of a reduction whose arguments have passed all checks that have nothing to do with rows.
struct CallInRows {
  const program::Reduction& reduction;
  std::span<const Argument> arguments;
  const DeviceState& device;
  const Shape& domain;
  const std::optional<ScanOrder>& scan;
};

/// Checks that the domain has all rows, that the results are streams with an element for each row, or, of a scan, for
/// each element; and that there are identities where a row, or an exclusive scan, needs them. Returns the shape of the
/// results.
Shape checkRows(const CallInRows& call, const RowsState& rows, const Shape& results);

/// Checks that no argument of a kernel is in rows.
void refuseRows(const program::Kernel& kernel, std::span<const Argument> arguments);

/// What the passes of a reduction read besides the inputs and gathers of `kernel`, its fold or the kernel that combines its
/// partial results, in a call whose streams that stand for uniforms have `uniforms` planes.
assemble::OtherUnits otherUnits(const program::Kernel& kernel, std::size_t uniforms, bool isScan,
                                bool hasRows);

/// Checks the arguments of a reduction: streams, devices, element types, shapes, planes; that identities
/// exist if the domain is empty; and, without `values`, that the shape of the results divides the inputs'
/// shape in exactly one way. Of a scan, checks that the results have the shape of the inputs, and that identities
/// exist if it is exclusive. The options of the returned reduction are the defaults. `placed` has passed argumentsIn().
/// `over` is that of the call's options: the domain, and the device if there is no stream.
ResolvedReduction checkReduction(const program::Reduction& reduction, std::span<const Argument> arguments,
                                 std::span<void* const> values, const std::optional<ScanOrder>& scan = {},
                                 const FoldedBox& placed = {}, const std::optional<GivenDomain>& over = {});

}  // namespace sk
