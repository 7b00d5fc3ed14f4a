// SPDX-License-Identifier: MIT
//
// What it costs to read and write views that are no boxes, against the same call on streams of the view's own shape.
#pragma once

#include <string_view>

#include <sk/sk.hpp>

#include "report.hpp"

namespace bench {

/// Rows "view: CALL, on NAME", whose value is how many times as long the call takes: by the clock on a GPU, in processor
/// time elsewhere.
void viewCosts(sk::Device& device, std::string_view name, sk::Target target, int rounds,
               double sampleMilliseconds, Report& report);

}  // namespace bench
