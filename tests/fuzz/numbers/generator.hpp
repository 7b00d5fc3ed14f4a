// SPDX-License-Identifier: MIT
//
// Random cases: case N of a seed is always the same.
#pragma once

#include <cstdint>
#include <vector>

#include "numbers/case.hpp"

namespace fuzz::numbers {

/// A call of one of these operations, or of any if there are none.
Case generate(std::uint64_t seed, std::uint64_t number, const std::vector<std::string>& operations = {});

/// Smaller cases that might fail in the same way, the smallest first: fewer elements, fewer dimensions, simpler options and data.
std::vector<Case> simpler(const Case& one);

}  // namespace fuzz::numbers
