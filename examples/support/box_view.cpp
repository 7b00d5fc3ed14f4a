// SPDX-License-Identifier: MIT
#include "support/box_view.hpp"

#include <algorithm>
#include <cmath>

namespace examples {
namespace {

using Axis = std::array<double, 3>;

sk::float3 scaled(const Axis& axis, double length) {
  return {static_cast<float>(axis[0] * length), static_cast<float>(axis[1] * length),
          static_cast<float>(axis[2] * length)};
}

}  // namespace

BoxView boxView(const std::array<std::int64_t, 3>& cells, double turn, double tilt, std::int64_t width) {
  constexpr double margin = 1.04;
  const Axis n = {static_cast<double>(cells[0]), static_cast<double>(cells[1]),
                  static_cast<double>(cells[2])};
  const Axis right = {std::cos(turn), 0.0, std::sin(turn)};
  const Axis ahead = {-std::sin(turn) * std::cos(tilt), -std::sin(tilt), std::cos(turn) * std::cos(tilt)};
  const Axis up = {-std::sin(turn) * std::sin(tilt), std::cos(tilt), std::cos(turn) * std::sin(tilt)};
  // Half of the box's extent along an axis.
  const auto reach = [&](const Axis& axis) {
    return 0.5 * margin * (n[0] * std::abs(axis[0]) + n[1] * std::abs(axis[1]) + n[2] * std::abs(axis[2]));
  };
  const double across = reach(right), along = reach(up);
  // Films take even heights.
  const auto height = static_cast<std::int64_t>(
      2 * std::lround(0.5 * static_cast<double>(width) * std::min(along / across, 2.0)));
  return {scaled({n[0] - 1, n[1] - 1, n[2] - 1}, 0.5),
          scaled(right, across),
          scaled(up, along),
          scaled(ahead, 1.0),
          width,
          height};
}

}  // namespace examples
