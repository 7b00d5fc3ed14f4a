// SPDX-License-Identifier: MIT
//
// The sums by which an entry of an append output's list finds the element that it comes from: a tree over the counts
// of all elements, in row-major order, each of whose nodes holds the sums of its first one, two, three and four
// children. Going down from the root takes one fetch a level. (Horn 2005 searches a scanned stream by halves;
// trees of sums: Ziegler, Tevs, Theobalt, Seidel 2006, "On-the-fly Point Clouds through Histogram Pyramids".)
//
// Level 1 has a node for four counts, level l + 1 one for four nodes of level l, and the last one node. Odd
// levels lie below each other in one texture, even ones in another, so that each is drawn from the other.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/region_layout.hpp"

namespace sk::assemble {

/// Counts and sums above this are this, and mean that there are too many: four of them fit an int.
inline constexpr std::int32_t countLimit = static_cast<std::int32_t>(mostPushes) + 1;

/// The most levels that a tree has, over 2^31 elements; `sk_rows` of a list's program has one more.
inline constexpr int mostPyramidLevels = 16;

struct PyramidLevel {
  std::int32_t children;  ///< nodes, or counts, that it sums
  std::int32_t row;  ///< first row of texels of its texture
  std::vector<Rect> draws;
};

struct PyramidPlan {
  std::int32_t shift = 0;  ///< log2 of the width of both textures
  TextureShape odd, even;  ///< layers in both, or in none; there may be no even one
  std::vector<PyramidLevel> levels;  ///< from level 1 on

  bool isLayered() const { return odd.layers > 0; }
};

/// The tree over `count` elements, 1 or more.
PyramidPlan planTree(std::int32_t count, const TextureLimits& limits);

/// Which textures are array textures.
struct PyramidTextures {
  bool ofCounts = false;  ///< a first level
  bool belowLayered = false;
  bool layered = false;  ///< what is drawn to
  auto operator<=>(const PyramidTextures&) const = default;
};

/// The program of a level. Uniforms, all `int` but the sampler:
///   sk_below                  the counts, or the level below
///   sk_children               how many there are of them
///   sk_below_width            of the texture of counts, for their numbers (`ofCounts`)
///   sk_below_shift            log2 of the rows of its layers     (`belowLayered`)
///   sk_below_row              first row of the level below       (otherwise)
///   sk_tree_shift sk_row      of this level
///   sk_domain_row             first row of the layer that is drawn (`layered`)
std::string treeProgram(const Profile& profile, const PyramidTextures& textures);

}  // namespace sk::assemble
