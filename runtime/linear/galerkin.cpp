// SPDX-License-Identifier: MIT
#include "galerkin.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "cycles.hpp"

namespace sk::linear {

namespace {

/// Coarse elements that may have a weight for a fine one.
struct Candidates {
  std::array<std::int64_t, 8> coarse;
  std::array<GridOffset, 8> position;
  std::array<std::size_t, 8> slot;  ///< in Coarsening::weight
  std::size_t size = 0;
};

std::size_t powerOfThree(std::size_t exponent) { return exponent == 0 ? 1 : 3 * powerOfThree(exponent - 1); }

class Transfer {
 public:
  Transfer(const VaryingStencil& a, const Coarsening& c)
      : isPeriodic_(a.isPeriodic), c_(c), fine_(a.grid, a.isPeriodic) {}

  const GridWalk& fine() const { return fine_; }

  /// Bit d is set if the position is between coarse elements along dimension d.
  unsigned betweenAt(const GridOffset& position) const {
    unsigned between = 0;
    for (std::size_t d = 0; d < fine_.rank(); ++d)
      if (c_.step[d] == 2 && ((position[d] - c_.first[d]) & 1) != 0) between |= 1u << d;
    return between;
  }

  Candidates candidatesFor(const GridOffset& position) const {
    Candidates found;
    found.size = 1;
    found.coarse[0] = 0;
    found.position[0] = {};
    found.slot[0] = 0;
    std::size_t power = powerOfThree(fine_.rank() - 1);
    for (std::size_t d = 0; d < fine_.rank(); ++d, power /= 3) {
      const int extent = static_cast<int>(c_.coarse[static_cast<int>(d)]);
      const int shifted = position[d] - c_.first[d];
      const int before = shifted < 0 ? -1 : c_.step[d] == 2 ? shifted / 2 : shifted;
      const int from = shifted - before * c_.step[d];
      const Candidates shorter = found;  // without this dimension
      found.size = 0;
      const auto add = [&](int at, int offset) {
        if (at < 0 || at >= extent) {
          if (!isPeriodic_[d]) return;
          at += at < 0 ? extent : -extent;
        }
        for (std::size_t i = 0; i < shorter.size; ++i) {
          found.coarse[found.size] = shorter.coarse[i] * extent + at;
          found.position[found.size] = shorter.position[i];
          found.position[found.size][d] = at;
          found.slot[found.size++] = shorter.slot[i] + power * static_cast<std::size_t>(offset + 1);
        }
      };
      add(before, from);
      if (from > 0) add(before + 1, from - c_.step[d]);
    }
    const auto n = static_cast<std::size_t>(c_.coarse.size());
    for (std::size_t i = 0; i < found.size; ++i)
      found.slot[i] = found.slot[i] * n + static_cast<std::size_t>(found.coarse[i]);
    return found;
  }

  /// From one coarse element to another one that is beside it.
  GridOffset offsetBetween(const GridOffset& from, const GridOffset& to) const {
    GridOffset offset{};
    for (std::size_t d = 0; d < fine_.rank(); ++d) {
      const int extent = static_cast<int>(c_.coarse[static_cast<int>(d)]);
      offset[d] = to[d] - from[d];
      if (isPeriodic_[d] && extent > 2 && std::abs(offset[d]) == extent - 1)
        offset[d] = offset[d] > 0 ? -1 : 1;
    }
    return offset;
  }

 private:
  std::array<bool, 3> isPeriodic_;
  const Coarsening& c_;
  GridWalk fine_;
};

/// How strongly the elements couple along a dimension: minus the sum of the entries for neighbours there, which is the diffusivity also where corners have entries.
double couplingAlong(const VaryingStencil& a, std::size_t d) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.offsets.size(); ++k)
    if (a.offsets[k][d] != 0)
      for (std::int64_t i = 0; i < a.size(); ++i) sum -= a.value[entryAt(a, k, i)];
  return sum / static_cast<double>(a.size());
}

/// Slots of coarse neighbours by their offset, as neighbourOffsets has them.
std::size_t offsetIndex(const GridOffset& o) {
  return static_cast<std::size_t>((o[0] + 1) * 9 + (o[1] + 1) * 3 + o[2] + 1);
}

