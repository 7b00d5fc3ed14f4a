// SPDX-License-Identifier: MIT
//
// Random cases: case N of a seed is always the same.
#pragma once

#include <cstdint>
#include <vector>

#include "numbers/case.hpp"

namespace fuzz::numbers {

Case generate(std::uint64_t seed, std::uint64_t number);

/// Smaller cases that might fail in the same way, the smallest first: fewer elements, fewer dimensions, simpler options and data.
std::vector<Case> simpler(const Case& one);

}  // namespace fuzz::numbers
