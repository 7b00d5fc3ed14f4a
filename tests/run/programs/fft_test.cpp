// SPDX-License-Identifier: MIT
//
// fft.sk against the sum that defines the transform, in double.
//
// N. J. Higham, "Accuracy and stability of numerical algorithms", second edition (2002), theorem 24.2: if the roots have
// errors of at most mu, the relative error after log2(n) passes is at most log2(n) eta / (1 - log2(n) eta) in the Euclidean
// norm, where eta = mu + gamma_4 (sqrt(2) + mu). For roots rounded from double, mu <= unitRoundoff.
#include "programs/fft.sk.hpp"

#include <complex>
#include <numbers>

#include "programs/bounds.hpp"
#include "support/devices.hpp"

using namespace run_tests;
using sk::float2;

namespace {

using Complex = std::complex<double>;
using Matrix = sk::Stream<float2>;  // of complex numbers

/// exp(sign 2 pi i k / n) for all k.
std::vector<Complex> rootsOfUnity(std::int64_t n, double sign) {
  std::vector<Complex> roots;
  for (std::int64_t k = 0; k < n; ++k) {
    roots.push_back(
        std::polar(1.0, sign * 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n)));
  }
  return roots;
}

std::vector<float2> rounded(const std::vector<Complex>& x) {
  std::vector<float2> result;
  for (const Complex& c : x) result.push_back({static_cast<float>(c.real()), static_cast<float>(c.imag())});
  return result;
}

/// Transforms every row in place. The sign is -1 for the transform and 1 for its inverse.
void transformRows(sk::Device& device, Matrix& x, double sign) {
  const std::int64_t n = x.shape()[1];
  const auto roots = streamOf<float2>(device, rounded(rootsOfUnity(n, sign)));
  for (std::int64_t size = 2; size <= n; size *= 2) fft::join(static_cast<int>(size), roots, x, x);
}

/// The transform in both dimensions.
Matrix transform(sk::Device& device, Matrix x, double sign) {
  auto flipped = device.stream<float2>({x.shape()[1], x.shape()[0]});
  transformRows(device, x, sign);
  fft::transpose(x, flipped);
  transformRows(device, flipped, sign);
  fft::transpose(flipped, x);
  return x;
}

std::vector<Complex> signal(std::int64_t count) {
  std::vector<Complex> x;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) x.emplace_back(noise(i, 1), noise(i, 2));
  return x;
}

/// The transform of each row of `length` elements, by its definition.
std::vector<Complex> definedRows(const std::vector<Complex>& x, std::int64_t length) {
  const auto n = static_cast<std::size_t>(length);
  const auto roots = rootsOfUnity(length, -1);
  std::vector<Complex> y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::size_t row = i / n * n;
    for (std::size_t j = 0; j < n; ++j) y[i] += x[row + j] * roots[i % n * j % n];
  }
  return y;
}

std::vector<Complex> transposed(const std::vector<Complex>& x, std::int64_t width) {
  const auto w = static_cast<std::size_t>(width);
  const std::size_t h = x.size() / w;
  std::vector<Complex> y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) y[i % w * h + i / w] = x[i];
  return y;
}

/// The Euclidean norm of the error, relative to the norm of the expected result.
double relativeError(const std::vector<float2>& actual, const std::vector<Complex>& expected) {
  REQUIRE(actual.size() == expected.size());
  double error = 0, whole = 0;
  for (std::size_t i = 0; i < actual.size(); ++i) {
    error += std::norm(Complex(actual[i].x, actual[i].y) - expected[i]);
    whole += std::norm(expected[i]);
  }
  return std::sqrt(error / whole);
}

double bound(std::int64_t points) {
  const double mu = unitRoundoff;
  const double eta = mu + roundings(4) * (std::sqrt(2.0) + mu);
  const double passes = std::log2(static_cast<double>(points));
  return passes * eta / (1 - passes * eta);
}

}  // namespace

TEST_CASE("fft: rows of every power of two") {
  onDrawnLayouts([](sk::Device& device) {
    for (const std::int64_t n : {1, 2, 4, 8, 32, 64, 128, 1024}) {
      for (const std::int64_t rows : {1, 3}) {
        INFO(rows << " x " << n);
        const auto x = signal(rows * n);
        auto stream = streamOf<float2>(device, {rows, n}, rounded(x));
        transformRows(device, stream, -1);
        CHECK(relativeError(stream.read(), definedRows(x, n)) <= bound(n));
      }
    }
  });
}

TEST_CASE("fft: matrices, and back") {
  onDrawnLayouts([](sk::Device& device) {
    for (const auto& [height, width] : {std::pair{1, 1}, {2, 1}, {8, 8}, {16, 128}, {64, 2}}) {
      INFO(height << " x " << width);
      const auto x = signal(height * width);
      const auto columns = definedRows(transposed(definedRows(x, width), width), height);
      Matrix y = transform(device, streamOf<float2>(device, {height, width}, rounded(x)), -1);
      CHECK(relativeError(y.read(), transposed(columns, height)) <= bound(height * width));
      Matrix back = transform(device, std::move(y), 1);
      fft::scale(1.0f / static_cast<float>(height * width), back, back);  // a power of two: exact
      const double b = bound(height * width);
      CHECK(relativeError(back.read(), x) <= 2 * b + b * b);
    }
  });
}

TEST_CASE("fft: no rows") {
  onGlAndNative([](sk::Device& device) {
    auto none = device.stream<float2>({0, 8});
    transformRows(device, none, -1);
    CHECK(none.read().empty());
  });
}
