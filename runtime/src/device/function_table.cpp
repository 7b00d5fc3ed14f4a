// SPDX-License-Identifier: MIT
#include "device/function_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
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

/// Samples per interval: enough for the function's fourth derivative and for nearly exact slopes.
constexpr int parts = 8;

constexpr double roundoff = 0x1p-24;

std::string named(const Table& table, const TableRange& range) {
  return fmt::format("the table of '{}' over [{}, {}]", table.function, range.low, range.high);
}

/// The function's values, computed in double.
std::vector<double> valuesAt(const Table& table, const std::vector<double>& arguments) {
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
    values_ = valuesAt(table, arguments);
    for (std::size_t j = 0; j < values_.size(); ++j) {
      if (std::isfinite(values_[j])) continue;
      throw Error(fmt::format(
          "{}: its value at {} is {}, which nothing can be interpolated with; give it another range",
          named(table, range), arguments[j], values_[j]));
    }
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

  double largestValue() const {
    return std::abs(*std::ranges::max_element(values_, {}, [](double v) { return std::abs(v); }));
  }
  /// The largest difference of this order (1 to 4) of neighbouring samples, as a derivative per interval
  /// length.
  double largestDerivative(int order) const {
    constexpr std::array<std::array<int, 5>, 5> weights = {
        {{1}, {-1, 1}, {1, -2, 1}, {-1, 3, -3, 1}, {1, -4, 6, -4, 1}}};
    const auto reach = static_cast<std::size_t>(order);
    double largest = 0;
    for (std::size_t j = 0; j + reach < values_.size(); ++j) {
      double difference = 0;
      for (std::size_t k = 0; k <= reach; ++k) difference += weights[reach][k] * values_[j + k];
      largest = std::max(largest, std::abs(difference));
    }
    return largest * std::pow(parts, order);
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

/// Interpolation error (h^2/8 of the second derivative, or h^4/384 of the fourth), three roundings of the
/// position in the interval, and the rounding of the polynomial.
double predictedError(const Samples& samples, const TableRange& range, bool isCubic) {
  const double truncation = isCubic ? samples.largestDerivative(4) / 384 : samples.largestDerivative(2) / 8;
  const double place = 3 * roundoff * range.intervals * samples.largestDerivative(1);
  return truncation + place + 3 * roundoff * samples.largestValue();
}

void measure(const Table& table, FunctionTable& result) {
  const TableRange& range = result.report.range;
  const std::size_t count = static_cast<std::size_t>(range.intervals) * parts;
  const double width = double{range.high} - range.low;
  std::vector<double> arguments(count);
  for (std::size_t j = 0; j < count; ++j) {
    const double x = range.low + width * (static_cast<double>(j) + 0.5) / static_cast<double>(count);
    arguments[j] = std::clamp(static_cast<float>(x), range.low, range.high);
  }
  const std::vector<double> right = valuesAt(table, arguments);
  const native::Table looked = result.native();
  for (std::size_t j = 0; j < count; ++j) {
    const auto x = static_cast<float>(arguments[j]);
    const double error = std::abs(double{looked.at(x)} - right[j]);
    if (error <= result.report.measured) continue;
    result.report.measured = error;
    result.report.worst = x;
  }
}

}  // namespace

native::Table FunctionTable::native() const {
  return {coefficients.data(), report.range.low, perUnit, report.range.intervals,
          report.interpolation == Interpolation::Cubic};
}

FunctionTable buildTable(const Table& table, const TableRange& range) {
  const float scale = perUnit(table, range);
  const Samples samples(table, range);
  const bool isCubic = table.interpolation == Interpolation::Cubic;
  FunctionTable result{.report = {std::string(table.function), range, table.interpolation,
                                  predictedError(samples, range, isCubic), 0, range.low},
                       .coefficients = coefficientsFor(samples, range.intervals, table.interpolation),
                       .perUnit = scale};
  measure(table, result);
  return result;
}

const FunctionTable& FunctionTables::of(const Table& table, const Configuration& configuration) {
  std::unique_ptr<FunctionTable>& kept = tables_[&table];
  if (!kept) kept = std::make_unique<FunctionTable>(buildTable(table, configuration.rangeOf(table)));
  return *kept;
}

std::vector<TableReport> FunctionTables::reports() const {
  std::vector<TableReport> reports;
  for (const auto& [table, built] : tables_) {
    if (built) reports.push_back(built->report);
  }
  std::ranges::sort(reports, {}, &TableReport::function);
  return reports;
}

}  // namespace sk
