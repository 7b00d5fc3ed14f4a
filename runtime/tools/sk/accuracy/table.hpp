// SPDX-License-Identifier: MIT
//
// Experiments as a table for people.
#pragma once

#include <optional>
#include <string>

#include "accuracy/experiment.hpp"

namespace sk_tool {

/// Several lines, with the heads of its columns where `hasHeads`; says which mode is the cheapest within `tolerance`.
std::string tableOf(const Experiment& experiment, bool hasHeads, std::optional<double> tolerance);

}  // namespace sk_tool
