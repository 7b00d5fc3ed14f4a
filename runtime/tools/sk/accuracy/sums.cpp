// SPDX-License-Identifier: MIT
//
// Reductions that add: the time of each Accumulate and its distance from the exact sum. Errors are also
// reported in units of u S, where S is the sum of magnitudes and u = 2^-24: rounding each summand once would
// give an error of 1.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include <fmt/format.h>

#include "accuracy/accuracy.sk.hpp"
#include "accuracy/experiment.hpp"
#include "accuracy/programs.hpp"
#include "accuracy/sum_data.hpp"
#include "info/numbers.hpp"
#include "sk/sum_bounds.hpp"

namespace sk_tool {

namespace {

using sk::Accumulate;

constexpr double u = 0x1p-24;

/// An exact sum, and the quantities that errors of computed sums are relative to.
struct Truth {
  ExactSum sum;
  double magnitude = 0;

  void add(double x) {
    sum.add(x);
    magnitude += std::fabs(x);
  }
  double condition() const { return magnitude / std::fabs(sum.value()); }
};

/// One per result, in the order of the reduction.
using Truths = std::vector<Truth>;

struct SumMode {
  const char* name;
  sk::CallOptions options;
  bool isBounded = true;
};

constexpr SumMode sumModes[] = {
    {"tree", {.accumulate = Accumulate::Tree}},
    {"compensated", {.accumulate = Accumulate::Compensated}},
    {"extended", {.accumulate = Accumulate::Extended}},
    {"double", {.precision = sk::Precision::Double}},
    {"exact", {.accumulate = Accumulate::Exact}},
    {"half", {.precision = sk::Precision::Half}, false},
};

/// Bound of the absolute error of a sum of `count` terms.
double boundOf(const SumMode& mode, const sk::Device& device, std::size_t count, double sum,
               double magnitude) {
  if (mode.options.accumulate == Accumulate::Exact) return std::max(u * sum, 0x1p-150);
  const bool isNative = device.profile() == "native";
  const double n = static_cast<double>(count);
  return sk::boundOfSum({.accumulate = mode.options.accumulate,
                         .precision = mode.options.precision,
                         .elements = n,
                         .terms = n,
                         .magnitude = magnitude,
                         .sum = sum},
                        {.isNative = isNative, .flushesDenormals = !isNative});  // a sum to a value is drawn
}

/// Of several results, the worst counts.
Grade gradeOf(const SumMode& mode, const sk::Device& device, std::size_t count, const Truths& truths,
              const std::vector<float>& results) {
  double relative = 0, scaled = 0, bound = 0;
  bool isWithin = true;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const Truth& truth = truths[i];
    const bool isNumber = std::isfinite(results[i]);
    const double error = isNumber ? truth.sum.distance(results[i]) : HUGE_VAL;
    const double itsRelative = error == 0 ? 0 : error / std::fabs(truth.sum.value());
    relative = std::max(relative, itsRelative);
    scaled = std::max(scaled, error == 0 ? 0 : error / (u * truth.magnitude));
    if (!mode.isBounded) continue;
    const double sum = std::fabs(truth.sum.value());
    const double itsBound = boundOf(mode, device, count, sum, truth.magnitude) / sum;
    bound = std::max(bound, itsBound);
    isWithin = isWithin && itsRelative <= itsBound;
  }
  Grade grade{.metrics = {{"rel err", relative}, {"scaled", scaled}}};
  if (mode.isBounded) grade.bound = bound;
  grade.isWithinBound = isWithin;
  return grade;
}

/// Calls a sum and returns its results.
using Call = std::function<std::vector<float>(const sk::CallOptions&)>;

std::vector<Row> compareSums(sk::Device& device, const Measurement& measurement, const Truths& truths,
                             const Call& call) {
  std::vector<Mode> candidates;
  for (const SumMode& mode : sumModes) {
    candidates.push_back({mode.name, [&] {
                            auto results = std::make_shared<std::vector<float>>();
                            return Trial{[&mode, &call, results] { *results = call(mode.options); },
                                         [&mode, &truths, &measurement, &device, results] {
                                           return gradeOf(mode, device, measurement.size, truths, *results);
                                         }};
                          }});
  }
  return compareModes(device, candidates, measurement.rounds);
}

/// Runs one experiment for each requested kind of data; `measure` also computes the truths.
std::vector<Experiment> onAllData(const Measurement& measurement, const char* program, bool hasFactors,
                                  const std::function<std::vector<Row>(const Pairs&, Truths&)>& measure) {
  std::vector<Experiment> experiments;
  for (const SumDataName& kind : sumDataNames) {
    if (measurement.data.value_or(kind.data) != kind.data) continue;
    Truths truths;
    Experiment experiment{.program = program, .data = std::string(kind.name), .bounded = "rel err"};
    experiment.rows = measure(drawPairs(kind.data, measurement.size, hasFactors, inputSeed), truths);
    double condition = 0;
    for (const Truth& truth : truths) condition = std::max(condition, truth.condition());
    experiment.about =
        fmt::format("{} numbers {}; condition {:.2g}", measurement.size, kind.about, condition);
    experiments.push_back(std::move(experiment));
  }
  return experiments;
}

sk::Stream<float> upload(sk::Device& device, const std::vector<float>& numbers) {
  auto stream = device.stream<float>({static_cast<std::int64_t>(numbers.size())});
  stream.write(numbers);
  return stream;
}

}  // namespace

std::vector<Experiment> measureSum(sk::Device& device, const Measurement& measurement) {
  return onAllData(measurement, "sum", false, [&](const Pairs& pairs, Truths& truths) {
    truths.resize(1);
    for (const float x : pairs.x) truths[0].add(x);
    const auto x = upload(device, pairs.x);
    return compareSums(device, measurement, truths, [&](const sk::CallOptions& options) {
      return std::vector<float>{accuracy::sum.with(options)(x)};
    });
  });
}

std::vector<Experiment> measureDot(sk::Device& device, const Measurement& measurement) {
  return onAllData(measurement, "dot", true, [&](const Pairs& pairs, Truths& truths) {
    truths.resize(1);
    for (std::size_t i = 0; i < pairs.x.size(); ++i) truths[0].add(double{pairs.x[i]} * pairs.y[i]);
    const auto x = upload(device, pairs.x);
    const auto y = upload(device, pairs.y);
    return compareSums(device, measurement, truths, [&](const sk::CallOptions& options) {
      return std::vector<float>{accuracy::dot.with(options)(x, y)};
    });
  });
}

std::vector<Experiment> measureMoments(sk::Device& device, const Measurement& measurement) {
  return onAllData(measurement, "moments", false, [&](const Pairs& pairs, Truths& truths) {
    truths.resize(2);
    for (const float x : pairs.x) {
      truths[0].add(x);
      truths[1].add(double{x} * x);
    }
    const auto x = upload(device, pairs.x);
    return compareSums(device, measurement, truths, [&](const sk::CallOptions& options) {
      const auto [first, second] = accuracy::moments.with(options)(x);
      return std::vector<float>{first, second};
    });
  });
}

}  // namespace sk_tool
