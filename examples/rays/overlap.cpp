// SPDX-License-Identifier: MIT
#include "overlap.hpp"

#include <algorithm>
#include <cmath>

namespace rays {

bool meets(const std::array<Corner, 3>& triangle, const Corner& centre, const Corner& half) {
  std::array<Vector, 3> v;
  for (std::size_t i = 0; i < 3; ++i)
    v[i] = {triangle[i][0] - centre[0], triangle[i][1] - centre[1], triangle[i][2] - centre[2]};
  const auto separates = [&](const Vector& axis) {
    const double reach = half[0] * std::abs(axis.x) + half[1] * std::abs(axis.y) + half[2] * std::abs(axis.z);
    const double a = dot(axis, v[0]), b = dot(axis, v[1]), c = dot(axis, v[2]);
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
  };
  constexpr std::array<Vector, 3> axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const std::array<Vector, 3> edges = {v[1] - v[0], v[2] - v[1], v[0] - v[2]};
  if (separates(cross(edges[0], edges[1]))) return false;
  for (const Vector& axis : axes) {
    if (separates(axis)) return false;
    for (const Vector& edge : edges)
      if (separates(cross(axis, edge))) return false;
  }
  return true;
}

bool meets(const Corner& middle, double radius, const Corner& centre, const Corner& half) {
  double nearest = 0, farthest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double away = std::abs(middle[i] - centre[i]);
    nearest += std::pow(std::max(0.0, away - half[i]), 2);
    farthest += std::pow(away + half[i], 2);
  }
  return nearest <= std::pow(radius * (1 + 0x1p-20), 2) && farthest >= std::pow(radius * (1 - 0x1p-20), 2);
}

}  // namespace rays
