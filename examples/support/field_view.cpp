// SPDX-License-Identifier: MIT
#include "support/field_view.hpp"

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

void readFieldView(const SceneTable& table, FieldView& view) {
  constexpr Range anything{-1e30, 1e30};
  table.read("colours", view.colours);
  view.low = table.number("low", anything);
  view.high = table.number("high", anything);
  if (view.low && view.high && *view.low >= *view.high) table.refuse("high", "is not above low");
  table.read("zoom", view.zoom, Range{1, 64});
}

int zoomFor(const FieldView& view, std::int64_t width, std::int64_t height) {
  if (view.zoom > 0) return view.zoom;
  return static_cast<int>(std::clamp<std::int64_t>(1024 / std::max(width, height), 1, 64));
}

ShownValues shownValues(const FieldView& view, double least, double most, bool isSigned) {
  ShownValues v{view.low.value_or(least), view.high.value_or(most)};
  if (isSigned && !view.low && !view.high) {
    v.high = std::max(std::abs(v.low), std::abs(v.high));
    v.low = -v.high;
  }
  if (!(v.high > v.low)) v.high = v.low + std::max(1e-6, 1e-3 * std::abs(v.low));
  return v;
}

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
