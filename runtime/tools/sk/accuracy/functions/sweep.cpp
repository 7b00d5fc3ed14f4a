// SPDX-License-Identifier: MIT
#include "accuracy/functions/sweep.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "accuracy/programs.hpp"
#include "info/functions.sk.hpp"
#include "info/numbers.hpp"

namespace sk_tool {

namespace {

constexpr std::size_t sweepBlock = std::size_t{1} << 20;  ///< arguments of a call
constexpr std::size_t sweepPiece = 4096;  ///< arguments whose errors fit into a cache
constexpr std::size_t mostSwept = 8;  ///< worst cases

constexpr double smallestNormal = std::numeric_limits<float>::min();

bool isDenormal(double x) { return x != 0 && std::fabs(x) < smallestNormal; }

/// As errorsOf(), for an exact value that is known better.
double errorOf(float got, long double wanted) {
  if (std::isnan(got) || std::isnan(wanted)) return std::isnan(got) && std::isnan(wanted) ? 0 : HUGE_VAL;
  if (got == 0 && std::signbit(got) != std::signbit(wanted)) return HUGE_VAL;
  constexpr long double overflow = 0x1p128L;
  const long double w = std::clamp(wanted, -overflow, overflow);
  const long double g = std::clamp(static_cast<long double>(got), -overflow, overflow);
  const int exponent = w == 0 ? -126 : std::clamp(std::ilogb(w), -126, 127);
  return static_cast<double>(std::ldexp(std::fabs(g - w), 23 - exponent));
}

class Sweep {
 public:
  Sweep(const UnaryFunction& function, bool mayFlush) : function_(function), mayFlush_(mayFlush) {}

  /// Adds results for arguments, at most `sweepPiece` of them, and what they should be.
  void add(const float* x, const float* got, const double* exact, std::size_t count) {
    const ErrorSummary summary = errorsOf(got, exact, errors_.data(), count);
    found_.arguments += count;
    found_.notNearest += summary.notNearest;
    nearest_ = std::max(nearest_, std::min(summary.largest, 0.5));
    if (summary.largest <= least()) return;
    for (std::size_t i = 0; i < count; ++i) {
      if (errors_[i] > least()) look(x[i], got[i]);
    }
  }

  FunctionErrors result() const {
    FunctionErrors result = found_;
    result.largest = found_.worst.empty() ? nearest_ : found_.worst.front().error;
    return result;
  }

 private:
  /// An error has to be larger to be kept, less what double rounds it by. The nearest float is no case.
  double least() const {
    return (found_.worst.size() < mostSwept ? 0.5 : found_.worst.back().error) * (1 - 0x1p-20);
  }

  void look(float x, float got) {
    const long double wanted = function_.exactly(x);
    double error = errorOf(got, wanted);
    if (mayFlush_) {
      if (isDenormal(x)) error = std::min(error, errorOf(got, function_.exactly(std::copysign(0.0L, x))));
      if (got == 0 && isDenormal(static_cast<double>(wanted))) error = 0;
    }
    std::vector<SweptCase>& worst = found_.worst;
    if (error <= 0.5 || (worst.size() == mostSwept && error <= worst.back().error)) return;
    const auto isMirrored = [&](const SweptCase& one) { return one.x == -x && one.error == error; };
    if (std::ranges::any_of(worst, isMirrored)) return;
    const auto place = std::ranges::find_if(worst, [&](const SweptCase& one) { return one.error < error; });
    worst.insert(place, {x, got, static_cast<double>(wanted), error});
    if (worst.size() > mostSwept) worst.pop_back();
  }

  const UnaryFunction& function_;
  bool mayFlush_;
  std::array<double, sweepPiece> errors_{};
  FunctionErrors found_;
  double nearest_ = 0;  ///< the largest error that is at most 0.5
};

/// A device's function, ready to be called.
class FunctionCall {
 public:
  FunctionCall(sk::Device& device, const UnaryFunction& function)
      : function_(function),
        x_(streamOf<float>(device, std::vector<float>(sweepBlock, 1.0F))),
        y_(streamOf<float>(device, std::vector<float>(sweepBlock, 1.0F))),
        r_(device.stream<float>(x_.shape())),
        results_(sweepBlock) {}

  const std::vector<float>& of(const std::vector<float>& arguments) {
    x_.write(arguments);
    probes::function(function_.number, x_, y_, r_);
    r_.read(std::span<float>(results_));
    return results_;
  }

