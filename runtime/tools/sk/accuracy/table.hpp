// SPDX-License-Identifier: MIT
//
// Formats experiments as a table for people.
#pragma once

#include <optional>
#include <string>

#include "accuracy/experiment.hpp"

namespace sk_tool {

/// Returns several lines, with column heads if `hasHeads`, and names the cheapest mode within `tolerance`.
std::string tableOf(const Experiment& experiment, bool hasHeads, std::optional<double> tolerance);

}  // namespace sk_tool
