// SPDX-License-Identifier: MIT
#include "sparse.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace sk::linear {

namespace {

void checkExtents(std::int64_t rows, std::int64_t columns) {
  constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
  if (rows < 0 || columns < 0 || rows > most || columns > most)
    throw sk::Error(fmt::format("a matrix of {} x {} elements cannot be stored; extents are from 0 to {}",
                                rows, columns, most),
                    sk::Error::Kind::Shape);
}

/// Orders the entries from `begin` by their columns, and adds up those of one column. Returns how many are left.
std::size_t finishRow(SparseMatrix& a, std::size_t begin, std::vector<std::pair<std::int32_t, double>>& row) {
  std::stable_sort(row.begin(), row.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
  std::size_t end = begin;
  for (const auto& [column, value] : row) {
    if (end > begin && a.column[end - 1] == column) {
      a.value[end - 1] += value;
    } else {
      a.column[end] = column;
      a.value[end] = value;
      ++end;
    }
  }
  return end;
}

}  // namespace

SparseMatrix assemble(std::int64_t rows, std::int64_t columns, std::span<const Entry> entries,
                      std::int64_t* duplicates) {
  checkExtents(rows, columns);
  std::vector<std::int64_t> starts(static_cast<std::size_t>(rows) + 1, 0);
  for (const Entry& e : entries) {
    if (e.row < 0 || e.row >= rows || e.column < 0 || e.column >= columns)
      throw sk::Error(fmt::format("the entry at ({}, {}) is outside of a matrix of {} x {}", e.row, e.column,
                                  rows, columns),
                      sk::Error::Kind::Shape);
    ++starts[static_cast<std::size_t>(e.row) + 1];
  }
  for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
  std::vector<std::size_t> order(entries.size());  // by rows, in the order of the list
  std::vector<std::int64_t> next(starts.begin(), starts.end() - 1);
  for (std::size_t i = 0; i < entries.size(); ++i)
    order[static_cast<std::size_t>(next[static_cast<std::size_t>(entries[i].row)]++)] = i;

  SparseMatrix a{.rows = rows, .columns = columns, .starts = {}, .column = {}, .value = {}};
  a.starts.assign(static_cast<std::size_t>(rows) + 1, 0);
  a.column.resize(entries.size());
  a.value.resize(entries.size());
  std::size_t end = 0;
  std::vector<std::pair<std::int32_t, double>> row;
  for (std::size_t i = 0; i + 1 < starts.size(); ++i) {
    row.clear();
    for (auto k = static_cast<std::size_t>(starts[i]); k < static_cast<std::size_t>(starts[i + 1]); ++k)
      row.emplace_back(static_cast<std::int32_t>(entries[order[k]].column), entries[order[k]].value);
    end = finishRow(a, end, row);
    a.starts[i + 1] = static_cast<std::int64_t>(end);
  }
  a.column.resize(end);
  a.value.resize(end);
  if (duplicates != nullptr) *duplicates = static_cast<std::int64_t>(entries.size() - end);
  return a;
}

std::vector<double> multiply(const SparseMatrix& a, std::span<const double> x) {
  if (static_cast<std::int64_t>(x.size()) != a.columns)
    throw sk::Error(fmt::format("the vector has {} elements, and the matrix {} columns", x.size(), a.columns),
                    sk::Error::Kind::Shape);
  std::vector<double> y(static_cast<std::size_t>(a.rows), 0.0);
  for (std::size_t i = 0; i < y.size(); ++i)
    for (auto k = static_cast<std::size_t>(a.starts[i]); k < static_cast<std::size_t>(a.starts[i + 1]); ++k)
      y[i] += a.value[k] * x[static_cast<std::size_t>(a.column[k])];
  return y;
}

std::optional<SparseMatrix> multiply(const SparseMatrix& a, const SparseMatrix& b, std::int64_t most) {
  SparseMatrix c{.rows = a.rows, .columns = b.columns, .starts = {0}, .column = {}, .value = {}};
  std::vector<double> sums(static_cast<std::size_t>(b.columns), 0.0);
  std::vector<std::size_t> seenBy(sums.size(), 0);  // the row that has seen a column last, plus 1
  std::vector<std::int32_t> columns;
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.rows); ++i) {
    columns.clear();
    for (auto k = static_cast<std::size_t>(a.starts[i]); k < static_cast<std::size_t>(a.starts[i + 1]); ++k) {
      const auto row = static_cast<std::size_t>(a.column[k]);
      for (auto m = static_cast<std::size_t>(b.starts[row]); m < static_cast<std::size_t>(b.starts[row + 1]);
           ++m) {
        const auto column = static_cast<std::size_t>(b.column[m]);
        if (seenBy[column] != i + 1) {
          seenBy[column] = i + 1;
          sums[column] = 0.0;
          columns.push_back(b.column[m]);
        }
        sums[column] += a.value[k] * b.value[m];
      }
    }
    if (c.entries() + static_cast<std::int64_t>(columns.size()) > most) return std::nullopt;
    std::ranges::sort(columns);
    for (const std::int32_t column : columns) {
      c.column.push_back(column);
      c.value.push_back(sums[static_cast<std::size_t>(column)]);
    }
    c.starts.push_back(c.entries());
  }
  return c;
}

