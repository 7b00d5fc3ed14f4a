// SPDX-License-Identifier: MIT
//
// The levels of smoothed aggregation, on the host. Only constants are taken for vectors of small energy, so a prolongator has row sums of 1.
#include "aggregation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "eigenvalues.hpp"
#include "operator.hpp"

namespace sk::linear {

namespace {

constexpr double strengthThreshold = 0.08;  ///< of the finest level; half as large on each coarser one
constexpr double dominance = 5.0;  ///< of a diagonal over the rest of its row that needs no coarse level

std::size_t firstEntry(const SparseMatrix& a, std::size_t row) {
  return static_cast<std::size_t>(a.starts[row]);
}
std::size_t endOfRow(const SparseMatrix& a, std::size_t row) {
  return static_cast<std::size_t>(a.starts[row + 1]);
}

/// Rows whose diagonals dominate the rest.
std::vector<bool> dominatedRows(const SparseMatrix& a, const std::vector<double>& d) {
  std::vector<bool> dominated(d.size());
  for (std::size_t i = 0; i < d.size(); ++i) {
    double rest = -std::abs(d[i]);
    for (std::size_t k = firstEntry(a, i); k < endOfRow(a, i); ++k) rest += std::abs(a.value[k]);
    dominated[i] = d[i] >= dominance * rest;
  }
  return dominated;
}

/// The row of the largest entry beside the diagonal of row i that is not in a dominated row; -1 if there is none.
std::int32_t companionOf(const SparseMatrix& a, const std::vector<bool>& dominated, std::size_t i) {
  double largest = 0.0;
  std::int32_t companion = -1;
  for (std::size_t k = firstEntry(a, i); k < endOfRow(a, i); ++k) {
    const auto j = static_cast<std::size_t>(a.column[k]);
    if (j == i || dominated[j] || !(std::abs(a.value[k]) > largest)) continue;
    largest = std::abs(a.value[k]);
    companion = a.column[k];
  }
  return companion;
}

/// P = (I - omega D^-1 A) T for the matrix A without weak entries and the tentative prolongator T, whose row i has a 1 in the column of its aggregate.
SparseMatrix smoothedProlongator(const SparseMatrix& strong, const std::vector<std::int32_t>& aggregate,
                                 std::int64_t count, bool isSmoothed) {
  const std::vector<double> d = diagonal(strong);
  std::vector<double> inverse(d.size());
  std::ranges::transform(d, inverse.begin(), [](double v) { return v > 0.0 ? 1.0 / v : 0.0; });
  const double omega = isSmoothed ? 4.0 / 3.0 / jacobiEigenvalueBound(strong, inverse) : 0.0;
  SparseMatrix p{.rows = strong.rows, .columns = count, .starts = {0}, .column = {}, .value = {}};
  std::vector<std::pair<std::int32_t, double>> row;
  for (std::size_t i = 0; i < aggregate.size(); ++i) {
    row.clear();
    if (aggregate[i] >= 0) row.emplace_back(aggregate[i], 1.0);
    for (std::size_t k = firstEntry(strong, i); isSmoothed && k < endOfRow(strong, i); ++k)
      if (const std::int32_t j = aggregate[static_cast<std::size_t>(strong.column[k])]; j >= 0)
        row.emplace_back(j, -omega * inverse[i] * strong.value[k]);
    std::ranges::stable_sort(row, {}, &std::pair<std::int32_t, double>::first);
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (k > 0 && row[k].first == row[k - 1].first) {
        p.value.back() += row[k].second;
      } else {
        p.column.push_back(row[k].first);
        p.value.push_back(row[k].second);
      }
    }
    p.starts.push_back(static_cast<std::int64_t>(p.value.size()));
  }
  return p;
}

/// Makes rows and columns zero that the kernel of the matrix leaves nothing but roundings of: an aggregate may be all rows of a part of the matrix
/// that has no entries in common with the rest.
void clearKernel(SparseMatrix& coarse, const SparseMatrix& fine, const SparseMatrix& p) {
  const std::vector<double> d = diagonal(fine), found = diagonal(coarse);
  std::vector<double> terms(found.size(), 0.0);
  for (std::size_t i = 0; i < d.size(); ++i)
    for (std::size_t k = firstEntry(p, i); k < endOfRow(p, i); ++k)
      terms[static_cast<std::size_t>(p.column[k])] += p.value[k] * p.value[k] * d[i];
  const auto isKernel = [&](std::size_t i) { return !(found[i] > 0x1p-40 * terms[i]); };
  for (std::size_t i = 0; i < found.size(); ++i)
    for (std::size_t k = firstEntry(coarse, i); k < endOfRow(coarse, i); ++k)
      if (isKernel(i) || isKernel(static_cast<std::size_t>(coarse.column[k]))) coarse.value[k] = 0.0;
}

/// Sets the transfers of a level, and returns the next level's matrix; std::nullopt if no row needs one.
std::optional<SparseMatrix> coarsen(AggregationLevel& level, double threshold) {
  const SparseMatrix& a = level.matrix;
  const SparseMatrix strong = withoutWeakEntries(a, threshold);
  const std::vector<std::int32_t> aggregate = aggregatesOf(strong);
  const std::int64_t count = std::ranges::max(aggregate) + std::int64_t{1};
  if (count == 0) return std::nullopt;
  // Where rows have many neighbours in common, smoothing may fill the coarse matrix; without smoothing, it has no more entries than this one.
  std::optional<SparseMatrix> coarse;
  for (const bool isSmoothed : {true, false}) {
    level.prolongator = smoothedProlongator(strong, aggregate, count, isSmoothed);
    level.restrictor = transpose(level.prolongator);
    const std::optional<SparseMatrix> product = multiply(a, level.prolongator, 8 * a.entries());
    if (product) coarse = multiply(level.restrictor, *product, a.entries());
    if (coarse) break;
  }
  clearKernel(*coarse, a, level.prolongator);
  const double scale = powerOfTwo(infinityNorm(*coarse));
  level.restrictor = scaled(std::move(level.restrictor), scale);
  return scaled(std::move(*coarse), scale);
}

std::vector<double> coarsestInverseOf(const SparseMatrix& a) {
  const auto n = static_cast<std::size_t>(a.rows);
  std::vector<double> elements(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = firstEntry(a, i); k < endOfRow(a, i); ++k)
      elements[i * n + static_cast<std::size_t>(a.column[k])] = a.value[k];
  return pseudoInverse(std::move(elements), n);
}

}  // namespace

