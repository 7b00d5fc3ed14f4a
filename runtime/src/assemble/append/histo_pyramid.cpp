// SPDX-License-Identifier: MIT
#include "assemble/append/histo_pyramid.hpp"

#include <algorithm>
#include <cassert>

#include <fmt/format.h>

#include "assemble/elements/planes.hpp"
#include "assemble/glsl/program_text.hpp"

namespace sk::assemble {

namespace {

/// The shape of the pyramid's textures: nearly square for the lowest nodes or, if these need layers, such
/// that all odd levels fit into the same number of layers.
TextureShape lowestNodes(std::int64_t count, const TextureLimits& limits) {
  std::optional<TextureShape> texture = linearTexture((count + 3) / 4, limits);
  if (texture && texture->layers > 0) texture = linearTexture((count + 1) / 2, limits);
  assert(texture);  // the counts have such a texture
  return *texture;
}

}  // namespace

PyramidPlan planPyramid(std::int32_t count, const TextureLimits& limits) {
  assert(count > 0);
  PyramidPlan plan;
  const TextureShape lowest = lowestNodes(count, limits);
  plan.shift = linearLayout(1, lowest).shift;
  std::int32_t children = count;
  std::int32_t oddRows = 0;
  std::int32_t evenRows = 0;
  do {
    std::int32_t& height = plan.levels.size() % 2 == 0 ? oddRows : evenRows;
    const std::int32_t nodes = (children - 1) / 4 + 1;
    PyramidLevel level{children, height, drawnTexels(linearLayout(nodes, lowest))};
    for (Rect& rect : level.draws) rect.y += height;
    height += (nodes - 1) / lowest.width + 1;
    plan.levels.push_back(std::move(level));
    children = nodes;
  } while (children > 1);
  const bool isLayered = lowest.layers > 0 || oddRows > limits.size;
  const auto shapeOf = [&](std::int32_t rows) {
    return isLayered ? TextureShape{lowest.width, lowest.width, (rows + lowest.width - 1) / lowest.width}
                     : TextureShape{lowest.width, rows, 0};
  };
  plan.odd = shapeOf(oddRows);
  if (evenRows > 0) plan.even = shapeOf(evenRows);
  return plan;
}

std::string pyramidProgram(const Profile& profile, const PyramidTextures& textures) {
  const bool ofCounts = textures.ofCounts;
  ProgramText program;
  program.uniform(samplerType("isampler2D", textures.belowLayered), "sk_below");
  for (const char* name : {"sk_children", "sk_tree_shift", "sk_row"}) program.uniform("int", name);
  program.uniform("int", ofCounts ? "sk_below_width" : "sk_below_row");
  std::string shift;
  if (textures.belowLayered) shift = ofCounts ? program.uniform("int", "sk_below_shift") : "sk_tree_shift";
  std::string row = "int(gl_FragCoord.y) - sk_row";
  if (textures.layered) row += " + " + program.uniform("int", "sk_domain_row");
  program.output("ivec4", "sk_sums");
  program.function(
      "int sk_child(int sk_n)",
      {"if (sk_n >= sk_children) return 0;",
       ofCounts ? "int sk_y = sk_n / sk_below_width;" : "int sk_y = sk_n >> sk_tree_shift;",
       ofCounts
           ? fmt::format("return min(texelFetch(sk_below, {}, 0).x, {});",
                         place(program, {"ivec2(sk_n - sk_y * sk_below_width, sk_y)", shift}), countLimit)
           : fmt::format(
                 "return texelFetch(sk_below, {}, 0).w;",
                 place(program, {"ivec2(sk_n & ((1 << sk_tree_shift) - 1), sk_y + sk_below_row)", shift}))});
  program.function("int sk_sum(int sk_a, int sk_b)",
                   {fmt::format("return min(sk_a + sk_b, {});", countLimit)});
  program.statement(fmt::format("int sk_n = 4 * (({}) << sk_tree_shift | int(gl_FragCoord.x));", row));
  for (const char* line :
       {"sk_sums.x = sk_sum(sk_child(sk_n), 0);", "sk_sums.y = sk_sum(sk_sums.x, sk_child(sk_n + 1));",
        "sk_sums.z = sk_sum(sk_sums.y, sk_child(sk_n + 2));",
        "sk_sums.w = sk_sum(sk_sums.z, sk_child(sk_n + 3));"}) {
    program.statement(line);
  }
  return program.finish(profile, ofCounts ? "sums of four counts" : "sums of four nodes", {});
}

}  // namespace sk::assemble
