// SPDX-License-Identifier: MIT
//
// What a shadow report says, as tables for a terminal.
#pragma once

#include <cstddef>
#include <string>

#include "shadow/entry.hpp"

namespace sk_tool {

/// The whole report: verdicts, results, kernels by their share of the results' errors, exceptional values, decisions, account and notes.
/// Prints the first `most` rows of each table. Throws std::runtime_error if an entry is missing or has another type.
std::string shadowText(const Entry& report, std::size_t most);

/// All that the report has of one kernel, which is named in full or from a `::` on; of several with such a name, of each. Throws
/// std::runtime_error if there is none.
std::string shadowKernelText(const Entry& report, const std::string& name, std::size_t most);

}  // namespace sk_tool
