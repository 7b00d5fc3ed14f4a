// SPDX-License-Identifier: MIT
#include "problems.hpp"

#include <algorithm>
#include <numeric>

namespace race {

Problem grid(int log2) {
  Problem p;
  p.rows = std::int64_t{1} << (log2 / 2);
  p.columns = std::int64_t{1} << (log2 - log2 / 2);
  return p;
}

std::vector<float> numbers(std::int64_t n, std::uint32_t seed, float low, float high) {
  std::vector<float> values(static_cast<std::size_t>(n));
  std::uint64_t state = seed * 0x9e3779b97f4a7c15u + 1;
  for (float& value : values) {
    // Numerical Recipes' linear congruences; the upper 24 bits are the fraction
    state = state * 6364136223846793005u + 1442695040888963407u;
    value = low + (high - low) * (static_cast<float>(state >> 40) * 0x1p-24f);
  }
  return values;
}

Problem fieldProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(p.size(), 1)};
  return p;
}

std::vector<std::int64_t> somePlaces(std::int64_t n, std::int64_t most) {
  if (n <= most) {
    std::vector<std::int64_t> all(static_cast<std::size_t>(n));
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  std::vector<std::int64_t> some;
  for (std::int64_t i = 0; i < most; ++i) {
    // an even spread; multiples of n / most alone would all be in few columns of a grid
    some.push_back(std::min(i * (n / most) + i % (n / most), n - 1));
  }
  some.back() = n - 1;
  return some;
}

}  // namespace race
