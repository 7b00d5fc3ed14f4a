// SPDX-License-Identifier: MIT
//
// The chain of kernels from a picture to its edges, with the streams between them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <sk/sk.hpp>

#include "support/image.hpp"

namespace examples {

/// Linking keeps ridges of at least `high`, and those of at least `low` that touch a kept one.
struct Thresholds {
  float low;
  float high;
};

/// One side of a Gaussian, from its centre outwards; both sides sum to 1.
std::vector<float> gaussianWeights(double sigma);

class Detector {
 public:
  /// `linear` is the light of each code of the picture.
  Detector(sk::Device& device, const Picture& picture, std::span<const float> linear,
           std::span<const float> weights, std::optional<Thresholds> thresholds);

  /// Runs the chain. Nothing is waited for, except where linking asks whether it is done.
  void detect();
  /// The edges in colour: `wheel` has the inks by direction of the slope.
  std::vector<sk::float3> paint(sk::Device& device, sk::float3 paper, std::span<const sk::float3> wheel);

  std::vector<float> steepness() const { return steepness_.read(); }
  std::vector<float> ridges() const { return ridge_.read(); }
  /// Marks before and after linking; empty without thresholds.
  const std::vector<std::int32_t>& classified() const { return classified_; }
  std::vector<std::int32_t> linked() const { return mark_.read(); }

 private:
  void linkEdges();
  /// Sure edges get all the ink; without thresholds those that are a third of the steepest.
  float inkPerSlope() const;

  std::optional<Thresholds> thresholds_;
  std::int32_t radius_;
  sk::Stream<sk::int3> pixels_;
  sk::Stream<float> linear_;
  sk::Stream<float> weights_;
  sk::Stream<float> grey_;
  sk::Stream<float> halfBlurred_;
  sk::Stream<float> blurred_;
  sk::Stream<sk::float2> slope_;
  sk::Stream<float> steepness_;
  sk::Stream<float> ridge_;
  sk::Stream<std::int32_t> mark_;
  sk::Stream<float> edge_;
  std::vector<std::int32_t> classified_;
};

}  // namespace examples
