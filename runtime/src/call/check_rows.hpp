// SPDX-License-Identifier: MIT
//
// Checks of arguments in rows of different lengths (sk::Rows). Each throws sk::Error, which names the kernel and the
// parameter or the row.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "assemble/condition.hpp"
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

}  // namespace sk
