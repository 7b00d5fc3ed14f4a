// SPDX-License-Identifier: MIT
//
// Drawn floats, and comparisons of every bit: for tests of calls that run in two ways.
#pragma once

#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

#include "sk/sk.hpp"

namespace run_tests {

/// `count` floats between -1 and 1, the same for a seed everywhere.
inline std::vector<float> drawn(std::int64_t count, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> values(-1, 1);
  std::vector<float> x(static_cast<std::size_t>(count));
  for (float& value : x) value = values(engine);
  return x;
}

template <class T>
bool haveSameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

template <class T>
bool haveSameBits(const sk::Stream<T>& a, const sk::Stream<T>& b) {
  return haveSameBits(a.read(), b.read());
}

}  // namespace run_tests
