// SPDX-License-Identifier: MIT
//
// Promises: a tree has one root, its levels follow each other in their textures without overlap, and each is
// drawn whole, node for node.
#include "assemble/count_tree.hpp"

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
    const TreePlan plan = planTree(count, 16384);
    std::int32_t children = count;
    for (const TreeLevel& level : plan.levels) {
      CHECK(level.children == children);
      children = (children - 1) / 4 + 1;
      CHECK(texelsOf(level.draws) == children);
    }
    CHECK(children == 1);
    CHECK(plan.levels.size() <= mostTreeLevels);
    CHECK(plan.oddRows <= 16384);
    CHECK(1 << plan.shift <= 16384);
  }
}

TEST_CASE("levels of one texture lie below each other") {
  const TreePlan plan = planTree(100000, 64 * 16);
  for (std::size_t level = 0; level < plan.levels.size(); ++level) {
    const TreeLevel& one = plan.levels[level];
    const bool isOdd = level % 2 == 0;
    const std::int32_t end = level + 2 < plan.levels.size() ? plan.levels[level + 2].row
                             : isOdd                        ? plan.oddRows
                                                            : plan.evenRows;
    for (const Rect& rect : one.draws) {
      CHECK(rect.y >= one.row);
      CHECK(rect.y + rect.height <= end);
      CHECK(rect.x + rect.width <= 1 << plan.shift);
    }
  }
}

}  // namespace
}  // namespace sk::assemble
