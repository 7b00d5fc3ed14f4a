// SPDX-License-Identifier: MIT
#include "device/function_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <fmt/format.h>

#include "assemble/glsl/tables.hpp"
#include "call/resolved_call.hpp"
#include "device/interpolation_error.hpp"
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

}  // namespace sk