void interpolateElement(const VaryingStencil& a, const Transfer& transfer, const GridOffset& position,
                        std::int64_t element, unsigned between, std::vector<double>& weight) {
  const std::size_t rank = transfer.fine().rank();
  const Candidates own = transfer.candidatesFor(position);
  double diagonal = 0.0;
  std::array<double, 8> sum{};
  for (std::size_t k = 0; k < a.offsets.size(); ++k) {
    const double entry = a.value[entryAt(a, k, element)];
    if (entry == 0.0) continue;
    GridOffset offset{}, at{};
    bool isOwn = true;
    for (std::size_t d = 0; d < rank; ++d)
      if ((between >> d & 1u) != 0) {
        offset[d] = a.offsets[k][d];
        isOwn = isOwn && offset[d] == 0;
      }
    if (isOwn) {
      diagonal += entry;
      continue;
    }
    if (transfer.fine().beside(position, offset, at) < 0) continue;
    const Candidates theirs = transfer.candidatesFor(at);
    for (std::size_t i = 0; i < theirs.size; ++i)
      for (std::size_t j = 0; j < own.size; ++j)
        if (own.coarse[j] == theirs.coarse[i]) {
          sum[j] -= entry * weight[theirs.slot[i]];
          break;
        }
  }
  if (!(diagonal > 0.0)) return;
  for (std::size_t j = 0; j < own.size; ++j) weight[own.slot[j]] = sum[j] / diagonal;
}

/// P G P, where P removes the mean of the elements that have equations. A constant in a solution, however large, would leave the residual as it is, but take digits from differences.
void removeConstants(std::vector<double>& inverse, const std::vector<double>& scale) {
  const std::size_t n = scale.size();
  const auto count = static_cast<double>(n - static_cast<std::size_t>(std::ranges::count(scale, 0.0)));
  for (const bool isRow : {true, false})
    for (std::size_t i = 0; i < n; ++i) {
      const auto at = [&](std::size_t j) -> double& {
        return isRow ? inverse[i * n + j] : inverse[j * n + i];
      };
      double sum = 0.0;
      for (std::size_t j = 0; j < n; ++j) sum += at(j);
      for (std::size_t j = 0; j < n; ++j)
        if (scale[j] > 0.0) at(j) -= sum / count;
    }
}

}  // namespace

Coarsening coarsening(const VaryingStencil& a) {
  const auto rank = static_cast<std::size_t>(a.grid.rank());
  Coarsening c;
  std::array<double, 3> coupling{};
  double strongest = 0.0;
  for (std::size_t d = 0; d < rank; ++d) {
    coupling[d] = couplingAlong(a, d);
    if (a.grid[static_cast<int>(d)] > smallestExtent) strongest = std::max(strongest, coupling[d]);
  }
  std::array<std::int64_t, 3> extents{};
  for (std::size_t d = 0; d < rank; ++d) {
    const std::int64_t n = a.grid[static_cast<int>(d)];
    extents[d] = n;
    if (n <= smallestExtent || !(coupling[d] >= strongCoupling * strongest)) continue;
    c.step[d] = 2;
    c.first[d] = a.isPeriodic[d] ? 0 : 1;
    extents[d] = (n - c.first[d] + 1) / 2;
  }
  c.coarse = shapeOf(std::span(extents).first(rank));
  if (c.coarse == a.grid || a.size() <= solvedDirectly) {
    Coarsening none;
    none.coarse = a.grid;
    return none;
  }
  c.weight.assign(static_cast<std::size_t>(c.coarse.size()) * powerOfThree(rank), 0.0);
  const Transfer transfer(a, c);
  const GridWalk& walk = transfer.fine();
  // Elements between coarse ones in more dimensions take the values of those in fewer.
  for (int dimensions = 0; dimensions <= static_cast<int>(rank); ++dimensions) {
    GridOffset position{};
    for (std::int64_t i = 0; i < a.size(); ++i, walk.advance(position)) {
      const unsigned between = transfer.betweenAt(position);
      if (std::popcount(between) != dimensions) continue;
      if (between == 0)
        c.weight[transfer.candidatesFor(position).slot[0]] = 1.0;
      else
        interpolateElement(a, transfer, position, i, between, c.weight);
    }
  }
  return c;
}

