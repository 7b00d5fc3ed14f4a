// SPDX-License-Identifier: MIT
//
// Incomplete factors with a dual threshold, row by row: what is small is dropped, and of the rest the largest are kept.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <queue>
#include <vector>

#include "ordering.hpp"

namespace sk::linear {

namespace {

struct Kept {
  std::int32_t column = 0;
  double value = 0.0;
};

/// Appends the `most` largest of these to the current row of a matrix, in the order of their columns.
void appendLargest(std::vector<Kept>& entries, std::int64_t most, SparseMatrix& to) {
  const auto larger = [](const Kept& x, const Kept& y) {
    return std::abs(x.value) != std::abs(y.value) ? std::abs(x.value) > std::abs(y.value)
                                                  : x.column < y.column;
  };
  if (static_cast<std::int64_t>(entries.size()) > most) {
    const auto end = entries.begin() + static_cast<std::ptrdiff_t>(most);
    std::nth_element(entries.begin(), end, entries.end(), larger);
    entries.erase(end, entries.end());
  }
  std::ranges::sort(entries, {}, &Kept::column);
  for (const Kept& e : entries) {
    to.column.push_back(e.column);
    to.value.push_back(e.value);
  }
}

}  // namespace

std::int64_t factoriseByThreshold(const SparseMatrix& a, const Threshold& threshold, SparseMatrix& factors) {
  const auto n = static_cast<std::size_t>(a.rows);
  factors = {.rows = a.rows, .columns = a.columns, .starts = {0}, .column = {}, .value = {}};
  std::vector<double> w(n, 0.0);  // the current row, of which `isIn` says the columns
  std::vector<bool> isIn(n, false);
  std::vector<std::size_t> pivot(n);  // where a row of the factors has its diagonal
  std::vector<std::int32_t> columns;
  std::vector<Kept> lower, upper;
  for (std::size_t i = 0; i < n; ++i) {
    std::priority_queue<std::int32_t, std::vector<std::int32_t>, std::greater<>> next;  // columns below i
    columns.clear();
    double squares = 0.0;
    const auto take = [&](std::int32_t column, double value) {
      const auto j = static_cast<std::size_t>(column);
      w[j] += value;
      if (isIn[j]) return;
      isIn[j] = true;
      columns.push_back(column);
      if (j < i) next.push(column);
    };
    for (auto k = static_cast<std::size_t>(a.starts[i]); k < static_cast<std::size_t>(a.starts[i + 1]); ++k) {
      take(a.column[k], a.value[k]);
      squares += a.value[k] * a.value[k];
    }
    const double least = threshold.drop * std::sqrt(squares);
    lower.clear();
    upper.clear();
    while (!next.empty()) {
      const std::int32_t column = next.top();
      next.pop();
      const auto row = static_cast<std::size_t>(column);
      const double factor = w[row] / factors.value[pivot[row]];
      if (!(std::abs(factor) >= threshold.drop) || factor == 0.0) continue;
      lower.push_back({column, factor});
      for (std::size_t m = pivot[row] + 1; m < static_cast<std::size_t>(factors.starts[row + 1]); ++m)
        take(factors.column[m], -factor * factors.value[m]);
    }
    const double diagonal = w[i];
    for (const std::int32_t column : columns) {
      const auto j = static_cast<std::size_t>(column);
      if (j > i && std::abs(w[j]) >= least && w[j] != 0.0) upper.push_back({column, w[j]});
      w[j] = 0.0;
      isIn[j] = false;
    }
    if (!(std::abs(diagonal) > 0.0) || !std::isfinite(diagonal)) return static_cast<std::int64_t>(i);
    appendLargest(lower, threshold.fill, factors);
    pivot[i] = factors.value.size();
    factors.column.push_back(static_cast<std::int32_t>(i));
    factors.value.push_back(diagonal);
    appendLargest(upper, threshold.fill, factors);
    factors.starts.push_back(factors.entries());
  }
  return -1;
}

}  // namespace sk::linear
