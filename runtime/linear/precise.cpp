// SPDX-License-Identifier: MIT
#include "precise.hpp"

#include <algorithm>
#include <cmath>

namespace sk::linear {

namespace {

constexpr double u = 0x1p-53;

/// The sum of products that have been added so far, as a double and what it lacks.
struct Sum {
  double high = 0.0, low = 0.0, magnitude = 0.0;

  void add(double a, double x) {
    const double product = a * x;
    const double lost = std::fma(a, x, -product);
    const double sum = high + product;
    const double part = sum - high;
    low += ((high - (sum - part)) + (product - part)) + lost;
    high = sum;
    magnitude += std::abs(product);
  }
};

PreciseResidual finished(std::span<const Sum> rows, std::int64_t terms) {
  // Their theorem 5.4: the unit roundoff of the result, and gamma squared of the sum of magnitudes.
  const double gamma = static_cast<double>(terms) * u;
  PreciseResidual result;
  result.r.reserve(rows.size());
  double errors = 0.0;
  for (const Sum& row : rows) {
    result.r.push_back(row.high + row.low);
    const double error = 1.01 * (u * std::abs(result.r.back()) + gamma * gamma * row.magnitude);
    errors += error * error;
  }
  result.norms = normsOf(result.r);
  result.norms.error += std::sqrt(errors);
  return result;
}

}  // namespace

Norms normsOf(std::span<const double> v) {
  Norms norms;
  double sum = 0.0;
  for (const double x : v) {
    sum += x * x;
    norms.infinity = std::isnan(x) ? x : std::max(norms.infinity, std::abs(x));
  }
  norms.two = std::sqrt(sum);
  norms.error = (static_cast<double>(v.size()) + 4.0) * u * norms.two;
  return norms;
}

double boundOfNorm(const Operator& a) { return std::sqrt(a.oneNorm * a.infinityNorm); }

double roundingOfResidual(const Operator& a, double normA, double normX, double normB) {
  // Three for each entry: its product, its sum, and the difference of elements in varying.sk.
  const double terms = 3.0 * static_cast<double>(a.longestRow) + 4.0;
  // || |A| |x| || <= || |A| || ||x||, and the bound of the norm is that of |A|, too.
  return 1.01 * terms * u * (normA * normX + normB);
}

PreciseResidual preciseResidual(const Operator& a, double scale, std::span<const double> x,
                                std::span<const double> b) {
  std::vector<Sum> rows(b.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].high = b[i];
    rows[i].magnitude = std::abs(b[i]);
  }
  if (a.sparse != nullptr) {
    const SparseMatrix& m = *a.sparse;
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (auto k = static_cast<std::size_t>(m.starts[i]); k < static_cast<std::size_t>(m.starts[i + 1]); ++k)
        rows[i].add(-scale * m.value[k], x[static_cast<std::size_t>(m.column[k])]);
  } else {
    const Stencil& stencil = *a.stencil;
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].add(-scale * stencil.centre, x[i]);
    visitNeighbours(stencil, [&](std::int64_t i, std::int64_t j, std::size_t d) {
      rows[static_cast<std::size_t>(i)].add(-scale * stencil.along[d], x[static_cast<std::size_t>(j)]);
    });
  }
  return finished(rows, a.longestRow + 2);
}

}  // namespace sk::linear
