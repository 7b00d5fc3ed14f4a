// SPDX-License-Identifier: MIT
//
// The tree over an append output's counts and the list of what was pushed to it, as textures.
#pragma once

#include <cstdint>

#include "assemble/append/histo_pyramid.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/memory/layout.hpp"
#include "sk/program.hpp"

namespace sk {

/// Sums of the counts of one append output.
class HistoPyramid {
 public:
  /// `counts` lie as `layout` says, in the order of elements.
  HistoPyramid(GlDevice& device, RenderTarget& counts, const Layout& layout);

  const assemble::PyramidPlan& plan() const { return plan_; }
  RenderTarget& odd() { return odd_.planes.front(); }
  RenderTarget& even() { return even_.planes.empty() ? odd() : even_.planes.front(); }

  /// The number of all pushes. Waits for the device.
  std::int32_t total();
  /// The same as a texture of one texel, whose fourth channel it is.
  std::vector<RenderTarget> totalTexture();

 private:
  void draw(const assemble::PyramidLevel& level, RenderTarget& below, bool ofCounts, std::int32_t belowRow);
  RenderTarget& ofLevel(std::size_t level) { return level % 2 == 1 ? odd() : even(); }

  GlDevice& device_;
  assemble::PyramidPlan plan_;
  PlanesLease odd_, even_;
};

/// The number in a texel of totalTexture().
std::int32_t readTotal(GlDevice& device, RenderTarget& total);

}  // namespace sk
