// SPDX-License-Identifier: MIT
#include "support/oracle.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>

namespace numerics {

TrueSum::TrueSum() {
  mpfr_inits2(1500, sum_, magnitude_, product_, nullptr);
  mpfr_set_zero(sum_, 1);
  mpfr_set_zero(magnitude_, 1);
}
TrueSum::~TrueSum() { mpfr_clears(sum_, magnitude_, product_, nullptr); }

void TrueSum::addProduct(double x, double y) {
  mpfr_set_d(product_, x, MPFR_RNDN);
  mpfr_mul_d(product_, product_, y, MPFR_RNDN);
  mpfr_add(sum_, sum_, product_, MPFR_RNDN);
  mpfr_abs(product_, product_, MPFR_RNDN);
  mpfr_add(magnitude_, magnitude_, product_, MPFR_RNDN);
}

float TrueSum::rounded() const { return mpfr_get_flt(sum_, MPFR_RNDN); }
double TrueSum::value() const { return mpfr_get_d(sum_, MPFR_RNDN); }
double TrueSum::magnitude() const { return mpfr_get_d(magnitude_, MPFR_RNDN); }

double TrueSum::errorOf(double result) const {
  mpfr_t difference;
  mpfr_init2(difference, 1500);
  mpfr_sub_d(difference, sum_, result, MPFR_RNDN);
  const double error = std::fabs(mpfr_get_d(difference, MPFR_RNDN));
  mpfr_clear(difference);
  return error;
}

double TrueSum::condition() const {
  if (mpfr_zero_p(sum_)) return std::numeric_limits<double>::infinity();
  mpfr_t ratio;
  mpfr_init2(ratio, 64);
  mpfr_div(ratio, magnitude_, sum_, MPFR_RNDN);
  const double condition = std::fabs(mpfr_get_d(ratio, MPFR_RNDN));
  mpfr_clear(ratio);
  return condition;
}

Pairs illConditionedDot(std::size_t n, double condition, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> mantissa(-1, 1);
  const int range = static_cast<int>(std::lround(std::log2(condition) / 2));
  std::uniform_int_distribution<int> exponents(0, range);
  Pairs pairs{std::vector<float>(n), std::vector<float>(n)};
  TrueSum sum;
  for (std::size_t i = 0; i < n; ++i) {
    const bool isFirstHalf = i < n / 2;
    // The second half reduces the sum, from the largest exponent to 0.
    const auto left = static_cast<double>(n - 1 - i) / static_cast<double>(n - n / 2);
    const int e = i == 0        ? range
                  : isFirstHalf ? exponents(random)
                                : static_cast<int>(std::lround(left * range));
    pairs.x[i] = std::ldexp(mantissa(random), e);
    if (isFirstHalf) {
      pairs.y[i] = std::ldexp(mantissa(random), i == 0 ? range : exponents(random));
    } else {
      const double wanted = std::ldexp(static_cast<double>(mantissa(random)), e);
      pairs.y[i] = static_cast<float>((wanted - sum.value()) / pairs.x[i]);
    }
    sum.addProduct(pairs.x[i], pairs.y[i]);
  }
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), random);
  Pairs shuffled;
  for (const std::size_t i : order) {
    shuffled.x.push_back(pairs.x[i]);
    shuffled.y.push_back(pairs.y[i]);
  }
  return shuffled;
}

std::vector<float> illConditionedSum(std::size_t n, double condition, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> mantissa(-1, 1);
  const int range = static_cast<int>(std::lround(std::log2(condition)));
  std::uniform_int_distribution<int> exponents(0, range);
  std::vector<float> x;
  TrueSum sum;
  for (std::size_t i = 0; i < n; ++i) {
    const auto left = static_cast<double>(n - 1 - i) / static_cast<double>(n - n / 2);
    const int e = static_cast<int>(std::lround(left * range));
    const double wanted = std::ldexp(static_cast<double>(mantissa(random)), e);
    if (i < n / 2) {
      x.push_back(std::ldexp(mantissa(random), i == 0 ? range : exponents(random)));
    } else {
      x.push_back(static_cast<float>(wanted - sum.value()));
    }
    sum.add(x.back());
  }
  std::shuffle(x.begin(), x.end(), random);
  return x;
}

std::vector<float> anyFloats(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<float> x;
  while (x.size() < n) {
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (std::isfinite(value)) x.push_back(value);
  }
  return x;
}

}  // namespace numerics
