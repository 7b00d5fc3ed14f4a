// SPDX-License-Identifier: MIT
//
// Checks planned passes that fold the terms of exact sums: no invocation may add more to digits than these have room for
// (sk/exact_digits.hpp). The planners assert it.
#pragma once

#include <span>

#include "assemble/reduce/reduce_plan.hpp"
#include "assemble/reduce/scan_plan.hpp"

namespace sk::assemble {

/// Whether the digits have room for what the passes of a reduction fold, if each element adds one term.
bool keepsRoom(std::span<const ReducePass> passes);
/// The same for a scan.
bool keepsRoom(const ScanPlan& plan);

}  // namespace sk::assemble
