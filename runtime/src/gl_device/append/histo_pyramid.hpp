// SPDX-License-Identifier: MIT
//
// The histogram pyramid over the counts of an append output, in textures (assemble/append/histo_pyramid.hpp).
#pragma once

#include <cstdint>

#include "assemble/append/histo_pyramid.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/memory/layout.hpp"
#include "sk/program.hpp"

namespace sk {

class HistoPyramid {
 public:
  /// Draws all levels. `counts` has the layout `layout`. Throws sk::Error if memory is exhausted or the
  /// driver rejects a program. A DeviceScope must be open.
  HistoPyramid(GlDevice& device, RenderTarget& counts, const Layout& layout);

  const assemble::PyramidPlan& plan() const { return plan_; }
  RenderTarget& odd() { return odd_.planes.front(); }
  RenderTarget& even() { return even_.planes.empty() ? odd() : even_.planes.front(); }

  /// The total number of pushes. Waits for the device.
  std::int32_t total();
  /// A texture of one texel whose fourth channel is the total number of pushes. Does not wait.
  std::vector<RenderTarget> totalTexture();

 private:
  void draw(const assemble::PyramidLevel& level, RenderTarget& below, bool ofCounts, std::int32_t belowRow);
  RenderTarget& ofLevel(std::size_t level) { return level % 2 == 1 ? odd() : even(); }

  GlDevice& device_;
  assemble::PyramidPlan plan_;
  PlanesLease odd_, even_;
};

/// Reads the number in a totalTexture(). Waits for the device. Throws sk::Error like
/// GlDevice::throwPendingError().
std::int32_t readTotal(GlDevice& device, RenderTarget& total);

}  // namespace sk
