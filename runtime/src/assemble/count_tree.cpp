// SPDX-License-Identifier: MIT
#include "assemble/count_tree.hpp"

#include <algorithm>
#include <cassert>

#include <fmt/format.h>

#include "assemble/program_text.hpp"

namespace sk::assemble {

TreePlan planTree(std::int32_t count, std::int32_t textureSize) {
  assert(count > 0);
  TreePlan plan;
  plan.shift = linearShift((std::int64_t{count} + 3) / 4, textureSize);
  std::int32_t children = count;
  do {
    const bool isOdd = plan.levels.size() % 2 == 0;
    std::int32_t& height = isOdd ? plan.oddRows : plan.evenRows;
    const std::int32_t nodes = (children - 1) / 4 + 1;
    Placement placement;
    placement.linear = true;
    placement.extent = {nodes, 1, 1, 1};
    placement.stride = stridesOf(placement.extent);
    placement.shift = plan.shift;
    TreeLevel level{children, height, drawnTexels(placement)};
    for (Rect& rect : level.draws) rect.y += height;
    height += (nodes - 1) / (1 << plan.shift) + 1;
    plan.levels.push_back(std::move(level));
    children = nodes;
  } while (children > 1);
  return plan;
}

std::string treeProgram(const Profile& profile, bool ofCounts) {
  ProgramText program;
  program.uniform("isampler2D", "sk_below");
  for (const char* name : {"sk_children", "sk_tree_shift", "sk_row"}) program.uniform("int", name);
  program.uniform("int", ofCounts ? "sk_below_width" : "sk_below_row");
  program.output("ivec4", "sk_sums");
  program.function(
      "int sk_child(int sk_n)",
      {"if (sk_n >= sk_children) return 0;",
       ofCounts ? "int sk_y = sk_n / sk_below_width;" : "int sk_y = sk_n >> sk_tree_shift;",
       ofCounts
           ? "return texelFetch(sk_below, ivec2(sk_n - sk_y * sk_below_width, sk_y), 0).x;"
           : "return texelFetch(sk_below, ivec2(sk_n & ((1 << sk_tree_shift) - 1), sk_y + sk_below_row), "
             "0).w;"});
  program.function("int sk_sum(int sk_a, int sk_b)",
                   {fmt::format("return min(sk_a + sk_b, {});", countLimit)});
  for (const char* line :
       {"int sk_n = 4 * ((int(gl_FragCoord.y) - sk_row) << sk_tree_shift | int(gl_FragCoord.x));",
        "sk_sums.x = sk_sum(sk_child(sk_n), 0);", "sk_sums.y = sk_sum(sk_sums.x, sk_child(sk_n + 1));",
        "sk_sums.z = sk_sum(sk_sums.y, sk_child(sk_n + 2));",
        "sk_sums.w = sk_sum(sk_sums.z, sk_child(sk_n + 3));"}) {
    program.statement(line);
  }
  return program.finish(profile, ofCounts ? "sums of four counts" : "sums of four nodes", {});
}

}  // namespace sk::assemble
