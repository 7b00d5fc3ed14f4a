// SPDX-License-Identifier: MIT
#include "device/function_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include "assemble/glsl/tables.hpp"
#include "call/resolved_call.hpp"
#include "native/native_device.hpp"
#include "native/native_stream.hpp"
#include "sk/error.hpp"
#include "sk/types.hpp"

namespace sk {

namespace {

using program::Table;

/// Samples per interval: enough for nearly exact slopes.
constexpr int parts = 8;

/// Lookups that are measured, at least.
constexpr std::size_t leastMeasured = 4096;

std::string named(const Table& table, const TableRange& range) {
  return fmt::format("the table of '{}' over [{}, {}]", table.function, range.low, range.high);
}

/// The function's values, computed in double. Throws sk::Error if one is no finite float.
std::vector<double> valuesAt(const Table& table, const TableRange& range,
                             const std::vector<double>& arguments) {
  const auto count = static_cast<std::int64_t>(arguments.size());
  NativeDevice device(RealType::Double);
  device.checkProgram(*table.values);
  const program::Element& element = ElementTraits<float>::element();
  const auto x = device.createStream(element, {count}, Storage::Single);
  const auto y = device.createStream(element, {count}, Storage::Single);
  x->writeReals(detail::wholeRegion(x.get()), arguments.data());
  const Argument list[] = {{.region = detail::wholeRegion(x.get())},
                           {.region = detail::wholeRegion(y.get())}};
  device.run(resolveCall(*table.values, list, device.limits));
  std::vector<double> values(arguments.size());
  y->readReals(detail::wholeRegion(y.get()), values.data());
  for (std::size_t j = 0; j < values.size(); ++j) {
    if (std::abs(values[j]) <= std::numeric_limits<float>::max()) continue;
    throw Error(fmt::format(
        "{}: its value at {} is {}, which nothing can be interpolated with; give it another range",
        named(table, range), arguments[j], values[j]));
  }
  return values;
}

/// The function over its range, with `parts` samples per interval.
class Samples {
 public:
  Samples(const Table& table, const TableRange& range)
      : low_(range.low), step_((double{range.high} - low_) / (double{parts} * range.intervals)) {
    std::vector<double> arguments(static_cast<std::size_t>(range.intervals) * parts + 1);
    for (std::size_t j = 0; j < arguments.size(); ++j) arguments[j] = low_ + static_cast<double>(j) * step_;
    arguments.back() = range.high;
    values_ = valuesAt(table, range, arguments);
  }

  /// The value at the lower end of an interval.
  double value(std::size_t interval) const { return values_[interval * parts]; }

  /// The slope there, per interval length: from five samples, one-sided at the ends of the range.
  double slope(std::size_t interval) const {
    const auto f = [&](std::size_t j) { return values_[j]; };
    const std::size_t j = interval * parts;
    const std::size_t last = values_.size() - 1;
    if (j == 0) return parts * (-25 * f(0) + 48 * f(1) - 36 * f(2) + 16 * f(3) - 3 * f(4)) / 12;
    if (j == last) {
      return parts * (25 * f(j) - 48 * f(j - 1) + 36 * f(j - 2) - 16 * f(j - 3) + 3 * f(j - 4)) / 12;
    }
    return parts * (f(j - 2) - 8 * f(j - 1) + 8 * f(j + 1) - f(j + 2)) / 12;
  }

