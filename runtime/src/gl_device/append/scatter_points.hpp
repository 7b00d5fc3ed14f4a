// SPDX-License-Identifier: MIT
//
// Stores the list of a scatter output to its region, in the steps of assemble/append/point_program.hpp.
#pragma once

#include <span>
#include <vector>

#include "assemble/append/scatter_programs.hpp"
#include "assemble/region_layout.hpp"
#include "gl/blending.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/memory/render_target.hpp"
#include "gl_device/pass/pass.hpp"
#include "sk/program.hpp"

namespace sk {

/// Draws the entries of a list to a region of a stream, which has the layout `regionLayout` in `planes`. The
/// planes of the list hold the target texels, then the values. All arguments must outlive this object.
class Scatterer {
 public:
  /// Prepares the programs and temporaries. Throws sk::Error if the driver rejects a program or memory is
  /// exhausted.
  Scatterer(GlDevice& device, const program::Parameter& appendOutput, std::span<RenderTarget> list,
            const assemble::RegionLayout& listLayout, const assemble::RegionLayout& regionLayout,
            std::span<RenderTarget> planes);

  /// Draws all steps: changes the region.
  void run();

 private:
  void store(gl::Blend blend);
  void addIntegers();
  void extremeIntegers();
  int width() const { return appendOutput_.element->fields.front().width; }
  void takeFloats(PlanesLease& lease, int width);
  int bindAfterElements(std::span<RenderTarget> planes);
  IntegerProgram& programOf(assemble::PointStep step);
  DrawTarget target(std::span<RenderTarget> planes);
  void points(assemble::PointStep step, gl::Blend blend, std::span<RenderTarget> targets, std::int32_t first,
              std::int32_t count);
  void region(assemble::PointStep step, std::span<RenderTarget> targets);

  GlDevice& device_;
  const program::Parameter& appendOutput_;
  std::span<RenderTarget> list_;
  const assemble::RegionLayout& listLayout_;
  std::int32_t length_;
  const assemble::RegionLayout& regionLayout_;
  std::span<RenderTarget> planes_;
  std::vector<assemble::Rect> rects_;
  PlanesLease limbs_, upper_, lower_;  ///< floats in which integers are combined
};

}  // namespace sk
