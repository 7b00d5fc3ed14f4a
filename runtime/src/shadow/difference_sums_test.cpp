// SPDX-License-Identifier: MIT
//
// Promises: the sums are those of plain loops, up to the rounding of sums, for every count of elements; what is largest, what may
// have been flushed and what is not finite is found wherever it is.
#include "shadow/difference_sums.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

namespace sk::shadow {
namespace {

struct Arrays {
  std::vector<double> d, o, r;

  explicit Arrays(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      r.push_back(1 + 0.01 * static_cast<double>(i * 7919 % 101));
      o.push_back(r.back() + 1e-5 * std::sin(static_cast<double>(i)));
      d.push_back(static_cast<float>(o.back()));
    }
  }
  DifferenceSums sums() const {
    return addDifferences(d.data(), o.data(), r.data(), static_cast<std::int64_t>(d.size()));
  }
};

TEST_CASE("sums of differences are those of plain loops") {
  for (const std::size_t count : {0, 1, 3, 4, 7, 8, 9, 15, 16, 100, 1023, 1024}) {
    const Arrays arrays(count);
    double reference2 = 0, own2 = 0, inherited2 = 0, total2 = 0, ownInTotal = 0, largest = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double d = arrays.d[i], o = arrays.o[i], r = arrays.r[i];
      reference2 += r * r;
      own2 += (d - o) * (d - o);
      inherited2 += (o - r) * (o - r);
      total2 += (d - r) * (d - r);
      ownInTotal += (d - o) * (d - r);
      largest = std::max(largest, std::fabs(d - o));
    }
    const DifferenceSums sums = arrays.sums();
    // at most 1024 roundings of terms of one sign; the product of errors is a difference of the other sums
    const auto near = [](double value) { return Approx(value).epsilon(1024 * 0x1p-53).margin(0); };
    CHECK(sums.reference2 == near(reference2));
    CHECK(sums.own2 == near(own2));
    CHECK(sums.inherited2 == near(inherited2));
    CHECK(sums.total2 == near(total2));
    CHECK(std::fabs(sums.ownInTotal() - ownInTotal) <= 1024 * 0x1p-52 * (own2 + total2 + inherited2));
    CHECK(sums.largestOwn == largest);
    CHECK(sums.isFinite());
    CHECK_FALSE(sums.mayFlush);
  }
}

TEST_CASE("the largest difference, zeros and what is not finite are found at each place") {
  constexpr double infinity = std::numeric_limits<double>::infinity(),
                   nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t at = 0; at < 21; ++at) {
    Arrays arrays(21);
    arrays.d[at] -= 3;
    CHECK(arrays.sums().largestOwn == arrays.o[at] - arrays.d[at]);
    arrays.d[at] = 0;
    CHECK(arrays.sums().mayFlush);
    arrays.o[at] = 0;
    CHECK_FALSE(arrays.sums().mayFlush);
    for (const double value : {infinity, -infinity, nan}) {
      for (std::vector<double>* const array : {&arrays.d, &arrays.o, &arrays.r}) {
        const double before = (*array)[at];
        (*array)[at] = value;
        CHECK_FALSE(arrays.sums().isFinite());
        (*array)[at] = before;
      }
    }
    CHECK(arrays.sums().isFinite());
  }
}

}  // namespace
}  // namespace sk::shadow
