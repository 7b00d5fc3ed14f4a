// SPDX-License-Identifier: MIT
#include "operator.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace sk::linear {

namespace {

bool annihilatesOnes(const Operator& a) {
  if (a.size == 0 || a.infinityNorm == 0.0) return false;
  const std::vector<double> ones(static_cast<std::size_t>(a.size), 1.0);
  const std::vector<double> sums = a.multiply(ones);
  return std::ranges::all_of(sums, [&](double s) { return std::abs(s) <= 0x1p-44 * a.infinityNorm; });
}

}  // namespace

double powerOfTwo(double norm) { return norm > 0.0 ? std::ldexp(1.0, -std::ilogb(norm) - 1) : 1.0; }

Operator operatorOf(const SparseMatrix& a) {
  if (a.rows != a.columns)
    throw sk::Error(
        fmt::format("a system of equations has a square matrix; this one has {} x {}", a.rows, a.columns),
        sk::Error::Kind::Shape);
  Operator o;
  o.size = a.rows;
  o.infinityNorm = infinityNorm(a);
  o.diagonal = diagonal(a);
  if (!std::isfinite(o.infinityNorm))
    throw sk::Error("the matrix has entries that are not finite, or whose sums are not");
  std::vector<double> columns(static_cast<std::size_t>(a.columns), 0.0);
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.rows); ++i) {
    double squares = 0.0, sum = 0.0;
    o.longestRow = std::max(o.longestRow, a.length(static_cast<std::int64_t>(i)));
    for (auto k = static_cast<std::size_t>(a.starts[i]); k < static_cast<std::size_t>(a.starts[i + 1]); ++k) {
      squares += a.value[k] * a.value[k];
      sum += std::abs(a.value[k]);
      columns[static_cast<std::size_t>(a.column[k])] += std::abs(a.value[k]);
    }
    o.rowSquares.push_back(squares);
    if (o.diagonal[i] != 0.0) o.jacobiBound = std::max(o.jacobiBound, sum / std::abs(o.diagonal[i]));
  }
  for (const double sum : columns) o.oneNorm = std::max(o.oneNorm, sum);
  o.sparse = &a;
  o.multiply = [&a](std::span<const double> x) { return linear::multiply(a, x); };
  o.hasConstantKernel = annihilatesOnes(o);
  o.scale = powerOfTwo(o.infinityNorm);
  return o;
}

Operator operatorOf(const Stencil& a) {
  const auto n = static_cast<std::size_t>(a.size());
  Operator o;
  o.size = a.size();
  o.diagonal.assign(n, a.centre);
  o.hasConstantKernel = hasConstantKernel(a);
  o.stencil = a;
  o.longestRow = 2 * a.grid.rank() + 1;
  o.multiply = [a](std::span<const double> x) { return linear::multiply(a, x); };
  if (isDirichlet(a)) {  // no visit of every element, for the inner ones bound the others
    double sum = std::abs(a.centre), squares = a.centre * a.centre;
    for (int d = 0; d < a.grid.rank(); ++d) {
      const double c = a.along[static_cast<std::size_t>(d)];
      sum += 2 * std::abs(c);
      squares += 2 * c * c;
    }
    o.infinityNorm = o.oneNorm = sum;
    o.rowSquares.assign(n, squares);
    o.jacobiBound = a.centre != 0.0 ? sum / std::abs(a.centre) : 0.0;
    o.scale = powerOfTwo(o.infinityNorm);
    return o;
  }
  std::vector<double> sums(n, 0.0);  // of the magnitudes beside the diagonal
  o.rowSquares.assign(n, 0.0);
  visitNeighbours(a, [&](std::int64_t i, std::int64_t j, std::size_t d) {
    const double c = a.along[d];
    const auto row = static_cast<std::size_t>(i);
    if (i == j) {
      o.diagonal[row] += c;
    } else {
      sums[row] += std::abs(c);
      o.rowSquares[row] += c * c;
    }
  });
  for (std::size_t i = 0; i < n; ++i) {
    sums[i] += std::abs(o.diagonal[i]);
    o.rowSquares[i] += o.diagonal[i] * o.diagonal[i];
    o.infinityNorm = std::max(o.infinityNorm, sums[i]);
    if (o.diagonal[i] != 0.0) o.jacobiBound = std::max(o.jacobiBound, sums[i] / std::abs(o.diagonal[i]));
  }
  o.oneNorm = o.infinityNorm;  // it is symmetric
  o.scale = powerOfTwo(o.infinityNorm);
  return o;
}

std::string findAsymmetry(const Operator& a) {
  return a.asymmetry.empty() && a.sparse != nullptr ? asymmetry(*a.sparse, a.order) : a.asymmetry;
}

SparseMatrix sparseOf(const Operator& a) { return a.sparse != nullptr ? *a.sparse : assemble(*a.stencil); }

SparseMatrix scaled(SparseMatrix a, double scale) {
  for (double& v : a.value) v *= scale;
  return a;
}

Stencil scaled(Stencil a, double scale) {
  a.centre *= scale;
  for (double& c : a.along) c *= scale;
  return a;
}

}  // namespace sk::linear
