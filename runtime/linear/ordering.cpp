// SPDX-License-Identifier: MIT
#include "ordering.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace sk::linear {

namespace {

/// Calls visit(j) for each row j that row i depends on, or that depends on row i; some twice.
template <class Visit>
void visitNeighbours(const SparseMatrix& a, const SparseMatrix& transposed, std::size_t i, Visit&& visit) {
  for (const SparseMatrix* m : {&a, &transposed})
    for (auto k = static_cast<std::size_t>(m->starts[i]); k < static_cast<std::size_t>(m->starts[i + 1]); ++k)
      visit(static_cast<std::size_t>(m->column[k]));
}

/// Rows sorted by their group, in their own order within one.
Ordering sorted(const std::vector<std::int32_t>& group) {
  Ordering o;
  std::int32_t last = -1;
  for (const std::int32_t g : group) last = std::max(last, g);
  o.starts.assign(static_cast<std::size_t>(last) + 2, 0);
  for (const std::int32_t g : group) ++o.starts[static_cast<std::size_t>(g) + 1];
  std::partial_sum(o.starts.begin(), o.starts.end(), o.starts.begin());
  std::vector<std::int64_t> next(o.starts.begin(), o.starts.end() - 1);
  o.order.resize(group.size());
  for (std::size_t i = 0; i < group.size(); ++i)
    o.order[static_cast<std::size_t>(next[static_cast<std::size_t>(group[i])]++)] =
        static_cast<std::int32_t>(i);
  return o;
}

}  // namespace

Ordering colours(const SparseMatrix& a) {
  const SparseMatrix transposed = transpose(a);
  std::vector<std::int32_t> colour(static_cast<std::size_t>(a.rows), -1);
  std::vector<std::size_t> takenBy;  // the row that has seen a colour last, plus 1
  for (std::size_t i = 0; i < colour.size(); ++i) {
    visitNeighbours(a, transposed, i, [&](std::size_t j) {
      if (colour[j] >= 0) takenBy[static_cast<std::size_t>(colour[j])] = i + 1;
    });
    std::size_t c = 0;
    while (c < takenBy.size() && takenBy[c] == i + 1) ++c;
    if (c == takenBy.size()) takenBy.push_back(0);
    colour[i] = static_cast<std::int32_t>(c);
  }
  return sorted(colour);
}

Ordering levels(const SparseMatrix& a) {
  const SparseMatrix transposed = transpose(a);
  std::vector<std::int32_t> level(static_cast<std::size_t>(a.rows), 0);
  for (std::size_t i = 0; i < level.size(); ++i)
    visitNeighbours(a, transposed, i, [&](std::size_t j) {
      if (j < i) level[i] = std::max(level[i], level[j] + 1);
    });
  return sorted(level);
}

Ordering orderingNamed(std::string_view name, const SparseMatrix& a) {
  if (name == "colours") return colours(a);
  if (name == "levels") return levels(a);
  throw sk::Error(fmt::format("no ordering is called '{}'; there are colours, levels", name));
}

SparseMatrix permuted(const SparseMatrix& a, std::span<const std::int32_t> order) {
  std::vector<std::int64_t> place(order.size());
  for (std::size_t i = 0; i < place.size(); ++i)
    place[static_cast<std::size_t>(order[i])] = static_cast<std::int64_t>(i);
  std::vector<Entry> entries;
  entries.reserve(a.value.size());
  for (std::size_t i = 0; i < place.size(); ++i)
    for (auto k = static_cast<std::size_t>(a.starts[i]); k < static_cast<std::size_t>(a.starts[i + 1]); ++k)
      entries.push_back({place[i], place[static_cast<std::size_t>(a.column[k])], a.value[k]});
  return assemble(a.rows, a.columns, entries);
}

std::int64_t factorise(SparseMatrix& a, bool needsPositive) {
  constexpr std::size_t none = static_cast<std::size_t>(-1);
  const auto n = static_cast<std::size_t>(a.rows);
  std::vector<std::size_t> at(n, none);  // where the current row has a column
  std::vector<std::size_t> pivot(n, none);
  for (std::size_t i = 0; i < n; ++i) {
    const auto begin = static_cast<std::size_t>(a.starts[i]), end = static_cast<std::size_t>(a.starts[i + 1]);
    for (std::size_t k = begin; k < end; ++k) at[static_cast<std::size_t>(a.column[k])] = k;
    for (std::size_t k = begin; k < end && static_cast<std::size_t>(a.column[k]) < i; ++k) {
      const auto row = static_cast<std::size_t>(a.column[k]);
      const double factor = a.value[k] /= a.value[pivot[row]];
      for (std::size_t m = pivot[row] + 1; m < static_cast<std::size_t>(a.starts[row + 1]); ++m)
        if (const std::size_t to = at[static_cast<std::size_t>(a.column[m])]; to != none)
          a.value[to] -= factor * a.value[m];
    }
    pivot[i] = at[i];
    for (std::size_t k = begin; k < end; ++k) at[static_cast<std::size_t>(a.column[k])] = none;
    if (pivot[i] == none || a.value[pivot[i]] == 0.0 || (needsPositive && !(a.value[pivot[i]] > 0.0)))
      return static_cast<std::int64_t>(i);
  }
  return -1;
}

}  // namespace sk::linear
