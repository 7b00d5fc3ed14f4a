// SPDX-License-Identifier: MIT
//
// The tree over a sink's counts and the list of what was pushed to it, as textures.
#pragma once

#include <cstdint>

#include "assemble/count_tree.hpp"
#include "gl_device.hpp"
#include "layout.hpp"
#include "sk/program.hpp"

namespace sk {

/// Sums of the counts of one sink.
class CountTree {
 public:
  /// `counts` lie as `layout` says, in the order of elements.
  CountTree(GlDevice& device, Surface& counts, const Layout& layout);

  const assemble::TreePlan& plan() const { return plan_; }
  Surface& odd() { return odd_.planes.front(); }
  Surface& even() { return even_.planes.empty() ? odd() : even_.planes.front(); }

  /// The number of all pushes. Waits for the device.
  std::int32_t total();
  /// The same as a texture of one texel, whose fourth channel it is.
  std::vector<Surface> totalTexture();

 private:
  void draw(const assemble::TreeLevel& level, Surface& below, bool ofCounts, std::int32_t belowRow);
  Surface& ofLevel(std::size_t level) { return level % 2 == 1 ? odd() : even(); }

  GlDevice& device_;
  assemble::TreePlan plan_;
  PlanesLease odd_, even_;
};

/// The number in a texel of totalTexture().
std::int32_t readTotal(GlDevice& device, Surface& total);

}  // namespace sk
