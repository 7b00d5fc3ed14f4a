// SPDX-License-Identifier: MIT
//
// Inputs of probes, which are the same in every process, and streams of them.
//
// The functions of functions.def, numbered as in functions.sk.
//
// Errors in units in the last place, reported as in the GPU floating-point paranoia (Hillesland and Lastra,
// 2004): the signed interval, and the largest and the mean magnitude.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "info/device_info.hpp"
#include "sk/device.hpp"

namespace sk_tool {

/// Numbers from a fixed seed. (The distributions of the C++ library differ between libraries.)
class Numbers {
 public:
  explicit Numbers(unsigned seed) : random_(seed) {}

  /// In [0, 1).
  double unit() { return random_() * 0x1p-32; }
  /// In [low, high].
  float linear(double low, double high) { return static_cast<float>(low + (high - low) * unit()); }
  /// In [low, high], both positive, distributed logarithmically: as many in [1, 2] as in [100, 200].
  float logarithmic(double low, double high) {
    return static_cast<float>(low * std::exp2(unit() * std::log2(high / low)));
  }
  /// With a random sign.
  float anySign(float number) { return (random_() & 1U) != 0 ? -number : number; }

 private:
  std::mt19937 random_;
};

/// A square stream that holds the numbers, padded with 1.
inline sk::Shape squareOf(std::size_t count) {
  const auto side = static_cast<std::int64_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  return {side, side};
}

template <class T>
sk::Stream<T> streamOf(sk::Device& device, std::vector<T> values) {
  const sk::Shape shape = squareOf(values.size());
  values.resize(static_cast<std::size_t>(shape.size()), T(1));
  auto stream = device.stream<T>(shape);
  stream.write(values);
  return stream;
}

enum Function : unsigned {
#define SK_FUNCTION(name) f_##name,
#define SK_RANGE(name, spread, low, high)
#define SK_FUNCTION2(name) f_##name,
#define SK_RANGE2(name, spread, low, high, spread2, low2, high2)
#include "info/functions.def"
};

/// The distance between floats at a number: 2^-149 for subnormal numbers.
double ulpOf(double number);

/// `value` rounded to three significant digits, so that figures of one run have one format.
double rounded(double value);

class ErrorStatistics {
 public:
  /// `reference` must be in the range of floats.
  void add(float got, double reference, double argument);

  /// "max", "mean", "min_signed" and "max_signed" in ulp, "max_absolute", "worst_at" (the argument) and
  /// "not_finite" (the number of results that are not finite, which are excluded from the others).
  Json json() const;
  double max() const { return max_; }

 private:
  std::size_t count_ = 0;
  std::size_t notFinite_ = 0;
  double sum_ = 0, max_ = 0, least_ = 0, most_ = 0, maxAbsolute_ = 0, worstAt_ = 0;
};

}  // namespace sk_tool
