// SPDX-License-Identifier: MIT
//
// How the elements of a domain are dealt out to threads.
#include "sk/native/run.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

using namespace sk::native;

namespace {

/// Visits the pieces of a domain in ranges of some; the elements of each chunk as numbers, row-major.
std::vector<std::int64_t> visited(const Extents& domain, bool areUneven, std::int64_t inRange, int most) {
  const Pieces pieces(domain, areUneven);
  std::vector<std::int64_t> numbers;
  for (std::int64_t begin = 0; begin < pieces.count(); begin += inRange) {
    pieces.forEachChunk({begin, std::min(begin + inRange, pieces.count())}, most,
                        [&](const Extents& at, int count) {
                          CHECK(count <= most);
                          CHECK(at[0] + count <= domain[0]);
                          const std::int64_t row = (at[3] * domain[2] + at[2]) * domain[1] + at[1];
                          for (int i = 0; i < count; ++i) numbers.push_back(row * domain[0] + at[0] + i);
                        });
  }
  return numbers;
}

}  // namespace

TEST_CASE("pieces are all elements, once and in order") {
  for (const Extents& domain :
       {Extents{1, 1, 1, 1}, Extents{100, 3, 1, 1}, Extents{20000, 2, 2, 1}, Extents{65, 1, 2, 3}}) {
    for (const bool areUneven : {false, true}) {
      for (const std::int64_t inRange : {1, 3, 1000}) {
        for (const int most : {7, 1 << 20}) {
          CAPTURE(domain[0], domain[1], areUneven, inRange, most);
          const std::vector<std::int64_t> numbers = visited(domain, areUneven, inRange, most);
          REQUIRE(numbers.size() == static_cast<std::size_t>(domain[0] * domain[1] * domain[2] * domain[3]));
          bool isInOrder = true;
          for (std::size_t i = 0; i < numbers.size(); ++i) {
            isInOrder = isInOrder && numbers[i] == static_cast<std::int64_t>(i);
          }
          CHECK(isInOrder);
        }
      }
    }
  }
}

TEST_CASE("a few thousand elements of a kernel with loops are enough for all threads") {
  CHECK(Pieces({4096, 1, 1, 1}, true).count() == 64);
  CHECK(Pieces({4096, 1, 1, 1}, false).count() == 1);
}
