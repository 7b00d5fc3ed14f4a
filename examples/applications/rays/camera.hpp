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

/// Throws std::runtime_error if `from` equals `to`, or if the camera looks along its `up`.
View viewOf(const Camera& camera, int width, int height);

/// Row by row from the top left, through the centres of pixels. The camera's lens does not count.
std::vector<Ray> primaryRays(const Camera& camera, int width, int height);

/// The camera carried about the point that it looks at: to the right by an angle about `up`, then upwards, in radians. It stays 0.01 away from looking
/// along `up`.
Camera turned(const Camera& camera, double right, double upwards);

/// Moves the camera to another distance from its target, and the plane in focus with it.
Camera approached(const Camera& camera, double factor);

}  // namespace rays
