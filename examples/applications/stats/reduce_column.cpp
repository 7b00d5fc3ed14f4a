// SPDX-License-Identifier: MIT
//
// A column's statistics by reductions on a device.
#include <algorithm>
#include <cmath>
#include <limits>

#include <sk/sk.hpp>

#include "column_statistics.hpp"
#include "stats.sk.hpp"

namespace examples {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// A power of two that brings the greatest size to between 1/2 and 1, as far as float has it.
float scaleFor(float least, float greatest) {
  const float size = std::max(std::abs(least), std::abs(greatest));
  if (!(size > 0.0f) || !std::isfinite(size)) return 1.0f;
  return std::ldexp(1.0f, std::clamp(-std::ilogb(size) - 1, -126, 126));
}

}  // namespace

ColumnStatistics reduceColumn(sk::Device& device, std::span<const float> values) {
  const sk::Shape shape{values.size()};
  auto x = device.stream<float>(shape);
  auto extents = device.stream<stats::Extent>(shape);
  auto places = device.stream<stats::Place>(shape);
  x.write(values);

  stats::extentOf(x, extents);
  const stats::Extent extent = stats::merge(extents);
  ColumnStatistics s;
  s.count = extent.count.x;
  s.missing = extent.count.y;
  if (s.count == 0) return {0, s.missing, none, none, NAN, NAN, -1, 0.0};
  s.min = extent.range.x;
  s.max = extent.range.y;
  stats::placeOf(x, places);
  s.argmax = stats::greatest(places).index;

  const float scale = scaleFor(s.min, s.max);
  const auto count = static_cast<double>(s.count);
  auto terms = device.stream<float>(shape);
  stats::scaled(x, scale, terms);
  const auto centre = static_cast<float>(stats::sum(terms) / count);
  auto deviations = device.stream<sk::float2>(shape);
  stats::deviations(x, scale, centre, deviations);
  const sk::float2 sums = stats::sumPairs(deviations);

  const double unscale = 1.0 / scale;
  const double off = sums.x / count;
  s.centre = centre * unscale;
  s.mean = std::isfinite(centre) ? (centre + off) * unscale : s.centre;
  s.variance = s.count < 2 ? none : (sums.y - count * off * off) / (count - 1.0) * unscale * unscale;
  return s;
}

}  // namespace examples
