// SPDX-License-Identifier: MIT
//
// Vectors of three on the host, in any precision: for scenes, the loops that verify, and the camera.
#pragma once

#include <cmath>

#include <sk/types.hpp>

namespace examples {

template <class Real>
struct Vec {
  Real x{}, y{}, z{};

  template <class Other>
  explicit constexpr operator Vec<Other>() const {
    return {static_cast<Other>(x), static_cast<Other>(y), static_cast<Other>(z)};
  }
  friend constexpr Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec operator*(Real s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
  friend constexpr bool operator==(const Vec&, const Vec&) = default;
  constexpr Vec& operator+=(Vec b) { return *this = *this + b; }
  constexpr Vec& operator-=(Vec b) { return *this = *this - b; }
};

template <class Real>
constexpr Real dot(Vec<Real> a, Vec<Real> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
constexpr Vec<Real> cross(Vec<Real> a, Vec<Real> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Without overflow on the way.
template <class Real>
Real length(Vec<Real> a) {
  return std::hypot(a.x, a.y, a.z);
}
/// Zero stays zero.
template <class Real>
Vec<Real> normalized(Vec<Real> a) {
  const Real l = length(a);
  return l > 0 ? (1 / l) * a : a;
}

using Vector = Vec<double>;

inline sk::float3 toFloat3(Vector v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
template <class Real>
Vec<Real> vecOf(sk::float3 v) {
  return {v.x, v.y, v.z};
}

}  // namespace examples
