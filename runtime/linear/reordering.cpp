// SPDX-License-Identifier: MIT
#include "reordering.hpp"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <sk/error.hpp>

namespace sk::linear {

namespace {

/// The rows of a matrix, each connected to those of its entries, whichever side of the diagonal these are on.
class Graph {
 public:
  explicit Graph(const SparseMatrix& a)
      : a_(a), transposed_(transpose(a)), seenBy_(static_cast<std::size_t>(a.rows), 0) {}

  std::int64_t degree(std::int32_t row) const { return a_.length(row) + transposed_.length(row); }

  /// Appends the rows that can be reached from `root` to `order`, breadth first, neighbours of low degree first. Returns the number of levels, and where
  /// the last one begins in `order`.
  struct Levels {
    std::int64_t count = 0;
    std::size_t last = 0;
  };
  Levels appendFrom(std::int32_t root, std::vector<std::int32_t>& order) {
    ++walk_;
    Levels levels{.count = 1, .last = order.size()};
    seenBy_[static_cast<std::size_t>(root)] = walk_;
    order.push_back(root);
    for (std::size_t next = levels.last, end = order.size(); next < order.size(); ++next) {
      if (next == end) {
        levels = {.count = levels.count + 1, .last = next};
        end = order.size();
      }
      appendNeighbours(order[next], order);
    }
    return levels;
  }

 private:
  void appendNeighbours(std::int32_t row, std::vector<std::int32_t>& order) {
    const auto first = static_cast<std::ptrdiff_t>(order.size());
    const auto i = static_cast<std::size_t>(row);
    for (const SparseMatrix* m : {&a_, static_cast<const SparseMatrix*>(&transposed_)})
      for (auto k = static_cast<std::size_t>(m->starts[i]); k < static_cast<std::size_t>(m->starts[i + 1]);
           ++k) {
        std::int64_t& seen = seenBy_[static_cast<std::size_t>(m->column[k])];
        if (seen == walk_) continue;
        seen = walk_;
        order.push_back(m->column[k]);
      }
    std::stable_sort(order.begin() + first, order.end(), [this](std::int32_t x, std::int32_t y) {
      return degree(x) != degree(y) ? degree(x) < degree(y) : x < y;
    });
  }

  const SparseMatrix& a_;
  SparseMatrix transposed_;
  std::vector<std::int64_t> seenBy_;  ///< the walk that has seen a row last
  std::int64_t walk_ = 0;
};

}  // namespace

std::vector<std::int32_t> reverseCuthillMcKee(const SparseMatrix& a) {
  Graph graph(a);
  std::vector<std::int32_t> order, trial;
  std::vector<bool> isDone(static_cast<std::size_t>(a.rows), false);
  order.reserve(isDone.size());
  for (std::int32_t first = 0; first < a.rows; ++first) {
    if (isDone[static_cast<std::size_t>(first)]) continue;
    std::int32_t root = first;
    std::int64_t levels = 0;
    while (true) {  // ends, for the number of levels grows
      trial.clear();
      const Graph::Levels found = graph.appendFrom(root, trial);
      if (found.count <= levels) break;
      levels = found.count;
      root = *std::min_element(
          trial.begin() + static_cast<std::ptrdiff_t>(found.last), trial.end(),
          [&](std::int32_t x, std::int32_t y) { return graph.degree(x) < graph.degree(y); });
    }
    for (const std::int32_t row : trial) isDone[static_cast<std::size_t>(row)] = true;
    order.insert(order.end(), trial.begin(), trial.end());
  }
  std::ranges::reverse(order);
  return order;
}

std::int64_t bandwidth(const SparseMatrix& a) {
  std::int64_t widest = 0;
  for (std::int64_t i = 0; i < a.rows; ++i) {
    if (a.length(i) == 0) continue;
    const std::int64_t first = a.column[static_cast<std::size_t>(a.starts[static_cast<std::size_t>(i)])];
    const std::int64_t last =
        a.column[static_cast<std::size_t>(a.starts[static_cast<std::size_t>(i) + 1]) - 1];
    widest = std::max({widest, std::abs(first - i), std::abs(last - i)});
  }
  return widest;
}

std::vector<std::int32_t> reorderingNamed(std::string_view name, const SparseMatrix& a) {
  if (name == "none") return {};
  if (name == "rcm") return reverseCuthillMcKee(a);
  throw sk::Error(fmt::format("no reordering is called '{}'; there are none, rcm", name));
}

std::vector<double> inOrder(std::span<const double> v, std::span<const std::int32_t> order) {
  if (order.empty()) return {v.begin(), v.end()};
  std::vector<double> result(v.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = v[static_cast<std::size_t>(order[i])];
  return result;
}

std::vector<double> inFormerOrder(std::span<const double> v, std::span<const std::int32_t> order) {
  if (order.empty()) return {v.begin(), v.end()};
  std::vector<double> result(v.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[static_cast<std::size_t>(order[i])] = v[i];
  return result;
}

}  // namespace sk::linear