 private:
  const UnaryFunction& function_;
  sk::Stream<float> x_, y_, r_;
  std::vector<float> results_;
};

}  // namespace

std::vector<FunctionErrors> sweep(std::span<sk::Device> devices, const UnaryFunction& function,
                                  std::uint64_t every, const std::function<void(double)>& progress) {
  std::vector<FunctionCall> calls;
  std::vector<Sweep> sweeps;
  for (sk::Device& device : devices) {
    calls.emplace_back(device, function);
    sweeps.emplace_back(function, device.profile() != "native");
  }
  std::vector<float> arguments(sweepBlock, 1.0F);
  std::vector<double> exact(sweepBlock);
  for (std::uint64_t first = 0; first < allFloats;) {
    const auto count = static_cast<std::size_t>(
        std::min<std::uint64_t>(sweepBlock, (allFloats - first + every - 1) / every));
    floatsFrom(first, every, arguments.data(), count);
    function.inDouble(arguments.data(), exact.data(), count);
    first += count * every;
    for (std::size_t d = 0; d < calls.size(); ++d) {
      const std::vector<float>& results = calls[d].of(arguments);
      for (std::size_t at = 0; at < count; at += sweepPiece)
        sweeps[d].add(&arguments[at], &results[at], &exact[at], std::min(sweepPiece, count - at));
    }
    progress(std::min(1.0, static_cast<double>(first) / static_cast<double>(allFloats)));
  }
  std::vector<FunctionErrors> errors;
  for (const Sweep& one : sweeps) errors.push_back(one.result());
  return errors;
}

namespace {

constexpr std::size_t sampleBlock = std::size_t{1} << 16;  ///< arguments of a call
constexpr std::size_t mostSampled = 16;  ///< worst cases

/// The numbers that a function takes and returns.
struct Format {
  bool isRelative;  ///< errors are in 2^-53 of the result, else in ulp
  int digits;  ///< of an argument
  int smallest, largest;  ///< exponents of arguments
  double leastResult, leastError;  ///< results below the first have an absolute error of at most the second
  double mostResult;  ///< larger ones are infinite
};

Format formatOf(const sk::Device& device, sk::Precision precision) {
  const bool isNative = device.profile() == "native";
  const double flushed = isNative ? 0 : 0x1p-1022;
  if (precision == sk::Precision::Double)
    return {!isNative, 53, -1000, 1000, flushed, flushed, std::numeric_limits<double>::max()};
  if (precision == sk::Precision::Extended && !isNative)
    return {true, 48, -76, 120, 0x1p-78, 0x1p-124, 0x1.fffffcp127};
  return {false,
          24,
          -126,
          127,
          isNative ? 0 : 0x1p-126,
          isNative ? 0 : 0x1p-126,
          std::numeric_limits<float>::max()};
}

/// Truncates x to this number of bits.
double truncated(double x, int digits) {
  const int exponent = x == 0 || !std::isfinite(x) ? 0 : std::ilogb(x);
  return std::ldexp(std::trunc(std::ldexp(x, digits - 1 - exponent)), exponent - digits + 1);
}

double errorOf(const Format& format, double got, long double wanted) {
  if (std::isnan(got) || std::isnan(wanted)) return std::isnan(got) && std::isnan(wanted) ? 0 : HUGE_VAL;
  const auto size = std::fabs(wanted);
  if (size >= static_cast<long double>(format.mostResult))
    return std::fabs(got) >= format.mostResult && std::signbit(got) == std::signbit(wanted) ? 0 : HUGE_VAL;
  if (!std::isfinite(got)) return HUGE_VAL;
  const long double distance = std::fabs(got - wanted);
  if (size < static_cast<long double>(format.leastResult))
    return distance <= static_cast<long double>(format.leastError) ? 0 : HUGE_VAL;
  if (format.isRelative) return static_cast<double>(std::ldexp(distance / size, 53));
  const int lowest = format.digits == 24 ? -126 : -1022;
  const int exponent = size == 0 ? lowest : std::max(std::ilogb(size), lowest);
  return static_cast<double>(std::ldexp(distance, format.digits - 1 - exponent));
}

/// Draws pairs of arguments, calls the function, and keeps the worst.
class Sampling {
 public:
  Sampling(sk::Device& device, Function function, sk::Precision precision)
      : format_(formatOf(device, precision)),
        function_(function),
        options_{.precision = precision},
        x_(device.stream<float>(squareOf(sampleBlock), storage())),
        y_(device.stream<float>(squareOf(sampleBlock), storage())),
        r_(device.stream<float>(squareOf(sampleBlock), storage())) {}

  const Format& format() const { return format_; }
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  /// A number with any exponent and sign.
  double any() {
    const auto exponents = static_cast<std::uint64_t>(format_.largest - format_.smallest + 1);
    const int exponent = format_.smallest + static_cast<int>(random_() % exponents);
    const double size = std::ldexp(1 + unit(), exponent);
    return random_() % 2 != 0 ? -size : size;
  }

