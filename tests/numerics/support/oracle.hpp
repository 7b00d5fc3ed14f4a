// SPDX-License-Identifier: MIT
//
// True sums of floats, and of products of floats, by MPFR: 1500 bits hold every one of them without rounding. And inputs
// that are hard to sum.
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

  void add(float x) { addProduct(x, 1); }
  void addProduct(float x, float y);

  /// The nearest float, ties to even, denormals among them.
  float rounded() const;
  /// |result - sum|.
  double errorOf(float result) const;
  double magnitude() const;  ///< sum of |x * y|
  /// magnitude() / |sum|; infinity of a sum of 0.
  double condition() const;
  double value() const;

 private:
  mpfr_t sum_, magnitude_, product_;
};

struct Pairs {
  std::vector<float> x, y;
};

/// n floats and their factors whose dot product has about this condition number: Ogita, Rump and Oishi, Accurate sum and dot
/// product, SIAM J. Sci. Comput. 26 (2005), algorithm 6.1. The true condition number is TrueSum's to say.
Pairs illConditionedDot(std::size_t n, double condition, unsigned seed);
/// The same as a sum, of n floats.
std::vector<float> illConditionedSum(std::size_t n, double condition, unsigned seed);

/// Finite floats of every exponent, denormals among them.
std::vector<float> anyFloats(std::size_t n, unsigned seed);

}  // namespace numerics
