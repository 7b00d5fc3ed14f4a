// SPDX-License-Identifier: MIT
#include "device/interpolation_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace sk {

namespace {

constexpr double roundoff = 0x1p-24;
constexpr std::size_t leastSamples = std::size_t{1} << 16;  ///< of the whole range
constexpr std::size_t chunkSamples = std::size_t{1} << 17;  ///< that are kept at once
constexpr double slack = 1.5;  ///< a bound may exceed the largest error that was seen by this factor
/// Allowed between samples, over what a continued chord misses. Even at the cusp of a square root, twice as much would do.
constexpr double safety = 4;

/// A polynomial of an interval, in its own coordinate t from 0 to 1.
struct Piece {
  std::array<double, 4> c{};
  int degree;

  double at(double t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
  double steepest() const { return std::abs(c[1]) + 2 * std::abs(c[2]) + 3 * std::abs(c[3]); }
  /// What Horner's rule in floats loses (Higham, Accuracy and Stability of Numerical Algorithms, section 5.1), denormals
  /// flushed.
  double rounding() const {
    const double others = std::abs(c[1]) + std::abs(c[2]) + std::abs(c[3]);
    return 1.0001 * roundoff * (std::abs(c[0]) + 2 * degree * others) + 8 * 0x1p-126;
  }
};

class Pieces {
 public:
  Pieces(const TableRange& range, Interpolation interpolation, std::span<const float> coefficients)
      : range_(range),
        perUnit_(range.intervals / width()),
        degree_(interpolation == Interpolation::Cubic ? 3 : 1),
        coefficients_(coefficients) {}

  Piece piece(std::int32_t interval) const {
    Piece piece{.degree = degree_};
    const std::size_t from = static_cast<std::size_t>(interval) * static_cast<std::size_t>(degree_ + 1);
    for (std::size_t k = 0; k <= static_cast<std::size_t>(degree_); ++k) piece.c[k] = coefficients_[from + k];
    return piece;
  }
  double width() const { return double{range_.high} - range_.low; }
  double node(std::int32_t interval) const {
    return interval == range_.intervals ? range_.high : range_.low + width() * interval / range_.intervals;
  }
  double at(double x) const {
    const double place = (x - range_.low) * perUnit_;
    const auto interval = static_cast<std::int32_t>(std::clamp(place, 0.0, range_.intervals - 1.0));
    return piece(interval).at(place - interval);
  }

  /// A bound of what float arithmetic adds to the polynomials' error: the difference of the argument and the lower end, its
  /// product with the intervals per unit, and that factor are rounded, by which an argument may fall into the next interval.
  double rounding() const {
    double largest = 0;
    for (std::int32_t i = 0; i < range_.intervals; ++i) {
      const Piece here = piece(i);
      const double gap = i + 1 < range_.intervals ? std::abs(here.at(1) - piece(i + 1).c[0]) : 0;
      const double moved = 3.0001 * roundoff * (i + 1) * here.steepest();
      largest = std::max(largest, moved + gap + here.rounding());
    }
    return largest;
  }

 private:
  TableRange range_;
  double perUnit_;
  int degree_;
  std::span<const float> coefficients_;
};

/// Whether there is a float strictly between two numbers.
bool hasFloatBetween(double low, double high) {
  auto next = static_cast<float>(low);
  if (next <= low) next = std::nextafter(next, std::numeric_limits<float>::infinity());
  return next < high;
}

/// In [0, 1), without a period.
double irregular(std::uint64_t number) {
  std::uint64_t bits = (number + 1) * 0x9e3779b97f4a7c15U;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9U;
  return static_cast<double>((bits ^ (bits >> 27)) >> 11) * 0x1p-53;
}

class Search {
 public:
  Search(const FunctionValues& values, const TableRange& range, const Pieces& pieces, double seen)
      : values_(values), range_(range), pieces_(pieces), rounding_(pieces.rounding()), largest_(seen) {
    const auto intervals = static_cast<std::size_t>(range.intervals);
    perInterval_ = std::max<std::size_t>(16, leastSamples / intervals);
    left_ = 64 * leastSamples + 64 * intervals;
  }

  InterpolationError run() {
    const auto step = static_cast<std::int32_t>(std::max<std::size_t>(chunkSamples / perInterval_, 1));
    for (std::int32_t from = 0; from < range_.intervals && !unresolved_;
         from += std::min(step, range_.intervals - from))
      addChunk(from, from + std::min(step, range_.intervals - from));
    return {bound_ + rounding_, unresolved_};
  }

 private:
  struct Sample {
    double x, error;
  };

  double allowed() const { return slack * largest_ + rounding_; }

