// SPDX-License-Identifier: MIT
//
// A histogram pyramid, with which an entry of an append output's list finds its element: a tree over the
// counts of all elements, in row-major order, whose nodes hold the sums of their first one, two, three and
// four children. Descending from the root takes one fetch per level. (Ziegler, Tevs, Theobalt, Seidel 2006,
// "On-the-fly Point Clouds through Histogram Pyramids"; Horn 2005 uses a binary search in a scanned stream
// instead.)
//
// Level 1 has a node for four counts, level l + 1 a node for four nodes of level l, and the last level a
// single node. Odd levels are stacked in one texture and even levels in another, so that each level is drawn
// from the other texture.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/region_layout.hpp"

namespace sk::assemble {

/// Counts and sums saturate here, which means that there are too many pushes: the sum of four is still an
/// int.
inline constexpr std::int32_t countLimit = static_cast<std::int32_t>(mostPushes) + 1;

/// The most levels of a pyramid, over 2^31 elements; `sk_rows` in a list's program has one more entry.
inline constexpr int mostPyramidLevels = 16;

struct PyramidLevel {
  std::int32_t children;  ///< nodes, or counts, of the level below
  std::int32_t row;  ///< first row of texels in its texture
  std::vector<Rect> draws;
};

struct PyramidPlan {
  std::int32_t shift = 0;  ///< log2 of the width of both textures
  TextureShape odd, even;  ///< both have layers, or neither; `even` may be empty
  std::vector<PyramidLevel> levels;  ///< beginning with level 1

  bool isLayered() const { return odd.layers > 0; }
};

/// Plans the pyramid over `count` elements, at least 1.
PyramidPlan planPyramid(std::int32_t count, const TextureLimits& limits);

/// Which textures are array textures.
struct PyramidTextures {
  bool ofCounts = false;  ///< level 1, which reads the counts
  bool belowLayered = false;
  bool layered = false;  ///< the texture that is drawn to
  auto operator<=>(const PyramidTextures&) const = default;
};

/// The program of a level. All uniforms are `int`, except the sampler:
///   sk_below                  the counts, or the level below
///   sk_children               the number of children
///   sk_below_width            width of the texture of counts, for their numbers (`ofCounts`)
///   sk_below_shift            log2 of the rows of its layers     (`belowLayered`)
///   sk_below_row              first row of the level below       (otherwise)
///   sk_tree_shift sk_row      of this level
///   sk_domain_row             first row of the layer that is drawn (`layered`)
std::string pyramidProgram(const Profile& profile, const PyramidTextures& textures);

}  // namespace sk::assemble
