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
#include "accuracy/compare_modes.hpp"
#include "accuracy/exact_sum.hpp"
#include "accuracy/programs.hpp"
#include "info/numbers.hpp"

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

/// How a device adds this number of terms, as docs/accuracy.md says under "Sums".
struct Additions {
  double depth;  ///< the most additions that a number takes part in
  double lost;  ///< what they lose where numbers are flushed to 0, or rounded to a denormal
};

struct SumMode {
  const char* name;
  sk::CallOptions options;
  /// Bound of the absolute error of a sum. `magnitude`: the sum of magnitudes.
  double (*bound)(double sum, double magnitude, const Additions& additions);
};

/// Bounds of docs/accuracy.md (Higham, Accuracy and Stability of Numerical Algorithms, section 4.2; Ogita, Rump
/// and Oishi 2005 for compensated sums and dot products). Each includes the rounding of products.
constexpr SumMode sumModes[] = {
    {"tree",
     {.accumulate = Accumulate::Tree},
     [](double, double magnitude, const Additions& a) { return (a.depth + 1) * u * magnitude + a.lost; }},
    {"compensated",
     {.accumulate = Accumulate::Compensated},
     [](double sum, double magnitude, const Additions& a) {
       return u * sum + 2 * (a.depth + 1) * (a.depth + 1) * u * u * magnitude + a.lost;
     }},
    {"extended",
     {.accumulate = Accumulate::Extended},
     [](double sum, double magnitude, const Additions& a) {
       return u * sum + (a.depth + 1) * 0x1p-44 * magnitude + a.lost;
     }},
    {"double",
     {.precision = sk::Precision::Double},
     [](double sum, double magnitude, const Additions& a) {
       return u * sum + (a.depth + 1) * 0x1p-53 * magnitude + a.lost;
     }},
    {"exact",
     {.accumulate = Accumulate::Exact},
     [](double sum, double, const Additions&) { return std::max(u * sum, 0x1p-150); }},
    {"half", {.precision = sk::Precision::Half}, nullptr},
};

Additions additionsOf(const sk::Device& device, std::size_t count) {
  const double n = static_cast<double>(count), log2 = std::log2(std::max(n, 2.0));
  if (device.profile() == "native") return {24 + log2, n * 0x1p-149};
  return {31 * std::ceil(log2 / std::log2(30.0)) + 8, n * 0x1p-122};
}

/// Of several results, the worst counts.
Grade gradeOf(const SumMode& mode, const Truths& truths, const std::vector<float>& results,
              const Additions& additions) {
  double relative = 0, scaled = 0, bound = 0;
  bool isWithin = true;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const Truth& truth = truths[i];
    const bool isNumber = std::isfinite(results[i]);
    const double error = isNumber ? truth.sum.distance(results[i]) : HUGE_VAL;
    const double itsRelative = error == 0 ? 0 : error / std::fabs(truth.sum.value());
    relative = std::max(relative, itsRelative);
    scaled = std::max(scaled, error == 0 ? 0 : error / (u * truth.magnitude));
    if (mode.bound == nullptr) continue;
    const double sum = std::fabs(truth.sum.value());
    const double itsBound = mode.bound(sum, truth.magnitude, additions) / sum;
    bound = std::max(bound, itsBound);
    isWithin = isWithin && itsRelative <= itsBound;
  }
  Grade grade{.metrics = {{"rel err", relative}, {"scaled", scaled}}};
  if (mode.bound != nullptr) grade.bound = bound;
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
                                           return gradeOf(mode, truths, *results,
                                                          additionsOf(device, measurement.size));
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
