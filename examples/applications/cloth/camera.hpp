// SPDX-License-Identifier: MIT
//
// Where a picture is taken from: matrices as GL wants them, and an eye that goes round what it looks at.
#pragma once

#include <array>

#include "scene.hpp"
#include "support/vec.hpp"

namespace examples {

/// Column after column.
using Matrix = std::array<float, 16>;

Matrix product(const Matrix& a, const Matrix& b);
Matrix lookAt(Vector eye, Vector at, Vector up);
/// `fieldOfView` in degrees, from top to bottom.
Matrix perspective(double fieldOfView, double aspect, double near, double far);
/// What is within `radius` of the point straight ahead at `distance`.
Matrix orthographic(double radius, double distance);

/// An eye on a sphere around a point.
class Orbit {
 public:
  explicit Orbit(const ViewSettings& view);
  /// By radians round and up.
  void turn(double around, double up);
  /// Nearer, by a factor below 1, or farther.
  void approach(double factor);
  Vector eye() const;
  Vector at() const { return at_; }

 private:
  Vector at_;
  double distance_, around_, up_;
};

}  // namespace examples
