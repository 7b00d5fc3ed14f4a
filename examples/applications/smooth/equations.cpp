// SPDX-License-Identifier: MIT
#include "equations.hpp"

#include <algorithm>
#include <cmath>

namespace smooth {

namespace {

bool namesPointTwice(const Triangle& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; }

std::size_t entryAt(const linear::SparseMatrix& a, std::int32_t row, std::int32_t column) {
  const auto first = a.column.begin() + a.starts[static_cast<std::size_t>(row)],
             last = a.column.begin() + a.starts[static_cast<std::size_t>(row) + 1];
  return static_cast<std::size_t>(std::lower_bound(first, last, column) - a.column.begin());
}

/// For each point, one that stands for all points that edges connect with it.
std::vector<std::int32_t> partsOf(const linear::SparseMatrix& a) {
  std::vector<std::int32_t> part(static_cast<std::size_t>(a.rows), -1), next;
  for (std::int32_t first = 0; first < a.rows; ++first) {
    if (part[static_cast<std::size_t>(first)] >= 0) continue;
    part[static_cast<std::size_t>(first)] = first;
    next.assign(1, first);
    while (!next.empty()) {
      const auto row = static_cast<std::size_t>(next.back());
      next.pop_back();
      for (auto k = static_cast<std::size_t>(a.starts[row]); k < static_cast<std::size_t>(a.starts[row + 1]);
           ++k) {
        if (part[static_cast<std::size_t>(a.column[k])] >= 0) continue;
        part[static_cast<std::size_t>(a.column[k])] = first;
        next.push_back(a.column[k]);
      }
    }
  }
  return part;
}

}  // namespace

Equations::Equations(const Surface& s) {
  const auto n = static_cast<std::int64_t>(s.points.size());
  std::vector<linear::Entry> entries;
  entries.reserve(s.points.size() + 6 * s.faces.size());
  for (std::int64_t i = 0; i < n; ++i) entries.push_back({i, i, 0.0});
  for (const Triangle& f : s.faces) {
    if (namesPointTwice(f)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      entries.push_back({f[k], f[(k + 1) % 3], 0.0});
      entries.push_back({f[(k + 1) % 3], f[k], 0.0});
    }
  }
  laplacian_ = linear::assemble(n, n, entries);
  matrix_ = laplacian_;
  part_ = partsOf(laplacian_);

  for (std::int32_t i = 0; i < n; ++i) diagonal_.push_back(entryAt(laplacian_, i, i));
  edges_.resize(s.faces.size());
  for (std::size_t f = 0; f < s.faces.size(); ++f) {
    if (namesPointTwice(s.faces[f])) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t i = s.faces[f][(k + 1) % 3], j = s.faces[f][(k + 2) % 3];
      edges_[f][k] = {entryAt(laplacian_, i, j), entryAt(laplacian_, j, i)};
    }
  }
}

void Equations::update(const Surface& s, const Faults& faults, double timeStep, bool fixesBoundary) {
  std::vector<bool>& stays = stays_;
  stays.assign(s.points.size(), false);
  if (fixesBoundary) stays = faults.boundary;
  for (const std::int32_t i : faults.isolated) stays[static_cast<std::size_t>(i)] = true;

  std::vector<double>& mass = mass_;
  mass.assign(s.points.size(), 0.0);
  double total = 0.0;
  leastEigenvalue_ = 1.0;
  largestMass_ = 0.0;
  std::ranges::fill(laplacian_.value, 0.0);
  // A triangle of length l and height h adds up to dt l / h to entries, whose roundings take u dt l / h from an eigenvalue, and l h / 6
  // to masses, which give it that. With the least height sqrt(1.5 u dt), and more with four times as much, the sum is positive.
  const double leastHeight = 4.0 * std::sqrt(0x1p-53 * timeStep);
  constexpr double flattest = 0x1p-12;  // heights that may be changed, over the length
  auto degenerate = faults.degenerate.begin();
  for (std::size_t f = 0; f < s.faces.size(); ++f) {
    if (degenerate != faults.degenerate.end() && *degenerate == static_cast<std::int64_t>(f)) {
      ++degenerate;
      continue;
    }
    const Triangle& face = s.faces[f];
    const auto point = [&](std::size_t k) { return s.points[static_cast<std::size_t>(face[k % 3])]; };
    const double longest =
        std::max({length(point(1) - point(0)), length(point(2) - point(1)), length(point(0) - point(2))});
    const double twiceArea = std::max(length(cross(point(1) - point(0), point(2) - point(0))),
                                      longest * std::min(leastHeight, flattest * longest));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(face[(k + 1) % 3]),
                 j = static_cast<std::size_t>(face[(k + 2) % 3]);
      mass[i] += twiceArea / 6.0;
      // Half the cotangent of the angle at corner k, of which the edge from i to j is opposite.
      const double weight =
          0.5 * timeStep * dot(point(k + 1) - point(k), point(k + 2) - point(k)) / twiceArea;
      for (const std::size_t entry : edges_[f][k]) laplacian_.value[entry] -= weight;
      for (const std::size_t p : {i, j}) laplacian_.value[diagonal_[p]] += weight;
    }
    total += 0.5 * twiceArea;
  }
  // 1 where no triangle is left.
  const double mean = total > 0.0 ? total / static_cast<double>(s.points.size()) : 1.0;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    for (auto k = static_cast<std::size_t>(laplacian_.starts[i]);
         k < static_cast<std::size_t>(laplacian_.starts[i + 1]); ++k) {
      if (stays[i]) laplacian_.value[k] = 0.0;
      // The change of a point that stays is 0.
      const bool isKnown = stays[static_cast<std::size_t>(laplacian_.column[k])];
      matrix_.value[k] = isKnown ? 0.0 : laplacian_.value[k];
    }
    matrix_.value[diagonal_[i]] += stays[i] ? mean : mass[i];
    if (stays[i]) continue;
    const double part = mass[i] / matrix_.value[diagonal_[i]];
    leastEigenvalue_ = std::min(leastEigenvalue_, part);
    largestMass_ = std::max(largestMass_, part);
  }
}

void Equations::keepCentres(std::span<double> change) const {
  struct Centre {
    double mass = 0.0, moved = 0.0;
    bool isHeld = false;
  };
  std::vector<Centre> centres(change.size());
  for (std::size_t i = 0; i < change.size(); ++i) {
    Centre& c = centres[static_cast<std::size_t>(part_[i])];
    c.mass += mass_[i];
    c.moved += mass_[i] * change[i];
    c.isHeld = c.isHeld || stays_[i];
  }
  for (std::size_t i = 0; i < change.size(); ++i) {
    const Centre& c = centres[static_cast<std::size_t>(part_[i])];
    if (!c.isHeld && c.mass > 0.0) change[i] -= c.moved / c.mass;
  }
}

}  // namespace smooth
