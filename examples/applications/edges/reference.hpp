// SPDX-License-Identifier: MIT
//
// The same chain in plain loops of double precision, on the same inputs as the device got (the pixels, and
// tables rounded to float), and how far the device is from it. It shares no code with the kernels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "support/image.hpp"
#include "support/verification.hpp"

namespace examples {

class Reference {
 public:
  Reference(const Picture& picture, std::span<const float> linear, std::span<const float> weights);

  /// The gradient's length, whose error is bounded by the roundings on the way.
  Verification checkSteepness(std::span<const float> device) const;
  /// Thinning decides, so that a rounding may turn a ridge into none. Such a pixel is charged with the
  /// smaller of its length and of how far the comparison was from going the other way.
  Verification checkRidges(std::span<const float> device) const;

 private:
  struct Ridge {
    bool kept;
    double margin;  ///< how much the neighbours would have to change for the other decision
  };

  double at(const std::vector<double>& plane, std::int64_t x, std::int64_t y) const;
  Ridge thin(std::int64_t x, std::int64_t y) const;
  void blur(std::span<const float> weights, std::int64_t dx, std::int64_t dy,
            std::vector<double>& plane) const;
  void sobel(const std::vector<double>& plane);

  std::int64_t width_;
  std::int64_t height_;
  double bound_;
  std::vector<double> slopeX_;
  std::vector<double> slopeY_;
  std::vector<double> steepness_;
};

/// Linking is exact: marks after it must be those that following the neighbours on the host gives.
Verification checkLinks(std::int64_t width, std::int64_t height, std::vector<std::int32_t> marks,
                        std::span<const std::int32_t> device);

}  // namespace examples
