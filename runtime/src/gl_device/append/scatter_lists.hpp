// SPDX-License-Identifier: MIT
//
// Carries out the list of a scatter output, by the programs of assemble/append/scatter_programs.hpp: draws its entries as
// points, or sorts its records by targets, stably, and combines those of each target one after the other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "assemble/append/scatter_programs.hpp"
#include "assemble/region_layout.hpp"
#include "gl/blending.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/memory/render_target.hpp"
#include "gl_device/pass/pass.hpp"
#include "gl_device/sort/word_sort.hpp"
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

/// A scatter output whose values a compute program cannot combine in order by atomic operations: sums of floats, and vectors. The
/// kernel pushes records of targets and values.
class ListedScatter {
 public:
  /// Makes room for `length` records. `count` is a texture of one texel whose fourth channel is their number, once the kernel has
  /// run; null if there are `length`. Throws sk::Error if memory is exhausted or the driver rejects a program.
  ListedScatter(GlDevice& device, const program::Parameter& scatter, std::int32_t length,
                RenderTarget* count);

  /// Whether a device sorts this number of records.
  static bool isPossible(const GlDevice& device, std::int64_t length) {
    return WordSort::isPossible(device, WordSort::Of::Pairs, length);
  }

  /// The planes that the kernel stores records to.
  std::vector<RenderTarget*> planes();
  /// Combines the elements of the stream with the records.
  void combine(GlStream& stream);

 private:
  void fill(WordTexture& words);

  GlDevice& device_;
  const program::Parameter& scatter_;
  const std::int32_t length_;
  RenderTarget* const count_;
  WordSort sort_;
  PlanesLease values_;  ///< unless pairs hold them
  std::int32_t shift_ = 0;  ///< of its layout
};

}  // namespace sk
