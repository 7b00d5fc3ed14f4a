// SPDX-License-Identifier: MIT
//
// A scatter output whose values a compute program cannot combine in order by atomic operations: sums of floats, and
// vectors. The kernel pushes records of targets and values. These are sorted by targets, stably, and those of each target are combined
// one after the other.
#pragma once

#include <cstdint>
#include <vector>

#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/sort/word_sort.hpp"
#include "sk/program.hpp"

namespace sk {

class ListedScatter {
 public:
  /// Makes room for `length` records. `count` is a texture of one texel whose fourth channel is their number, once the kernel has
  /// run; null if there are `length`. Throws sk::Error if memory is exhausted or the driver rejects a program.
  ListedScatter(GlDevice& device, const program::Parameter& scatter, std::int32_t length,
                RenderTarget* count);

  /// Whether a device sorts this number of records.
  static bool isPossible(const GlDevice& device, std::int64_t length) {
    return WordSort::isPossible(device, length);
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
