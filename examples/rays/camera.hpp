// SPDX-License-Identifier: MIT
//
// The camera as vectors, and the rays through the centres of pixels.
#pragma once

#include <vector>

#include "model.hpp"

namespace rays {

/// A pixel (x, y) of w x h looks along corner + (x + 0.5) / w * across + (y + 0.5) / h * down, of length 1 along the axis.
struct View {
  Vector origin, corner, across, down;
};

/// Throws std::runtime_error where the camera looks nowhere or along its own `up`.
View viewOf(const Camera& camera, int width, int height);

/// Row by row from the top left, through the centres of pixels. The camera's lens does not count.
std::vector<Ray> primaryRays(const Camera& camera, int width, int height);

}  // namespace rays
