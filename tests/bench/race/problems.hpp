// SPDX-License-Identifier: MIT
//
// What the inputs and checks of programs are made of.
#pragma once

#include <cstdint>
#include <vector>

#include "contender.hpp"

namespace race {

/// 2^log2 elements as rows of equal length, as square as may be.
Problem grid(int log2);
/// n numbers in [low, high), the same each time, that repeat late.
std::vector<float> numbers(std::int64_t n, std::uint32_t seed, float low = 0, float high = 1);
/// Such a grid whose elements are numbers.
Problem fieldProblem(int log2);
/// At most `most` of the places 0 to n-1, the first and the last among them.
std::vector<std::int64_t> somePlaces(std::int64_t n, std::int64_t most = 4096);

}  // namespace race