SparseMatrix withoutWeakEntries(const SparseMatrix& a, double threshold) {
  const std::vector<double> d = diagonal(a);
  const std::vector<bool> dominated = dominatedRows(a, d);
  const auto isLarge = [&](std::size_t i, std::size_t k) {
    const auto j = static_cast<std::size_t>(a.column[k]);
    return j != i && !dominated[i] && !dominated[j] && a.value[k] != 0.0 &&
           a.value[k] * a.value[k] >= threshold * threshold * d[i] * d[j];
  };
  std::vector<std::int32_t> companion(d.size(), -1);
  for (std::size_t i = 0; i < d.size(); ++i) {
    bool hasLarge = dominated[i];
    for (std::size_t k = firstEntry(a, i); !hasLarge && k < endOfRow(a, i); ++k) hasLarge = isLarge(i, k);
    if (!hasLarge) companion[i] = companionOf(a, dominated, i);
  }
  SparseMatrix strong{.rows = a.rows, .columns = a.columns, .starts = {0}, .column = {}, .value = {}};
  for (std::size_t i = 0; i < d.size(); ++i) {
    double weak = 0.0;
    std::size_t own = 0;
    for (std::size_t k = firstEntry(a, i); k < endOfRow(a, i); ++k) {
      const auto j = static_cast<std::size_t>(a.column[k]);
      const bool isStrong = j == i || isLarge(i, k) || companion[i] == static_cast<std::int32_t>(j) ||
                            companion[j] == static_cast<std::int32_t>(i);
      if (!isStrong) {
        weak += a.value[k];
        continue;
      }
      if (j == i) own = strong.value.size();
      strong.column.push_back(a.column[k]);
      strong.value.push_back(a.value[k]);
    }
    // Positive entries beside a diagonal may add up to more than it.
    if (d[i] + weak > 0.0) strong.value[own] += weak;
    strong.starts.push_back(static_cast<std::int64_t>(strong.value.size()));
  }
  return strong;
}

std::vector<std::int32_t> aggregatesOf(const SparseMatrix& strong) {
  const auto n = static_cast<std::size_t>(strong.rows);
  std::vector<std::int32_t> aggregate(n, -1);
  std::int32_t count = 0;
  // A row and all its neighbours, where none of them has an aggregate yet. A row of one entry has no neighbour.
  for (std::size_t i = 0; i < n; ++i) {
    bool isFree = strong.length(static_cast<std::int64_t>(i)) > 1;
    for (std::size_t k = firstEntry(strong, i); isFree && k < endOfRow(strong, i); ++k)
      isFree = aggregate[static_cast<std::size_t>(strong.column[k])] < 0;
    if (!isFree) continue;
    for (std::size_t k = firstEntry(strong, i); k < endOfRow(strong, i); ++k)
      aggregate[static_cast<std::size_t>(strong.column[k])] = count;
    ++count;
  }
  // Each of the other rows has a neighbour in one of these aggregates, and joins that of the strongest.
  const std::vector<std::int32_t> roots = aggregate;
  for (std::size_t i = 0; i < n; ++i) {
    if (roots[i] >= 0) continue;
    double largest = 0.0;
    for (std::size_t k = firstEntry(strong, i); k < endOfRow(strong, i); ++k) {
      const std::int32_t other = roots[static_cast<std::size_t>(strong.column[k])];
      if (other < 0 || !(std::abs(strong.value[k]) > largest)) continue;
      largest = std::abs(strong.value[k]);
      aggregate[i] = other;
    }
  }
  return aggregate;
}

AggregationHierarchy aggregationHierarchy(SparseMatrix a) {
  AggregationHierarchy hierarchy;
  double threshold = strengthThreshold;
  while (true) {
    AggregationLevel& level = hierarchy.levels.emplace_back();
    level.matrix = std::move(a);
    level.inverseDiagonal = diagonal(level.matrix);
    for (double& v : level.inverseDiagonal) v = v > 0.0 ? 1.0 / v : 0.0;
    if (level.matrix.rows <= mostOfCoarsest) {
      hierarchy.coarsestInverse = coarsestInverseOf(level.matrix);
      return hierarchy;
    }
    level.largestEigenvalue = jacobiEigenvalueBound(level.matrix, level.inverseDiagonal);
    std::optional<SparseMatrix> coarse = coarsen(level, threshold);
    if (!coarse) return hierarchy;
    a = std::move(*coarse);
    threshold *= 0.5;
  }
}

}  // namespace sk::linear
