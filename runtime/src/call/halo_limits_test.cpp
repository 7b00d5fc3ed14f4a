// SPDX-License-Identifier: MIT
//
// Promises: a promised reach counts from the element of the gather in which the center of the kernel's element lies; what skc
// has found counts from the element's own index; boundary modes bring indices back inside.
#include "call/halo_limits.hpp"

#include <algorithm>
#include <vector>

#include <catch2/catch.hpp>

namespace sk {
namespace {

TEST_CASE("dimensions of a gather and of the domain belong together from the fastest on") {
  const Shape stack{3, 36, 28}, grid{18, 14};
  CHECK(gatherDimension(stack, 2, grid).domainDimension == 1);
  CHECK(gatherDimension(stack, 1, grid).domainExtent == 18);
  CHECK(gatherDimension(stack, 0, grid).domainDimension < 0);
  CHECK(gatherDimension(Shape{14}, 0, grid).domainDimension == 1);
}

TEST_CASE("a promise counts from the element in which the center lies") {
  const HaloLimits promised{1, 2, true}, found{1, 2, false};
  for (const auto& [extent, domain] :
       {std::pair<std::int64_t, std::int64_t>{36, 18}, {37, 18}, {18, 37}, {18, 18}, {1, 9}, {9, 1}}) {
    for (std::int64_t i = 0; i < domain; ++i) {
      const double center = (static_cast<double>(i) + 0.5) / static_cast<double>(domain);
      const auto at = static_cast<std::int64_t>(center * static_cast<double>(extent) + 1e-9);
      CHECK(readBy(IndexRange{i, i + 1}, promised, {extent, 0, domain}) == IndexRange{at - 1, at + 3});
      CHECK(readBy(IndexRange{i, i + 1}, found, {extent, 0, domain}) == IndexRange{i - 1, i + 3});
    }
  }
  const std::int64_t most = (std::int64_t{1} << 30) - 1;
  CHECK(readBy(IndexRange{0, most}, {0, 0, true}, {most - 1, 0, most}) == IndexRange{0, most - 1});
}

TEST_CASE("boundary modes bring a range inside as they do each of its indices") {
  constexpr std::int64_t n = 5;
  for (std::int64_t begin = -8; begin < 12; ++begin) {
    for (std::int64_t end = begin + 1; end < 13; ++end) {
      std::int64_t first = n, last = 0, firstMirrored = n, lastMirrored = 0;
      for (std::int64_t i = begin; i < end; ++i) {
        const std::int64_t clamped = std::clamp<std::int64_t>(i, 0, n - 1);
        const std::int64_t period = ((i % (2 * n)) + 2 * n) % (2 * n),
                           mirrored = std::min(period, 2 * n - 1 - period);
        first = std::min(first, clamped);
        last = std::max(last, clamped);
        firstMirrored = std::min(firstMirrored, mirrored);
        lastMirrored = std::max(lastMirrored, mirrored);
      }
      INFO(begin << " to " << end);
      CHECK(broughtInside(program::Boundary::Clamp, {begin, end}, n) == IndexRange{first, last + 1});
      CHECK(
          broughtInside(program::Boundary::Mirror, {begin, end}, n).holds({firstMirrored, lastMirrored + 1}));
    }
  }
}

}  // namespace
}  // namespace sk
