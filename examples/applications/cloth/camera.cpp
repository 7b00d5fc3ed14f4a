// SPDX-License-Identifier: MIT
#include "camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace examples {

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix r{};
  for (std::size_t column = 0; column < 4; ++column) {
    for (std::size_t row = 0; row < 4; ++row) {
      for (std::size_t k = 0; k < 4; ++k) r[column * 4 + row] += a[k * 4 + row] * b[column * 4 + k];
    }
  }
  return r;
}

Matrix lookAt(Vector eye, Vector at, Vector up) {
  const Vector back = normalized(eye - at);
  Vector right = normalized(cross(up, back));
  // Straight up or down, any direction is right.
  if (right == Vector{}) right = {1, 0, 0};
  const Vector above = cross(back, right);
  const auto f = [](double v) { return static_cast<float>(v); };
  return {
      f(right.x), f(above.x), f(back.x), 0, f(right.y),          f(above.y),          f(back.y),          0,
      f(right.z), f(above.z), f(back.z), 0, f(-dot(right, eye)), f(-dot(above, eye)), f(-dot(back, eye)), 1};
}

Matrix perspective(double fieldOfView, double aspect, double near, double far) {
  const double scale = 1.0 / std::tan(fieldOfView * std::numbers::pi / 360.0);
  Matrix m{};
  m[0] = static_cast<float>(scale / aspect);
  m[5] = static_cast<float>(scale);
  m[10] = static_cast<float>((far + near) / (near - far));
  m[11] = -1;
  m[14] = static_cast<float>(2 * far * near / (near - far));
  return m;
}

Matrix orthographic(double radius, double distance) {
  Matrix m{};
  m[0] = m[5] = static_cast<float>(1 / radius);
  m[10] = static_cast<float>(-1 / radius);
  m[14] = static_cast<float>(-distance / radius);
  m[15] = 1;
  return m;
}

Orbit::Orbit(const ViewSettings& view) : at_(view.at) {
  const Vector d = view.eye - view.at;
  distance_ = length(d);
  around_ = std::atan2(d.x, d.z);
  up_ = std::asin(std::clamp(d.y / distance_, -1.0, 1.0));
}

void Orbit::turn(double around, double up) {
  around_ += around;
  up_ = std::clamp(up_ + up, -1.5, 1.5);
}

void Orbit::approach(double factor) { distance_ = std::clamp(distance_ * factor, 1e-3, 1e5); }

Vector Orbit::eye() const {
  return at_ + distance_ * Vector{std::cos(up_) * std::sin(around_), std::sin(up_),
                                  std::cos(up_) * std::cos(around_)};
}

}  // namespace examples
