// SPDX-License-Identifier: MIT
//
// The field on its device: the kernels that step it, measure it and draw it.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include <sk/sk.hpp>

#include "model.hpp"

namespace examples {

/// Least and greatest of u (x) and v (y).
struct FieldBounds {
  sk::float2 low;
  sk::float2 high;
};

class Simulation {
 public:
  /// `first` is the state to start from, size * size.
  Simulation(sk::Device& device, int size, const Parameters& p, std::span<const sk::float2> first);

  /// Colours from low to high for savePicture, and the height of the relief.
  void paintWith(std::span<const sk::float3> palette, float relief);

  /// Runs `steps` steps and waits for them.
  void advance(int steps);
  /// What all steps took.
  double milliseconds() const { return milliseconds_; }

  FieldBounds bounds();
  sk::float2 sum() const;
  std::vector<sk::float2> state() const { return field_.read(); }
  void savePicture(const std::filesystem::path& file);

 private:
  sk::Device& device_;
  Parameters parameters_;
  sk::Stream<sk::float2> field_;
  sk::Stream<sk::float3> palette_;
  float relief_ = 0.0f;
  double milliseconds_ = 0.0;
};

}  // namespace examples
