// SPDX-License-Identifier: MIT
//
// Promises: scans of floats in doubles have the same bits on every CPU and however they are divided into multiples of
// eight elements, and the error of a few additions in double.
#include "native/sum_floats.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "native/entries.hpp"
#include "native/object_code_test.hpp"

namespace sk::test {
namespace {

struct Scan {
  std::size_t factors = 1;
  bool isExclusive = false;
  bool isWide = false;
  double start = 0;
  std::int64_t most = std::numeric_limits<std::int64_t>::max();  ///< elements of a call

  /// The sums of x, or of x * y, and of all in the end.
  template <class Result>
  std::vector<Result> of(std::vector<float> x, std::vector<float> y, double* all = nullptr) const {
    SumFrame frame{};
    frame.start = start;
    native::ScanFunction* const scan = floatScan(factors, std::is_same_v<Result, float>, isWide);
    std::vector<Result> results(x.size(), Result(7));
    double carry = -1;
    for (std::int64_t first = 0, count = std::ssize(x); first < count; first += most) {
      void* const arrays[] = {x.data() + first, y.data() + first};
      native::Chunk chunk{};
      chunk.arrays = arrays;
      chunk.count = std::min(most, count - first);
      void* const state[] = {&carry};
      void* const to[] = {results.data() + first};
      scan(&frame, &chunk, state, to, first == 0 ? 1 : 0, isExclusive ? 1 : 0);
    }
    if (all != nullptr) *all = carry;
    return results;
  }
};

std::vector<bool> waysOfCpu() {
#if defined(__x86_64__) && defined(__GNUC__)
  if (levelOfCpu() >= native::Level::V3) return {false, true};
#endif
  return {false};
}

std::vector<float> fractions(std::int64_t count, int seed) {
  std::vector<float> values = someFloats(count, seed);
  for (float& value : values) value /= 7;
  return values;
}

template <class T>
bool areSame(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST_CASE("floats are scanned in doubles, in every way alike") {
  for (std::int64_t count = 1; count < 60; ++count) {
    INFO(count << " elements");
    const std::vector<float> x = fractions(count, 1), y = fractions(count, 2);
    for (const std::size_t factors : {1U, 2U}) {
      for (const bool isExclusive : {false, true}) {
        const Scan plain{.factors = factors, .isExclusive = isExclusive};
        double all = 0;
        const std::vector<double> sums = plain.of<double>(x, y, &all);
        double sum = 0, magnitude = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
          const double term = factors == 1 ? double{x[i]} : double{x[i]} * y[i];
          if (isExclusive) REQUIRE(std::fabs(sums[i] - sum) <= 1e-14 * magnitude);
          sum += term, magnitude += std::fabs(term);
          if (!isExclusive) REQUIRE(std::fabs(sums[i] - sum) <= 1e-14 * magnitude);
        }
        REQUIRE(std::fabs(all - sum) <= 1e-14 * magnitude);
        const std::vector<float> rounded(sums.begin(), sums.end());
        for (const bool isWide : waysOfCpu()) {
          for (const std::int64_t most : {count, std::int64_t{8}, std::int64_t{16}}) {
            Scan way = plain;
            way.isWide = isWide, way.most = most;
            CHECK(areSame(way.of<double>(x, y), sums));
            CHECK(areSame(way.of<float>(x, y), rounded));
          }
        }
      }
    }
  }
}

TEST_CASE("a scan that starts from -0 keeps it, and infinities go on from where they are") {
  constexpr float inf = std::numeric_limits<float>::infinity();
  for (const bool isWide : waysOfCpu()) {
    const Scan seeded{.isWide = isWide, .start = -0.0};
    for (const float sum : seeded.of<float>(std::vector<float>(11, -0.0F), std::vector<float>(11)))
      CHECK((sum == 0 && std::signbit(sum)));
    std::vector<float> x(30, 1);
    x[5] = inf, x[18] = -inf;
    const std::vector<float> sums = Scan{.isWide = isWide}.of<float>(x, x);
    CHECK(sums[4] == 5);
    for (std::size_t i = 5; i < 18; ++i) CHECK(sums[i] == inf);
    for (std::size_t i = 18; i < 30; ++i) CHECK(std::isnan(sums[i]));
  }
}

}  // namespace
}  // namespace sk::test