 private:
  double low_, step_;
  std::vector<double> values_;
};

/// Intervals per unit of the argument. Throws sk::Error if lookups would exceed the range of floats.
float perUnit(const Table& table, const TableRange& range) {
  const double width = double{range.high} - range.low;
  const double intervals = range.intervals / width;
  using Limits = std::numeric_limits<float>;
  if (width > Limits::max() || intervals > Limits::max() || intervals < Limits::min()) {
    throw Error(
        fmt::format("{}: its {} interval(s) are too wide or too narrow for floats; give it another range",
                    named(table, range), range.intervals));
  }
  return static_cast<float>(intervals);
}

std::vector<float> coefficientsFor(const Samples& samples, std::int32_t intervals,
                                   Interpolation interpolation) {
  const bool isCubic = interpolation == Interpolation::Cubic;
  std::vector<float> coefficients;
  const auto count = static_cast<std::size_t>(intervals);
  coefficients.reserve(count * static_cast<std::size_t>(assemble::coefficientsOf(interpolation)));
  for (std::size_t i = 0; i < count; ++i) {
    const double rise = samples.value(i + 1) - samples.value(i);
    coefficients.push_back(static_cast<float>(samples.value(i)));
    if (!isCubic) {
      coefficients.push_back(static_cast<float>(rise));
      continue;
    }
    const double from = samples.slope(i);
    const double to = samples.slope(i + 1);
    for (const double c : {from, 3 * rise - 2 * from - to, from + to - 2 * rise}) {
      coefficients.push_back(static_cast<float>(c));
    }
  }
  return coefficients;
}

/// Looks up some arguments in each interval, irregularly placed.
void measure(const Table& table, FunctionTable& result) {
  constexpr double goldenRatio = 0.6180339887498949;
  const TableRange& range = result.report.range;
  const std::size_t count = std::max(static_cast<std::size_t>(range.intervals) * parts, leastMeasured);
  const double width = double{range.high} - range.low;
  std::vector<double> arguments(count);
  for (std::size_t j = 0; j < count; ++j) {
    const auto number = static_cast<double>(j);
    const double within = number * goldenRatio - std::floor(number * goldenRatio);
    const double x = range.low + width * (number + within) / static_cast<double>(count);
    arguments[j] = std::clamp(static_cast<float>(x), range.low, range.high);
  }
  const std::vector<double> right = valuesAt(table, range, arguments);
  const native::Table looked = result.native();
  for (std::size_t j = 0; j < count; ++j) {
    const auto x = static_cast<float>(arguments[j]);
    const double error = std::abs(double{looked.at(x)} - right[j]);
    if (error <= result.report.measured) continue;
    result.report.measured = error;
    result.report.worst = x;
  }
}

/// Bounds the error of all lookups.
void predict(const Table& table, FunctionTable& result) {
  const TableRange& range = result.report.range;
  const FunctionValues values = [&](const std::vector<double>& x) { return valuesAt(table, range, x); };
  const InterpolationError error = interpolationError(values, range, result.report.interpolation,
                                                      result.coefficients, result.report.measured);
  if (error.unresolved) {
    throw Error(
        fmt::format("{}: the function changes so fast between {} and {} that no bound of the table's error "
                    "is known; give it a narrower "
                    "range without that, or compute the function (Tables::Off, or [[tables(off)]] in front "
                    "of the kernel)",
                    named(table, range), error.unresolved->first, error.unresolved->second));
  }
  result.report.predicted = std::max(error.bound, result.report.measured);
}

}  // namespace

native::Table FunctionTable::native() const {
  return {coefficients.data(), report.range.low, perUnit, report.range.intervals,
          report.interpolation == Interpolation::Cubic};
}

FunctionTable buildTable(const Table& table, const TableRange& range) {
  const float scale = perUnit(table, range);
  const Samples samples(table, range);
  FunctionTable result{.report = {std::string(table.function), range, table.interpolation, 0, 0, range.low},
                       .coefficients = coefficientsFor(samples, range.intervals, table.interpolation),
                       .perUnit = scale};
  measure(table, result);
  predict(table, result);
  return result;
}

const FunctionTable& FunctionTables::of(const Table& table, const Configuration& configuration) {
  if (unloads_.hasChanged()) {
    std::erase_if(tables_,
                  [](const auto& entry) { return !program::LinkedFile::isLoaded(entry.second.object); });
  }
  Kept& kept = tables_[&table];
  if (!kept.table) {
    auto built = std::make_unique<FunctionTable>(buildTable(table, configuration.rangeOf(table)));
    built->number = ++built_;
    kept = {std::move(built), program::LinkedFile::objectOf(&table)};
  }
  return *kept.table;
}

bool FunctionTables::has(std::uint64_t number) const {
  return std::ranges::any_of(tables_, [&](const auto& entry) {
    const Kept& kept = entry.second;
    return kept.table && kept.table->number == number;
  });
}

std::vector<TableReport> FunctionTables::reports() const {
  std::vector<TableReport> reports;
  for (const auto& [table, kept] : tables_) {
    if (kept.table) reports.push_back(kept.table->report);
  }
  std::ranges::sort(reports, {}, &TableReport::function);
  return reports;
}

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