  /// Tries a block of arguments that `draw` returns.
  template <class Draw, class Exactly>
  void add(const Draw& draw, const Exactly& exactly) {
    std::vector<double> xs(sampleBlock), ys(sampleBlock);
    for (std::size_t i = 0; i < sampleBlock; ++i) {
      const auto [x, y] = draw();
      xs[i] = truncated(x, format_.digits);
      ys[i] = truncated(y, format_.digits);
    }
    x_.writeReals(xs);
    y_.writeReals(ys);
    probes::function.with(options_)(function_, x_, y_, r_);
    const std::vector<double> results = r_.readReals();
    for (std::size_t i = 0; i < sampleBlock; ++i) {
      const long double wanted = exactly(xs[i], ys[i]);
      keep({xs[i], ys[i], results[i], static_cast<double>(wanted), errorOf(format_, results[i], wanted)});
    }
    found_.arguments += sampleBlock;
  }

  /// Draws near the worst cases, ever nearer.
  template <class Exactly>
  void searchNearWorst(std::uint64_t count, const Exactly& exactly) {
    const std::uint64_t blocks = std::max<std::uint64_t>(count / sampleBlock, 4);
    for (std::uint64_t i = 0; i < blocks && !found_.worst.empty(); ++i) {
      const std::vector<SampledCase> near = found_.worst;
      const double width = std::exp2(-4 - 36.0 * static_cast<double>(i) / static_cast<double>(blocks));
      add(
          [&] {
            const SampledCase& one = near[random_() % near.size()];
            return std::pair{one.x * (1 + width * between(-1, 1)), one.y * (1 + width * between(-1, 1))};
          },
          exactly);
    }
  }

  const SampledErrors& found() const { return found_; }

 private:
  sk::Storage storage() const {
    return options_.precision == sk::Precision::Single ? sk::Storage::Single : sk::Storage::Double;
  }

  void keep(const SampledCase& one) {
    std::vector<SampledCase>& worst = found_.worst;
    if (one.error == 0 || (worst.size() == mostSampled && one.error <= worst.back().error)) return;
    const auto place =
        std::ranges::find_if(worst, [&](const SampledCase& other) { return other.error < one.error; });
    worst.insert(place, one);
    if (worst.size() > mostSampled) worst.pop_back();
  }

  Format format_;
  Function function_;
  sk::CallOptions options_;
  sk::Stream<float> x_, y_, r_;
  std::mt19937_64 random_{inputSeed};
  SampledErrors found_;
};

/// Draws `count` arguments, and an eighth as many near the worst of them.
template <class Draw, class Exactly>
SampledErrors sampled(Sampling& sampling, std::uint64_t count, const Draw& draw, const Exactly& exactly,
                      const std::function<void(double)>& progress) {
  const double all = 1.125 * static_cast<double>(count);
  while (sampling.found().arguments < count) {
    sampling.add(draw, exactly);
    progress(static_cast<double>(sampling.found().arguments) / all);
  }
  sampling.searchNearWorst(count / 8, exactly);
  progress(1);
  return sampling.found();
}

}  // namespace

SampledErrors sample(sk::Device& device, const UnaryFunction& function, sk::Precision precision,
                     std::uint64_t count, const std::function<void(double)>& progress) {
  Sampling sampling(device, function.number, precision);
  const auto draw = [&] {
    const double u = sampling.unit();
    const double x = u < 0.5 ? sampling.between(function.low, function.high) : sampling.any();
    // Around 1 and 0, in the function's range, and of any size
    return std::pair{u < 0.125  ? x / 64
                     : u < 0.25 ? 1 + x / 64
                     : u < 0.75 ? x
                                : std::ldexp(x, -std::ilogb(x) + static_cast<int>(sampling.between(-24, 24))),
                     0.0};
  };
  return sampled(sampling, count, draw, [&](double x, double) { return function.exactly(x); }, progress);
}

SampledErrors sample(sk::Device& device, const BinaryFunction& function, sk::Precision precision,
                     std::uint64_t count, const std::function<void(double)>& progress) {
  Sampling sampling(device, function.number, precision);
  const auto draw = [&] {
    const auto which =
        static_cast<std::size_t>(sampling.unit() * static_cast<double>(function.ranges.size() + 1));
    if (which == function.ranges.size()) return std::pair{sampling.any(), sampling.any()};
    const auto& [xLow, xHigh, yLow, yHigh] = function.ranges[which];
    return std::pair{sampling.between(xLow, xHigh), sampling.between(yLow, yHigh)};
  };
  return sampled(sampling, count, draw, function.exactly, progress);
}

}  // namespace sk_tool
