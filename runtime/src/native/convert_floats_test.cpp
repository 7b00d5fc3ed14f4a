// SPDX-License-Identifier: MIT
//
// Promises: arrays of every length become what each number becomes by itself.
#include "native/convert_floats.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

namespace sk {
namespace {

TEST_CASE("doubles become the nearest floats, and floats become the same doubles") {
  // Numbers that rounding, range and signs treat differently.
  const std::vector<double> numbers = {0.0,
                                       -0.0,
                                       1.0,
                                       1 + 0x1p-24,
                                       1 + 0x3p-24,
                                       -0x1.fffffffp+127,
                                       1e300,
                                       0x1p-149,
                                       0x1p-150,
                                       1e-42,
                                       std::numeric_limits<double>::infinity(),
                                       0.1,
                                       -1 / 3.0};
  for (std::size_t count = 0; count <= numbers.size(); ++count) {
    std::vector<float> floats(count + 1, 7);
    narrowDoubles(numbers.data(), static_cast<std::int64_t>(count), floats.data());
    std::vector<double> doubles(count + 1, 7);
    widenFloats(floats.data(), static_cast<std::int64_t>(count), doubles.data());
    for (std::size_t i = 0; i < count; ++i) {
      const auto expected = static_cast<float>(numbers[i]);
      CHECK(std::bit_cast<std::uint32_t>(floats[i]) == std::bit_cast<std::uint32_t>(expected));
      CHECK(std::bit_cast<std::uint64_t>(doubles[i]) == std::bit_cast<std::uint64_t>(double{expected}));
    }
    CHECK(floats[count] == 7);
    CHECK(doubles[count] == 7);
  }
}

}  // namespace
}  // namespace sk