SparseMatrix transpose(const SparseMatrix& a) {
  SparseMatrix t{.rows = a.columns, .columns = a.rows, .starts = {}, .column = {}, .value = {}};
  t.starts.assign(static_cast<std::size_t>(a.columns) + 1, 0);
  for (const std::int32_t c : a.column) ++t.starts[static_cast<std::size_t>(c) + 1];
  for (std::size_t i = 1; i < t.starts.size(); ++i) t.starts[i] += t.starts[i - 1];
  t.column.resize(a.column.size());
  t.value.resize(a.value.size());
  std::vector<std::int64_t> next(t.starts.begin(), t.starts.end() - 1);
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.rows); ++i)
    for (auto k = static_cast<std::size_t>(a.starts[i]); k < static_cast<std::size_t>(a.starts[i + 1]); ++k) {
      const auto at = static_cast<std::size_t>(next[static_cast<std::size_t>(a.column[k])]++);
      t.column[at] = static_cast<std::int32_t>(i);
      t.value[at] = a.value[k];
    }
  return t;
}

double infinityNorm(const SparseMatrix& a) {
  double norm = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.rows); ++i) {
    double sum = 0.0;
    for (auto k = static_cast<std::size_t>(a.starts[i]); k < static_cast<std::size_t>(a.starts[i + 1]); ++k)
      sum += std::abs(a.value[k]);
    norm = std::max(norm, sum);
  }
  return norm;
}

std::vector<double> diagonal(const SparseMatrix& a) {
  std::vector<double> d(static_cast<std::size_t>(std::min(a.rows, a.columns)), 0.0);
  for (std::size_t i = 0; i < d.size(); ++i)
    for (auto k = static_cast<std::size_t>(a.starts[i]); k < static_cast<std::size_t>(a.starts[i + 1]); ++k)
      if (a.column[k] == static_cast<std::int32_t>(i)) d[i] = a.value[k];
  return d;
}

std::string asymmetry(const SparseMatrix& a, std::span<const std::int32_t> order) {
  const auto numberOf = [&](std::size_t i) {
    return (order.empty() ? static_cast<std::int64_t>(i) : order[i]) + 1;
  };
  if (a.rows != a.columns) return fmt::format("it has {} rows and {} columns", a.rows, a.columns);
  const SparseMatrix t = transpose(a);
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.rows); ++i) {
    auto k = static_cast<std::size_t>(a.starts[i]), m = static_cast<std::size_t>(t.starts[i]);
    const auto kEnd = static_cast<std::size_t>(a.starts[i + 1]),
               mEnd = static_cast<std::size_t>(t.starts[i + 1]);
    while (k < kEnd || m < mEnd) {
      const std::int32_t inA = k < kEnd ? a.column[k] : std::numeric_limits<std::int32_t>::max();
      const std::int32_t inT = m < mEnd ? t.column[m] : std::numeric_limits<std::int32_t>::max();
      const std::int32_t column = std::min(inA, inT);
      const double here = inA == column ? a.value[k++] : 0.0;
      const double there = inT == column ? t.value[m++] : 0.0;
      if (here != there) {
        const std::int64_t row = numberOf(i), other = numberOf(static_cast<std::size_t>(column));
        return fmt::format("entry ({}, {}) is {}, and ({}, {}) is {}", row, other, here, other, row, there);
      }
    }
  }
  return "";
}

std::string zeroDiagonal(const SparseMatrix& a) {
  const std::vector<double> d = diagonal(a);
  const auto zero = std::find(d.begin(), d.end(), 0.0);
  return zero == d.end() ? "" : fmt::format("row {}", zero - d.begin());
}

}  // namespace sk::linear
