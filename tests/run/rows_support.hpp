// SPDX-License-Identifier: MIT
//
// Rows of random lengths and their elements, for tests.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "sk/sk.hpp"
#include "support/streams.hpp"

namespace run_tests {

using Starts = std::vector<std::int32_t>;

inline Starts startsOf(const std::vector<int>& lengths) {
  Starts starts = {0};
  for (const int length : lengths) starts.push_back(starts.back() + length);
  return starts;
}
inline std::size_t rowsIn(const Starts& starts) { return starts.size() - 1; }
inline std::size_t sizeOf(const Starts& starts) { return static_cast<std::size_t>(starts.back()); }

inline std::vector<int> randomLengths(std::size_t count, unsigned most, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::vector<int> lengths(count);
  for (int& length : lengths) length = static_cast<int>(random() % (most + 1));
  return lengths;
}

inline std::vector<int> numbers(std::size_t count, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::vector<int> x(count);
  for (int& v : x) v = static_cast<int>(random() % 19) - 9;
  return x;
}

}  // namespace run_tests