  std::vector<Sample> sampled(const std::vector<double>& arguments) {
    const std::vector<double> values = values_(arguments);
    std::vector<Sample> samples;
    samples.reserve(arguments.size());
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      samples.push_back({arguments[i], values[i] - pieces_.at(arguments[i])});
      largest_ = std::max(largest_, std::abs(samples.back().error));
    }
    left_ -= std::min(left_, arguments.size());
    return samples;
  }

  /// Intervals from `from` to below `to`.
  void addChunk(std::int32_t from, std::int32_t to) {
    std::vector<double> arguments;
    for (std::int32_t i = from; i < to; ++i) {
      const double low = pieces_.node(i), width = pieces_.node(i + 1) - low;
      arguments.push_back(low);
      for (std::size_t k = 0; k < perInterval_; ++k) {
        const double at =
            static_cast<double>(k) + 0.25 + 0.5 * irregular(static_cast<std::size_t>(i) * perInterval_ + k);
        arguments.push_back(low + width * at / static_cast<double>(perInterval_));
      }
    }
    arguments.push_back(pieces_.node(to));
    if (arguments.front() < 0 && arguments.back() > 0) {
      arguments.insert(std::ranges::lower_bound(arguments, 0.0), 0.0);
    }
    const auto doubles = std::ranges::unique(arguments);
    arguments.erase(doubles.begin(), doubles.end());
    std::vector<Sample> samples = sampled(arguments);
    while (!unresolved_ && refine(samples)) {
    }
    for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
      const double bound = boundBetween(samples, i);
      if (bound <= bound_) continue;
      bound_ =
          hasFloatBetween(samples[i].x, samples[i + 1].x) ? bound : std::max(bound_, largerEnd(samples, i));
    }
  }

  /// How far the chord of two samples on one side of samples i and i + 1 misses the far one when it is continued.
  static double missed(const std::vector<Sample>& samples, std::size_t i, bool isBelow) {
    const Sample& near = samples[isBelow ? i : i + 1];
    const Sample& far = samples[isBelow ? i + 1 : i];
    const double length = std::abs(far.x - near.x);
    std::size_t k = isBelow ? i : i + 1;
    do {
      if (k == (isBelow ? 0 : samples.size() - 1)) return 0;
      isBelow ? --k : ++k;
    } while (std::abs(samples[k].x - near.x) < length / 4);
    const double slope = (near.error - samples[k].error) / (near.x - samples[k].x);
    return std::abs(near.error + slope * (far.x - near.x) - far.error);
  }

  static double largerEnd(const std::vector<Sample>& samples, std::size_t i) {
    return std::max(std::abs(samples[i].error), std::abs(samples[i + 1].error));
  }
  /// A bound of the error between samples i and i + 1.
  static double boundBetween(const std::vector<Sample>& samples, std::size_t i) {
    return largerEnd(samples, i) + safety * std::max(missed(samples, i, true), missed(samples, i, false));
  }

  /// Adds samples where the bound is too large for the errors that were seen. Returns false if it is nowhere.
  bool refine(std::vector<Sample>& samples) {
    std::vector<double> arguments;
    const double most = allowed();
    for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
      const double low = samples[i].x, width = samples[i + 1].x - low;
      if (boundBetween(samples, i) <= most || !hasFloatBetween(low, samples[i + 1].x)) continue;
      const double x = low + width * (0.4 + 0.2 * irregular(++number_));
      if (x <= low || x >= samples[i + 1].x) continue;
      arguments.push_back(x);
      if (arguments.size() > left_) {
        unresolved_ = {low, samples[i + 1].x};
        return false;
      }
    }
    if (arguments.empty()) return false;
    const std::vector<Sample> more = sampled(arguments);
    std::vector<Sample> merged(samples.size() + more.size());
    std::ranges::merge(samples, more, merged.begin(), {}, &Sample::x, &Sample::x);
    samples = std::move(merged);
    return true;
  }

  const FunctionValues& values_;
  TableRange range_;
  const Pieces& pieces_;
  double rounding_;
  double largest_;  ///< error of a sample
  double bound_ = 0;
  std::size_t perInterval_ = 0, left_ = 0;
  std::uint64_t number_ = 0;
  std::optional<std::pair<double, double>> unresolved_ = {};
};

}  // namespace

InterpolationError interpolationError(const FunctionValues& values, const TableRange& range,
                                      Interpolation interpolation, std::span<const float> coefficients,
                                      double seen) {
  const Pieces pieces(range, interpolation, coefficients);
  return Search(values, range, pieces, seen).run();
}

}  // namespace sk
