// SPDX-License-Identifier: MIT
//
// What a picture has gathered: sums of samples, how many there are in each pixel, and which pixels still want some.
#pragma once

#include <cstdint>
#include <vector>

#include <sk/sk.hpp>

#include "engine.hpp"
#include "support/grid_stream.hpp"

namespace rays {

/// When a pixel is good enough: half the 95 % interval of each component is at most `error` of the largest component, or of `least` where the
/// pixel is darker than that. The same must hold for its neighbours.
struct Tolerance {
  double error = 0.0;
  double least = 0.0;  ///< radiance
};

/// The state from which a picture can be resumed, pixel by pixel in row-major order. `counts` and `active` are empty until a pixel has stopped.
struct Gathered {
  std::int64_t passes = 0;
  std::vector<sk::double3> sums, squares;
  std::vector<int> counts, active;

  friend bool operator==(const Gathered&, const Gathered&) = default;
};

/// If the picture's pixels are divided over ranks, all ranks make the same calls, and the first one gets the pixels that functions
/// return. None stops then.
class Exposure {
  examples::Space space_;

 public:
  Exposure(sk::Device& device, const Picture& picture);

  /// One sample of each pixel, which kernels write before `add`; the elements of stopped pixels are ignored.
  examples::GridStream<sk::float3> radiance;
  const examples::Space& space() const { return space_; }

  /// True if some pixels have stopped. Kernels then sample only the `activePixels()` pixels listed in `pixels()` (x, y), in row-major order.
  bool isSparse() const { return bool(active_); }
  const sk::Stream<sk::int2>& pixels() const { return pixels_; }
  std::int64_t activePixels() const { return isSparse() ? pixels_.size() : space_.shape().size(); }
  /// Kernels write one sample for each of `pixels()` here, and `deliver` scatters them to `radiance`.
  sk::Stream<sk::float3>& list() { return list_; }
  void deliver();

  void add();
  /// Stops pixels that are good enough, and returns how many are not. Needs two samples at least.
  std::int64_t narrow(const Tolerance& tolerance);
  /// Discards all samples.
  void clear();

  std::int64_t passes() const { return passes_; }
  /// The mean of each pixel. Waits for the device, as all that follow.
  std::vector<sk::float3> image();
  /// The variance of image(), if the samples count as independent; empty before there are two.
  std::vector<sk::float3> variance();
  std::vector<int> counts();
  Gathered gathered();
  /// Throws std::logic_error where the sizes are not the picture's.
  void restore(const Gathered& gathered);

 private:
  /// The number of samples of each pixel; one element if it is the same for all pixels.
  const sk::Stream<int>& countStream();
  void listPixels();

  std::int64_t passes_ = 0;
  examples::GridStream<sk::double3> sum_, squares_;
  examples::GridStream<sk::float3> mean_;
  sk::Stream<sk::float3> list_;
  sk::Stream<int> passCount_, counts_, active_;
  sk::Stream<sk::int2> pixels_;
};

}  // namespace rays
