// SPDX-License-Identifier: MIT
#include "sk/shape.hpp"

#include <cstdint>
#include <limits>

#include <catch2/catch.hpp>

#include "sk/error.hpp"

using sk::Index;
using sk::Shape;

TEST_CASE("shapes are made of any integers, rows first") {
  constexpr Shape shape(2, std::size_t{3}, 4L);
  STATIC_REQUIRE(shape.rank() == 3);
  STATIC_REQUIRE(shape[0] == 2);
  STATIC_REQUIRE(shape.size() == 24);
  STATIC_REQUIRE(shape == Shape{2, 3, 4});
  STATIC_REQUIRE(shape != Shape{2, 12});
  CHECK(toString(shape) == "{2, 3, 4}");
  CHECK(toString(Shape()) == "{}");
  CHECK(toString(Index(-1, 5)) == "{-1, 5}");
  CHECK(shape.with(1, 7) == Shape(2, 7, 4));
}

TEST_CASE("sizes of nothing") {
  CHECK(Shape().size() == 0);
  CHECK(Shape(0).size() == 0);
  CHECK(Shape(5, 0, 7).size() == 0);
  CHECK(Shape(1, 1, 1, 1).size() == 1);
}

TEST_CASE("shapes that are none") {
  CHECK_THROWS_WITH(Shape(-3), "{-3} is not a shape: an extent is negative");
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  CHECK(Shape(most).size() == most);
  CHECK_THROWS_AS(Shape(most, 2), sk::Error);
  CHECK_THROWS_AS(Shape(0, most, 2), sk::Error);
  CHECK_THROWS_WITH(Shape(std::numeric_limits<std::uint64_t>::max()),
                    "an extent or position does not fit in 63 bits");
}
