// SPDX-License-Identifier: MIT
//
// Compares the results of a case with what they have to be.
#pragma once

#include <string>
#include <vector>

#include "numbers/bounds.hpp"
#include "numbers/case.hpp"

namespace fuzz::numbers {

/// What is wrong with the results of a case on a device, or "". There is a list for each output, or for each result of a
/// reduce to values.
std::string mistakeOf(const Case& one, const std::vector<Values>& results, const Arithmetic& arithmetic);

/// The inputs as the device stores them.
std::vector<Values> storedInputs(const Case& one, const Arithmetic& arithmetic);

/// The elements that are folded together, in order: those of each block of a reduce, of each line of a scan, or of each row.
std::vector<std::vector<std::size_t>> groupsOf(const Case& one);

}  // namespace fuzz::numbers
