// SPDX-License-Identifier: MIT
#include "tune/judge.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "assemble/nearest_word.hpp"

namespace sk_tool::tune {

namespace {

using sk::results::Process;
using sk::results::Series;
using sk::results::Values;

constexpr std::array<std::string_view, 5> metricNames = {"relative", "absolute", "ulp", "l2", "psnr"};
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The distance of the floats next to a number.
double ulpOf(double number) {
  constexpr int bits = std::numeric_limits<float>::digits, least = std::numeric_limits<float>::min_exponent;
  int exponent = 0;
  std::frexp(number, &exponent);
  return std::ldexp(1.0, (number == 0 ? least : std::max(exponent, least)) - bits);
}

/// The sum of squares without overflow: of doubles near the largest, too.
class Norm {
 public:
  void add(double x) {
    const double size = std::fabs(x);
    if (size > scale_) {
      sum_ = 1 + sum_ * (scale_ / size) * (scale_ / size);
      scale_ = size;
    } else if (size > 0) {
      sum_ += (size / scale_) * (size / scale_);
    }
  }
  double root() const { return scale_ * std::sqrt(sum_); }

 private:
  double scale_ = 0, sum_ = 0;
};

double quotient(double error, double size) { return error == 0 ? 0 : error / size; }

/// The limit of what errorOf() returns.
double limitOf(const Wanted& wanted) {
  return wanted.metric == Metric::Psnr ? std::pow(10, -wanted.tolerance / 20) : wanted.tolerance;
}

/// All reads that are kept, in order.
std::vector<const Values*> readsOf(const Series& series) {
  std::vector<const Values*> reads;
  for (const auto* part : {&series.first, &series.last}) {
    for (const Values& values : *part) reads.push_back(&values);
  }
  return reads;
}

bool areIntegers(const Series& series) {
  const std::vector<const Values*> reads = readsOf(series);
  return !reads.empty() && reads.front()->kind == Values::Kind::Integer;
}

std::vector<std::string> namesOf(const Process& process) {
  std::vector<std::string> names;
  for (const Series& series : process.series) names.push_back(series.name);
  return names;
}

/// Compares the last read alone where the numbers of reads differ.
double errorOfSeries(const Series& series, const Series& truth, const Wanted& wanted) {
  const std::vector<const Values*> own = readsOf(series), right = readsOf(truth);
  if (own.empty() || right.empty()) return own.empty() && right.empty() ? 0 : infinity;
  if (series.reads != truth.reads || own.size() != right.size())
    return errorOf(*own.back(), *right.back(), wanted.metric, wanted.isPicture);
  double worst = 0;
  for (std::size_t i = 0; i < own.size(); ++i)
    worst = std::max(worst, errorOf(*own[i], *right[i], wanted.metric, wanted.isPicture));
  return worst;
}

/// The numbers that a program would read if nothing but its floats were inexact.
Series roundedToFloats(const Series& series) {
  Series rounded = series;
  for (auto* const part : {&rounded.first, &rounded.last}) {
    for (Values& values : *part) {
      if (values.kind != Values::Kind::Double) continue;
      Values floats{.kind = Values::Kind::Single};
      for (std::size_t i = 0; i < values.count(); ++i) {
        const auto number = static_cast<float>(values.at(i));
        floats.bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
      }
      values = std::move(floats);
    }
  }
  return rounded;
}

bool areFloats(const Series& series) {
  return std::ranges::any_of(readsOf(series),
                             [](const Values* values) { return values->kind == Values::Kind::Single; });
}

}  // namespace

Metric metricOf(const std::string& name) {
  const auto found = std::ranges::find(metricNames, name);
  if (found == metricNames.end()) {
    throw std::runtime_error(
        fmt::format("there is no metric '{}'; choose one of {}", name, fmt::join(metricNames, ", ")));
  }
  return static_cast<Metric>(found - metricNames.begin());
}

std::string_view nameOf(Metric metric) { return metricNames[static_cast<std::size_t>(metric)]; }

Wanted parseWanted(const std::string& text, Metric metric, double tolerance) {
  Wanted wanted{.name = text, .metric = metric, .tolerance = tolerance};
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos) return wanted;
  wanted.name = text.substr(0, equals);
  const std::string rest = text.substr(equals + 1);
  const std::size_t colon = rest.find(':');
  wanted.metric = metricOf(rest.substr(0, colon));
  if (colon == std::string::npos) return wanted;
  const std::string number = rest.substr(colon + 1);
  const auto parsed = std::from_chars(number.data(), number.data() + number.size(), wanted.tolerance);
  if (parsed.ec != std::errc() || parsed.ptr != number.data() + number.size() || !(wanted.tolerance > 0) ||
      std::isinf(wanted.tolerance)) {
    throw std::runtime_error(fmt::format("'{}' is no tolerance above 0 (in --result {})", number, text));
  }
  return wanted;
}

