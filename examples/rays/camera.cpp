// SPDX-License-Identifier: MIT
#include "camera.hpp"

#include <numbers>
#include <stdexcept>

namespace rays {

View viewOf(const Camera& camera, int width, int height) {
  const Vector forward = normalized(camera.to - camera.from);
  const Vector right = normalized(cross(forward, normalized(camera.up)));
  if (!(length(forward) > 0)) throw std::runtime_error("the camera's 'from' and 'to' are one point");
  if (!(length(right) > 1e-9)) throw std::runtime_error("the camera looks along its own 'up'");
  const Vector up = cross(right, forward);
  const double tall = 2.0 * std::tan(camera.fieldOfView * std::numbers::pi / 360.0);
  const double wide = tall * width / height;
  return {camera.from, forward - 0.5 * wide * right + 0.5 * tall * up, wide * right, (-tall) * up};
}

std::vector<Ray> primaryRays(const Camera& camera, int width, int height) {
  if (width == 0 || height == 0) return {};
  const View view = viewOf(camera, width, height);
  std::vector<Ray> rays;
  rays.reserve(std::size_t(width) * std::size_t(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Vector direction =
          view.corner + ((x + 0.5) / width) * view.across + ((y + 0.5) / height) * view.down;
      rays.push_back({.origin = toFloat3(view.origin), .direction = toFloat3(normalized(direction))});
    }
  }
  return rays;
}

}  // namespace rays
