// SPDX-License-Identifier: MIT
#include "camera.hpp"

#include <algorithm>
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

Camera turned(const Camera& camera, double right, double upwards) {
  const Vector up = normalized(camera.up), out = camera.from - camera.to;
  const double distance = length(out), height = std::asin(std::clamp(dot(normalized(out), up), -1.0, 1.0));
  const double steepest = std::numbers::pi / 2 - 0.01;
  const double to = std::clamp(height + upwards, -steepest, steepest);
  // Both lie in the plane perpendicular to `up`: the direction to the camera, and the direction to its right.
  const Vector flat = normalized(out - dot(out, up) * up), aside = cross(up, flat);
  const Vector around = std::cos(right) * flat + std::sin(right) * aside;
  Camera moved = camera;
  moved.from = camera.to + distance * (std::cos(to) * around + std::sin(to) * up);
  return moved;
}

Camera approached(const Camera& camera, double factor) {
  Camera moved = camera;
  moved.from = camera.to + factor * (camera.from - camera.to);
  moved.focus *= factor;
  return moved;
}

}  // namespace rays
