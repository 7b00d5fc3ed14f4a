// SPDX-License-Identifier: MIT
//
// Promises: a pyramid has one root, its levels are stacked in their textures without overlap, and each is
// drawn completely, node by node.
#include "assemble/append/histo_pyramid.hpp"

#include <catch2/catch.hpp>

namespace sk::assemble {
namespace {

std::int64_t texelsOf(const std::vector<Rect>& rects) {
  std::int64_t sum = 0;
  for (const Rect& rect : rects) sum += std::int64_t{rect.width} * rect.height;
  return sum;
}

TEST_CASE("levels narrow to a root") {
  for (const std::int32_t count : {1, 2, 4, 5, 16, 17, 64, 65, 1009, 4096, 1 << 20, (1 << 28) - 3}) {
    INFO(count);
    const PyramidPlan plan = planPyramid(count, {16384, 256});
    std::int32_t children = count;
    for (const PyramidLevel& level : plan.levels) {
      CHECK(level.children == children);
      children = (children - 1) / 4 + 1;
      CHECK(texelsOf(level.draws) == children);
    }
    CHECK(children == 1);
    CHECK(plan.levels.size() <= mostPyramidLevels);
    CHECK(plan.odd.height <= 16384);
    CHECK(1 << plan.shift <= 16384);
  }
}

TEST_CASE("a pyramid too large for a texture has layers, in both of its textures") {
  for (const std::int32_t count : {4096 * 4, 4096 * 4 + 1, 64 * 64 * 200, 64 * 64 * 256}) {
    INFO(count);
    const PyramidPlan plan = planPyramid(count, {64, 256});
    CHECK(plan.isLayered());
    CHECK(plan.even.layers > 0);
    for (const TextureShape& texture : {plan.odd, plan.even}) {
      CHECK(texture.layers <= 256);
      CHECK(texture.width <= 64);
      CHECK(texture.height == texture.width);
      CHECK(texture.width == 1 << plan.shift);
    }
    CHECK(plan.levels.front().draws.back().y < plan.odd.height * plan.odd.layers);
  }
  CHECK_FALSE(planPyramid(64 * 64 * 2, {64, 256}).isLayered());
  CHECK(planPyramid((std::int64_t{1} << 31) - 1, {16384, 256}).levels.size() <= mostPyramidLevels);
}

TEST_CASE("levels of one texture lie below each other") {
  const PyramidPlan plan = planPyramid(100000, {64 * 16, 256});
  for (std::size_t level = 0; level < plan.levels.size(); ++level) {
    const PyramidLevel& one = plan.levels[level];
    const bool isOdd = level % 2 == 0;
    const std::int32_t end = level + 2 < plan.levels.size() ? plan.levels[level + 2].row
                             : isOdd                        ? plan.odd.height
                                                            : plan.even.height;
    for (const Rect& rect : one.draws) {
      CHECK(rect.y >= one.row);
      CHECK(rect.y + rect.height <= end);
      CHECK(rect.x + rect.width <= 1 << plan.shift);
    }
  }
}

}  // namespace
}  // namespace sk::assemble
