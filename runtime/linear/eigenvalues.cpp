// SPDX-License-Identifier: MIT
#include "eigenvalues.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

namespace sk::linear {

namespace {

/// y = D^-1/2 A D^-1/2 x
std::vector<double> symmetricallyScaledProduct(const SparseMatrix& a, std::span<const double> roots,
                                               const std::vector<double>& x) {
  std::vector<double> scaled(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) scaled[i] = roots[i] * x[i];
  std::vector<double> y = multiply(a, scaled);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] *= roots[i];
  return y;
}

double product(const std::vector<double>& x, const std::vector<double>& y) {
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return sum;
}

double rowSumBound(const SparseMatrix& a, std::span<const double> inverseDiagonal) {
  double bound = 0.0;
  for (std::size_t i = 0; i < inverseDiagonal.size(); ++i) {
    double sum = 0.0;
    for (auto k = static_cast<std::size_t>(a.starts[i]); k < static_cast<std::size_t>(a.starts[i + 1]); ++k)
      sum += std::abs(a.value[k]);
    bound = std::max(bound, sum * inverseDiagonal[i]);
  }
  return bound;
}

/// A rotation in the plane of rows p and q that makes the element (p, q) of the symmetric matrix 0; the eigenvectors are the columns of `vectors`.
void rotate(std::vector<double>& m, std::vector<double>& vectors, std::size_t n, std::size_t p,
            std::size_t q) {
  const double theta = (m[q * n + q] - m[p * n + p]) / (2.0 * m[p * n + q]);
  const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
  const double c = 1.0 / std::hypot(t, 1.0), s = t * c;
  const auto turn = [c, s](double& x, double& y) {
    const double before = x;
    x = c * before - s * y;
    y = s * before + c * y;
  };
  for (std::size_t k = 0; k < n; ++k) turn(m[k * n + p], m[k * n + q]);
  for (std::size_t k = 0; k < n; ++k) turn(m[p * n + k], m[q * n + k]);
  for (std::size_t k = 0; k < n; ++k) turn(vectors[k * n + p], vectors[k * n + q]);
}

}  // namespace

double tridiagonalEigenvalue(const std::vector<double>& diagonal, const std::vector<double>& beside,
                             bool isSmallest) {
  const std::size_t n = diagonal.size();
  double low = diagonal[0], high = diagonal[0];
  for (std::size_t i = 0; i < n; ++i) {
    const double radius = (i > 0 ? beside[i - 1] : 0.0) + (i + 1 < n ? beside[i] : 0.0);
    low = std::min(low, diagonal[i] - radius);
    high = std::max(high, diagonal[i] + radius);
  }
  for (int step = 0; step < 60; ++step) {
    const double x = 0.5 * (low + high);
    std::size_t below = 0;
    double pivot = 1.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double b = i > 0 ? beside[i - 1] : 0.0;
      pivot = diagonal[i] - x - (i > 0 ? b * b / pivot : 0.0);
      if (pivot == 0.0) pivot = 1e-300;
      below += pivot < 0.0 ? 1 : 0;
    }
    const bool isAbove = isSmallest ? below > 0 : below == n;
    (isAbove ? high : low) = x;
  }
  return 0.5 * (low + high);
}

double jacobiEigenvalueBound(const SparseMatrix& a, std::span<const double> inverseDiagonal) {
  constexpr int steps = 12;
  const std::size_t n = inverseDiagonal.size();
  std::vector<double> roots(n), v(n), before(n, 0.0), diagonal, beside;
  std::minstd_rand random(1);
  for (std::size_t i = 0; i < n; ++i) {
    roots[i] = std::sqrt(inverseDiagonal[i]);
    v[i] = roots[i] > 0.0 ? static_cast<double>(random()) / static_cast<double>(std::minstd_rand::max()) - 0.5
                          : 0.0;
  }
  double length = std::sqrt(product(v, v));
  for (int k = 0; k < steps && length > 1e-12; ++k) {
    for (double& x : v) x /= length;
    std::vector<double> next = symmetricallyScaledProduct(a, roots, v);
    const double alpha = product(v, next), beta = k > 0 ? length : 0.0;
    for (std::size_t i = 0; i < n; ++i) next[i] -= alpha * v[i] + beta * before[i];
    if (k > 0) beside.push_back(beta);
    diagonal.push_back(alpha);
    before = std::move(v);
    v = std::move(next);
    length = std::sqrt(product(v, v));
  }
  if (diagonal.empty()) return 1.0;
  return std::min(1.1 * tridiagonalEigenvalue(diagonal, beside, false), rowSumBound(a, inverseDiagonal));
}

std::vector<double> pseudoInverse(std::vector<double> matrix, std::size_t n) {
  std::vector<double> vectors(n * n, 0.0);
  double largest = 0.0;
  for (std::size_t i = 0; i < n; ++i) vectors[i * n + i] = 1.0;
  for (const double v : matrix) largest = std::max(largest, std::abs(v));
  constexpr int mostSweeps = 40;  // each about squares the elements beside the diagonal
  for (int sweep = 0; sweep < mostSweeps; ++sweep) {
    bool isDiagonal = true;
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t q = p + 1; q < n; ++q)
        if (std::abs(matrix[p * n + q]) > 0x1p-60 * largest) {
          isDiagonal = false;
          rotate(matrix, vectors, n, p, q);
        }
    if (isDiagonal) break;
  }
  std::vector<double> inverse(n * n, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    const double eigenvalue = matrix[k * n + k];
    if (std::abs(eigenvalue) <= 0x1p-44 * largest) continue;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        inverse[i * n + j] += vectors[i * n + k] * vectors[j * n + k] / eigenvalue;
  }
  return inverse;
}

}  // namespace sk::linear