double errorOf(const Values& values, const Values& truth, Metric metric, bool isPicture) {
  if (values.count() != truth.count()) return infinity;
  Norm difference, size;
  double worst = 0, low = infinity, high = -infinity;
  for (std::size_t i = 0; i < truth.count(); ++i) {
    const double x = values.at(i), t = truth.at(i);
    if (!std::isfinite(x) || !std::isfinite(t)) {
      if (x != t && !(std::isnan(x) && std::isnan(t))) return infinity;
      continue;
    }
    const double error = std::fabs(x - t);
    difference.add(error);
    size.add(t);
    low = std::min(low, t);
    high = std::max(high, t);
    if (metric == Metric::Relative) worst = std::max(worst, quotient(error, std::fabs(t)));
    if (metric == Metric::Absolute) worst = std::max(worst, error);
    if (metric == Metric::Ulp) worst = std::max(worst, error / ulpOf(t));
  }
  if (metric == Metric::L2) return quotient(difference.root(), size.root());
  if (metric != Metric::Psnr) return worst;
  const double mean =
      difference.root() / std::sqrt(static_cast<double>(std::max<std::size_t>(truth.count(), 1)));
  return quotient(mean, isPicture ? 1 : high - low);
}

const ResultError* Verdict::worst() const {
  const auto found = std::ranges::max_element(errors, {}, &ResultError::overTolerance);
  return found == errors.end() ? nullptr : &*found;
}

const Series* seriesNamed(const Process& process, std::string_view name) {
  const auto found = std::ranges::find(process.series, name, &Series::name);
  return found == process.series.end() ? nullptr : &*found;
}

std::vector<std::string> differences(const Process& a, const Process& b) {
  std::vector<std::string> names;
  for (const Series& series : a.series) {
    const Series* other = seriesNamed(b, series.name);
    if (other == nullptr || other->hash != series.hash || other->reads != series.reads)
      names.push_back(series.name);
  }
  for (const Series& series : b.series) {
    if (seriesNamed(a, series.name) == nullptr) names.push_back(series.name);
  }
  return names;
}

Judge::Judge(const Process& base, const Process& truth, std::vector<Wanted> wanted, Metric metric,
             double tolerance, std::span<const std::string> ignored)
    : base_(base), truth_(truth), wanted_(std::move(wanted)) {
  const std::vector<std::string> names = namesOf(base);
  const bool areAll = wanted_.empty();
  for (const Wanted& each : wanted_) {
    if (seriesNamed(base, each.name) != nullptr) continue;
    const std::string_view nearest = sk::assemble::nearestWord(each.name, names);
    throw std::runtime_error(fmt::format("the program reads no '{}'; {}", each.name,
                                         nearest.empty() ? fmt::format("it reads {}", fmt::join(names, ", "))
                                                         : fmt::format("did you mean '{}'?", nearest)));
  }
  for (const std::string& name : names) {
    if (areAll && std::ranges::find(ignored, name) == ignored.end())
      wanted_.push_back({name, metric, tolerance, false});
  }
  for (const Wanted& each : wanted_) {
    const Series* right = seriesNamed(truth, each.name);
    ofRounding_.push_back(
        right == nullptr ? 0 : errorOfSeries(roundedToFloats(*right), *right, each) / limitOf(each));
  }
}

Verdict Judge::judge(const Process& run) const {
  Verdict verdict;
  const auto decide = [&](std::string text) {
    if (verdict.decision.empty()) verdict.decision = std::move(text);
  };
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    const Wanted& wanted = wanted_[i];
    const Series* own = seriesNamed(run, wanted.name);
    const Series* base = seriesNamed(base_, wanted.name);
    const Series* truth = seriesNamed(truth_, wanted.name);
    if (own == nullptr || truth == nullptr) {
      verdict.errors.push_back({wanted.name, wanted.metric, infinity, infinity, 0});
      decide(fmt::format("'{}' is never read", wanted.name));
      continue;
    }
    if (own->reads != base->reads && own->reads != truth->reads)
      decide(fmt::format("'{}' is read {} time(s), not {}", wanted.name, own->reads, base->reads));
    if (areIntegers(*base)) {
      if (own->hash != base->hash && own->hash != truth->hash)
        decide(fmt::format("'{}', of integers, has other values", wanted.name));
      continue;
    }
    const double error = errorOfSeries(*own, *truth, wanted);
    const bool isPsnr = wanted.metric == Metric::Psnr;
    verdict.errors.push_back({wanted.name, wanted.metric, isPsnr ? -20 * std::log10(error) : error,
                              std::isnan(error) ? infinity : error / limitOf(wanted),
                              areFloats(*own) ? ofRounding_[i] : 0});
  }
  if (const ResultError* worst = verdict.worst()) verdict.score = worst->overTolerance;
  return verdict;
}

}  // namespace sk_tool::tune
