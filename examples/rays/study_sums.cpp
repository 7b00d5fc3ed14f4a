// SPDX-License-Identifier: MIT
//
// Sums of many samples, added one after the other, in floats, in floats with compensation and in doubles: the mean error, which is a bias.
#include "study.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include "precision.sk.hpp"
#include "support/table.hpp"

namespace rays {

Findings studySums(sk::Device& device, bool isSmall) {
  const int sums = isSmall ? 64 : 1024;
  constexpr int count = 1'000'000;
  examples::Table table({"a million samples", "floats", "compensated", "doubles"});
  examples::Verification kept("mean error of compensated sums and of doubles", 0x1p-24,
                              "half a unit of the float that holds the mean");
  const std::array<std::string_view, 3> kinds = {"0.1 each", "independent, from 0 to 1",
                                                 "one of 100,000, then from 0 to 0.01"};
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    auto plain = device.stream<float>({sums}), compensated = device.stream<float>({sums});
    auto wide = device.stream<double>({sums});
    kernels::addMany(static_cast<unsigned>(kind), count, 17u, sk::iter(0, sums), plain, compensated, wide);
    const std::vector<float> floats = plain.read(), kahan = compensated.read();
    const std::vector<double> doubles = wide.read();
    double ofFloats = 0.0, ofKahan = 0.0, ofDoubles = 0.0;
    for (std::size_t i = 0; i < doubles.size(); ++i) {
      ofFloats += (floats[i] / doubles[i] - 1) / sums;
      ofKahan += (kahan[i] / doubles[i] - 1) / sums;
      // As a picture holds it.
      ofDoubles += (static_cast<float>(doubles[i] / count) * double(count) / doubles[i] - 1) / sums;
    }
    kept.note(static_cast<std::int64_t>(kind), std::abs(ofKahan));
    kept.note(static_cast<std::int64_t>(kind), std::abs(ofDoubles));
    table.add({std::string(kinds[kind]), fmt::format("{:+.1e}", ofFloats), fmt::format("{:+.1e}", ofKahan),
               fmt::format("{:+.1e}", ofDoubles)});
  }
  return {table.markdown(), {kept}};
}

}  // namespace rays
