// SPDX-License-Identifier: MIT
#include "accuracy/functions/sweep.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

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

}  // namespace sk_tool