VaryingStencil galerkin(const VaryingStencil& a, const Coarsening& c) {
  VaryingStencil coarse{.grid = c.coarse,
                        .isPeriodic = a.isPeriodic,
                        .offsets = neighbourOffsets(a.grid.rank(), Neighbourhood::All),
                        .value = {}};
  coarse.value.assign(coarse.offsets.size() * static_cast<std::size_t>(coarse.size()), 0.0);
  std::array<std::size_t, 27> slotOf{};
  for (std::size_t k = 0; k < coarse.offsets.size(); ++k) slotOf[offsetIndex(coarse.offsets[k])] = k;
  const Transfer transfer(a, c);
  const GridWalk& walk = transfer.fine();
  const double share = 1.0 / c.share();
  GridOffset position{};
  // Row i of A joins the coarse elements that interpolate i with those that interpolate its neighbours.
  for (std::int64_t i = 0; i < a.size(); ++i, walk.advance(position)) {
    const Candidates rows = transfer.candidatesFor(position);
    for (std::size_t k = 0; k < a.offsets.size(); ++k) {
      const double entry = share * a.value[entryAt(a, k, i)];
      if (entry == 0.0) continue;
      GridOffset beside{};
      if (walk.beside(position, a.offsets[k], beside) < 0) continue;
      const Candidates columns = transfer.candidatesFor(beside);
      for (std::size_t row = 0; row < rows.size; ++row) {
        const double left = entry * c.weight[rows.slot[row]];
        if (left == 0.0) continue;
        for (std::size_t column = 0; column < columns.size; ++column) {
          const double right = c.weight[columns.slot[column]];
          if (right == 0.0) continue;
          const GridOffset offset = transfer.offsetBetween(rows.position[row], columns.position[column]);
          const std::size_t slot = slotOf[offsetIndex(offset)];
          coarse.value[entryAt(coarse, slot, rows.coarse[row])] += left * right;
        }
      }
    }
  }
  return coarse;
}

std::vector<double> symmetricInverse(const VaryingStencil& a, bool hasConstantKernel) {
  const auto n = static_cast<std::size_t>(a.size());
  std::vector<double> m(n * n, 0.0), scale(n, 0.0);
  const GridWalk walk(a.grid, a.isPeriodic);
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = static_cast<std::int64_t>(i);
    for (std::size_t k = 0; k < a.offsets.size(); ++k) {
      const std::int64_t j = walk.beside(walk.positionOf(row), a.offsets[k]);
      if (j >= 0) m[i * n + static_cast<std::size_t>(j)] += a.value[entryAt(a, k, row)];
    }
    if (m[i * n + i] > 0.0) scale[i] = 1.0 / std::sqrt(m[i * n + i]);
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) m[i * n + j] *= scale[i] * scale[j];
  // L D L^T, the unit triangle L in the lower part of m. A pivot that is 0, but for roundings, has a column of zeros below.
  std::vector<double> inversePivot(n, 0.0), column(n);
  for (std::size_t k = 0; k < n; ++k) {
    if (!(m[k * n + k] > 1e-12) || (k + 1 == n && hasConstantKernel)) {
      for (std::size_t i = k + 1; i < n; ++i) m[i * n + k] = 0.0;
      continue;
    }
    inversePivot[k] = 1.0 / m[k * n + k];
    for (std::size_t i = k + 1; i < n; ++i) column[i] = m[i * n + k];
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = m[i * n + k] = column[i] * inversePivot[k];
      if (factor == 0.0) continue;
      for (std::size_t j = k + 1; j <= i; ++j) m[i * n + j] -= factor * column[j];
    }
  }
  // The inverse of L, row by row, and then L^-T D^-1 L^-1.
  std::vector<double> lower(n * n, 0.0), inverse(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    lower[i * n + i] = 1.0;
    for (std::size_t k = 0; k < i; ++k)
      for (std::size_t j = 0; j <= k; ++j) lower[i * n + j] -= m[i * n + k] * lower[k * n + j];
  }
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i <= k; ++i) {
      const double factor = lower[k * n + i] * inversePivot[k] * scale[i];
      for (std::size_t j = 0; j <= k; ++j) inverse[i * n + j] += factor * lower[k * n + j] * scale[j];
    }
  if (hasConstantKernel) removeConstants(inverse, scale);
  return inverse;
}

}  // namespace sk::linear
