// SPDX-License-Identifier: MIT
#include "layout.hpp"

#include <algorithm>

#include "text/named.hpp"

namespace sk::linear {

namespace {

constexpr std::size_t mostDiagonals = 64;

bool always(const SparseMatrix& a) { return a.entries() > 0; }
bool onDemand(const SparseMatrix&) { return false; }  // slower than others on every device that was measured

/// Worth a trial where the diagonals hold little that is not an entry.
bool hasFewDiagonals(const SparseMatrix& a) {
  if (a.rows != a.columns || a.rows == 0) return false;
  const std::vector<std::int64_t> diagonals = diagonalsOf(a, mostDiagonals);
  return diagonals.size() <= mostDiagonals &&
         static_cast<std::int64_t>(diagonals.size()) * a.rows <= 2 * a.entries();
}

bool isMostlyFull(const SparseMatrix& a) { return a.entries() > 0 && 2 * a.entries() >= a.rows * a.columns; }

constexpr LayoutKind layouts[] = {
    {"rows", "compressed rows, balanced whatever their lengths", makeRows, always, bytesOfRows, 1.0, 1.0},
    {"slices", "SELL-C-sigma: slices of 32 rows of similar lengths", makeSlices, always, bytesOfSlices, 1.5,
     1.0},
    {"buckets", "rows of one length together (Bolz and others 2003)", makeBuckets, onDemand, bytesOfBuckets,
     1.0, 1.0},
    {"diagonals", "one stream for each diagonal (Krueger and Westermann 2003)", makeDiagonals,
     hasFewDiagonals, bytesOfDiagonals, 0.25, 0.5},
    {"points", "an addition for each entry (Krueger and Westermann 2003)", makePoints, onDemand,
     bytesOfPoints, 1.0, 1.0},
    {"dense", "all elements", makeDense, isMostlyFull, bytesOfDense, 0.5, 0.5},
};

}  // namespace

std::span<const LayoutKind> layoutKinds() { return layouts; }

std::vector<std::int64_t> diagonalsOf(const SparseMatrix& a, std::size_t most) {
  std::vector<std::int64_t> found;
  for (std::int64_t i = 0; i < a.rows && found.size() <= most; ++i)
    for (auto k = static_cast<std::size_t>(a.starts[static_cast<std::size_t>(i)]);
         k < static_cast<std::size_t>(a.starts[static_cast<std::size_t>(i) + 1]); ++k) {
      const std::int64_t offset = (a.column[k] - i + a.columns) % a.columns;
      const auto at = std::lower_bound(found.begin(), found.end(), offset);
      if (at == found.end() || *at != offset) found.insert(at, offset);
    }
  return found;
}

std::int64_t bytesOf(const SparseMatrix& a, std::string_view layout, std::int64_t entryBytes) {
  if (layout != "auto") return text::rowNamed(layoutKinds(), layout, "layout").bytes(a, entryBytes);
  std::int64_t least = layouts[0].bytes(a, entryBytes);
  for (const LayoutKind& kind : layouts)
    if (kind.suits(a)) least = std::min(least, kind.bytes(a, entryBytes));
  return least;
}

bool hasNarrowOffsets(const SparseMatrix& a, std::int64_t row) {
  if (a.length(row) == 0) return true;
  const auto first = static_cast<std::size_t>(a.starts[static_cast<std::size_t>(row)]);
  const auto last = static_cast<std::size_t>(a.starts[static_cast<std::size_t>(row) + 1]) - 1;
  return a.column[first] - row >= -0x8000 && a.column[last] - row <= 0x7fff;
}

std::vector<LayoutCost> layoutCosts(const sk::Device& device, const SparseMatrix& a,
                                    const Arithmetic& arithmetic) {
  const bool isNative = device.profile() == "native";
  // An element of x for each entry: those that only fill read one, too, and bytes() counts them with the matrix.
  const std::int64_t entryBytes = bytesOf(arithmetic.matrix);
  const double elements = static_cast<double>(bytesOf(arithmetic.vectors) * a.entries());
  std::vector<LayoutCost> costs;
  for (const LayoutKind& kind : layouts) {
    if (!kind.suits(a)) continue;
    const double bytes = static_cast<double>(kind.bytes(a, entryBytes)) + elements;
    costs.push_back({kind.name, (isNative ? kind.native : kind.others) * bytes});
  }
  std::ranges::stable_sort(costs, {}, &LayoutCost::bytes);
  return costs;
}

std::unique_ptr<Matrix> makeMatrix(sk::Device& device, const SparseMatrix& a, std::string_view layout,
                                   const Arithmetic& arithmetic, std::vector<LayoutCost>* costs) {
  if (layout != "auto") return text::rowNamed(layoutKinds(), layout, "layout").make(device, a, arithmetic);
  const std::vector<LayoutCost> all = layoutCosts(device, a, arithmetic);
  if (costs != nullptr) *costs = all;
  const std::string_view best = all.empty() ? layouts[0].name : all.front().layout;
  return text::rowNamed(layoutKinds(), best, "layout").make(device, a, arithmetic);
}

}  // namespace sk::linear
