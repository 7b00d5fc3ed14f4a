// SPDX-License-Identifier: MIT
//
// Exact sums of floats and of products of floats: MPFR numbers of 1500 bits hold them without rounding. Also inputs that
// are hard to sum.
#pragma once

#include <mpfr.h>

#include <cstddef>
#include <vector>

namespace numerics {

/// A sum that never rounds.
class TrueSum {
 public:
  TrueSum();
  ~TrueSum();
  TrueSum(const TrueSum&) = delete;
  TrueSum& operator=(const TrueSum&) = delete;

  /// Floats, or doubles whose products lie between 2^-500 and 2^500.
  void add(double x) { addProduct(x, 1); }
  void addProduct(double x, double y);

  /// The nearest float, which may be denormal; ties to even.
  float rounded() const;
  /// |result - sum|.
  double errorOf(double result) const;
  double magnitude() const;  ///< sum of |x * y|
  /// magnitude() / |sum|; infinity if the sum is 0.
  double condition() const;
  double value() const;

 private:
  mpfr_t sum_, magnitude_, product_;
};

struct Pairs {
  std::vector<float> x, y;
};

/// Two vectors of n floats whose dot product has about this condition number: Ogita, Rump and Oishi, Accurate sum and dot
/// product, SIAM J. Sci. Comput. 26 (2005), algorithm 6.1. TrueSum computes the actual condition number.
Pairs illConditionedDot(std::size_t n, double condition, unsigned seed);
/// n floats whose sum has about this condition number.
std::vector<float> illConditionedSum(std::size_t n, double condition, unsigned seed);

/// Finite floats with random bits, so of every exponent, including denormals.
std::vector<float> anyFloats(std::size_t n, unsigned seed);

}  // namespace numerics
