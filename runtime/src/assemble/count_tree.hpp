// SPDX-License-Identifier: MIT
//
// The sums by which an entry of a sink's list finds the element that it comes from: a tree over the counts
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
#include "assemble/placement.hpp"

namespace sk::assemble {

/// Counts and sums above this are this: more than any texture holds, and four of them fit an int.
inline constexpr std::int32_t countLimit = (1 << 29) - 1;

/// The most levels that a tree has, over 2^28 elements; `sk_rows` of a list's program has one more.
inline constexpr int mostTreeLevels = 15;

struct TreeLevel {
  std::int32_t children;  ///< nodes, or counts, that it sums
  std::int32_t row;  ///< first row of texels of its texture
  std::vector<Rect> draws;
};

struct TreePlan {
  std::int32_t shift = 0;  ///< log2 of the width of both textures
  std::int32_t oddRows = 0;  ///< height of each
  std::int32_t evenRows = 0;
  std::vector<TreeLevel> levels;  ///< from level 1 on
};

/// The tree over `count` elements, 1 or more.
TreePlan planTree(std::int32_t count, std::int32_t textureSize);

/// The program of a level. Uniforms, all `int` but the sampler:
///   sk_below                  the counts, or the level below
///   sk_children               how many there are of them
///   sk_below_width            of the texture of counts           (`ofCounts`)
///   sk_below_row              first row of the level below       (otherwise)
///   sk_tree_shift sk_row      of this level
std::string treeProgram(const Profile& profile, bool ofCounts);

}  // namespace sk::assemble
