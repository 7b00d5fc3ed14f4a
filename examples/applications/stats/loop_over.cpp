// SPDX-License-Identifier: MIT
//
// A column's statistics by double loops, and the comparison.
#include <cmath>
#include <limits>

#include "column_statistics.hpp"

namespace examples {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Mean and mean square of the deviations from `centre`, in size.
struct Spread {
  double absolute = 0.0;
  double square = 0.0;
};

Spread spreadAround(double centre, std::span<const float> values) {
  Spread spread;
  double count = 0.0;
  for (float x : values) {
    if (std::isnan(x)) continue;
    ++count;
    spread.absolute += std::abs(x - centre);
    spread.square += (x - centre) * (x - centre);
  }
  return {spread.absolute / count, spread.square / count};
}

}  // namespace

ColumnStatistics loopOver(std::span<const float> values) {
  ColumnStatistics s;
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float x = values[i];
    if (std::isnan(x)) {
      ++s.missing;
      continue;
    }
    if (s.count == 0 || x < s.min) s.min = x;
    if (s.count == 0 || x > s.max) {
      s.max = x;
      s.argmax = static_cast<std::int64_t>(i);
    }
    ++s.count;
    sum += x;
  }
  if (s.count == 0) return {0, s.missing, unknown, unknown, NAN, NAN, -1, 0.0};
  const auto count = static_cast<double>(s.count);
  s.centre = sum / count;
  double off = 0.0, squares = 0.0;
  for (float x : values) {
    if (std::isnan(x)) continue;
    off += x - s.centre;
    squares += (x - s.centre) * (x - s.centre);
  }
  s.mean = std::isfinite(s.centre) ? s.centre + off / count : s.centre;
  s.variance = s.count < 2 ? unknown : (squares - off * off / count) / (count - 1.0);
  return s;
}

StatisticsChecks::StatisticsChecks(std::int64_t rows)
    : exact("counts, least, greatest and its place", 0.0, "no rounding takes place"),
      means("means, relative to the mean deviation", sumBound(rows) + 2 * roundoff,
            "the roundings of the sum"),
      variances("variances, relative to the mean square", sumBound(rows) + 4 * roundoff,
                "the roundings of a square and of the sum") {}

void StatisticsChecks::compare(std::span<const float> values, const ColumnStatistics& device,
                               std::int64_t column) {
  const ColumnStatistics loop = loopOver(values);
  exact.compare(column, static_cast<double>(device.count), static_cast<double>(loop.count));
  exact.compare(column, static_cast<double>(device.missing), static_cast<double>(loop.missing));
  exact.compare(column, device.min, loop.min);
  exact.compare(column, device.max, loop.max);
  exact.compare(column, static_cast<double>(device.argmax), static_cast<double>(loop.argmax));
  const Spread spread = loop.count == 0 ? Spread{} : spreadAround(device.centre, values);
  const double tiny = std::ldexp(std::abs(device.centre), -50);  // what double itself may be off
  means.compare(column, device.mean, loop.mean, spread.absolute + tiny);
  variances.compare(column, device.variance, loop.variance, spread.square + tiny * tiny);
}

}  // namespace examples
