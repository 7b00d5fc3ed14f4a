// SPDX-License-Identifier: MIT
//
// Which programs and passes reductions are planned to take.
#include "assemble/reduce_plan.hpp"

#include <utility>
#include <vector>

#include <catch2/catch.hpp>

using namespace sk::assemble;

namespace {

constexpr std::int32_t mostLayers = 256;

}  // namespace

TEST_CASE("a linearised stream is seen with as few axes as it allows") {
  const auto walk = [](const Index4& extent, const Index4& blocks) {
    Placement input{.linear = true, .extent = extent, .stride = stridesOf(extent), .shift = 4};
    Placement result{.linear = true, .extent = blocks, .stride = stridesOf(blocks), .shift = 4};
    const ReduceVariant variant = planReduction(input, result, {{1024, mostLayers}}).front().variant;
    return std::pair(variant.walk, int{variant.axes});
  };
  CHECK(walk({4, 5, 6, 7}, {1, 1, 1, 1}).first == Walk::Line);
  CHECK(walk({4, 5, 6, 7}, {1, 5, 6, 7}).first == Walk::Line);
  CHECK(walk({4, 5, 6, 7}, {1, 1, 2, 7}).first == Walk::Line);
  CHECK(walk({4, 5, 6, 7}, {4, 5, 6, 1}) == std::pair(Walk::Box, 2));
  CHECK(walk({4, 5, 6, 7}, {4, 5, 1, 1}) == std::pair(Walk::Box, 2));
  CHECK(walk({4, 6, 6, 7}, {2, 3, 2, 1}) == std::pair(Walk::Box, 4));
}

TEST_CASE("a reduction to a value takes two programs and the fewest passes") {
  const Placement square{.extent = {4096, 4096, 1, 1}};
  const auto passes = planReduction(square, valuePlacement(), {{16384, 256}, 32});
  REQUIRE(passes.size() == 5);
  CHECK(passes[0].variant.walk == Walk::Rows);
  CHECK(passes[0].variant.run == 32);
  CHECK(passes[0].texture == TextureShape{128, 4096, 0});
  for (std::size_t i = 1; i < passes.size(); ++i) CHECK(passes[i].variant == passes[1].variant);
  CHECK(passes.back().draws == std::vector<Rect>{{0, 0, 1, 1}});
}

TEST_CASE("of few elements, programs know of no shape") {
  const auto program = [](std::int32_t width, std::int32_t height) {
    const Placement rows{.extent = {width, height, 1, 1}};
    return planReduction(rows, valuePlacement(), {{16384, 256}, 32}).front().variant;
  };
  for (std::int32_t width = 2; width < 100; ++width) CHECK(program(width, width + 1) == program(2, 3));
  CHECK(program(1024, 1024).run == 32);
  CHECK(program(1001, 1001).run == 0);
}
