// SPDX-License-Identifier: MIT
#include "multigrid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "multigrid.sk.hpp"

namespace sk::linear {

namespace {

/// The inverse of a small matrix, row by row, by Gauss-Jordan elimination with row pivots. For a matrix whose kernel are the constants, the pseudo-inverse:
/// (A + J)^-1 - J with J = 1 1^T / n, which removes the mean of what it is applied to. So only this grid projects: the transfers between grids keep sums.
std::vector<double> inverseOf(const Stencil& a) {
  const auto n = static_cast<std::size_t>(a.size());
  const double shift = hasConstantKernel(a) ? a.centre / static_cast<double>(n) : 0.0;
  std::vector<double> m(n * n, shift), inverse(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    m[i * n + i] += a.centre;
    inverse[i * n + i] = 1.0;
  }
  visitNeighbours(a, [&](std::int64_t i, std::int64_t j, std::size_t d) {
    m[static_cast<std::size_t>(i) * n + static_cast<std::size_t>(j)] += a.along[d];
  });
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(m[i * n + k]) > std::abs(m[pivot * n + k])) pivot = i;
    if (std::abs(m[pivot * n + k]) <= 0x1p-44 * std::abs(a.centre))
      throw sk::Error("multigrid's coarsest grid has a singular matrix; take another preconditioner");
    for (std::size_t j = 0; j < n; ++j) {
      std::swap(m[k * n + j], m[pivot * n + j]);
      std::swap(inverse[k * n + j], inverse[pivot * n + j]);
    }
    const double divisor = m[k * n + k];
    for (std::size_t j = 0; j < n; ++j) {
      m[k * n + j] /= divisor;
      inverse[k * n + j] /= divisor;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double factor = m[i * n + k];
      if (i == k || factor == 0.0) continue;
      for (std::size_t j = 0; j < n; ++j) {
        m[i * n + j] -= factor * m[k * n + j];
        inverse[i * n + j] -= factor * inverse[k * n + j];
      }
    }
  }
  if (shift != 0.0)
    for (double& v : inverse) v -= 1.0 / (shift * static_cast<double>(n * n));
  return inverse;
}

/// A grid of the hierarchy.
struct Level {
  Level(const Space& where, const Stencil& a)
      : space(where),
        stencil(a),
        coefficients(kernelCoefficients(a)),
        low(kernelEnds(a).low),
        high(kernelEnds(a).high) {}

  Space space;
  Stencil stencil;
  sk::float4 coefficients, low, high;
  /// Axes, 0 being the fastest, along which the next grid has fewer elements, and solutions that have been interpolated along some of them.
  std::vector<std::size_t> halved;
  std::vector<Vector> between;
};

std::int64_t extentAlong(const sk::Shape& shape, std::size_t axis) {
  return shape[shape.rank() - 1 - static_cast<int>(axis)];
}

class StencilHierarchy : public Hierarchy {
 public:
  /// `isNested` if solutions are interpolated, too.
  StencilHierarchy(const Space& space, const Stencil& a, const Arithmetic& arithmetic, bool isNested)
      : options_(arithmetic.options()) {
    levels_.emplace_back(spaceFor(a.grid, space), a);
    while (true) {
      const Stencil coarse = coarsened(levels_.back().stencil);
      if (coarse.grid == levels_.back().stencil.grid) break;
      if (isNested) prepareInterpolation(levels_.back(), coarse.grid, arithmetic.vectors);
      levels_.emplace_back(spaceFor(coarse.grid, levels_.back().space), coarse);
    }
    const Stencil& coarsest = levels_.back().stencil;
    inverse_ = space.device().stream<float>({coarsest.size(), coarsest.size()}, arithmetic.vectors);
    inverse_.writeReals(inverseOf(coarsest));
  }

  std::size_t size() const override { return levels_.size(); }
  Space space(std::size_t at) const override { return levels_[at].space; }
  bool hasConstantKernel() const override { return linear::hasConstantKernel(levels_[0].stencil); }

  /// Red-black sweeps; reversed ones take the colours in the opposite order.
  void smooth(std::size_t at, const Vector& b, Vector& u, int sweeps, bool isReversed, bool isZero) override {
    const Level& level = levels_[at];
    for (int half = 0; half < 2 * sweeps; ++half) {
      const int colour = (half + (isReversed ? 1 : 0)) & 1;
      if (isZero && half == 0)
        relaxZero.with(options_)(colour, level.coefficients, level.low, level.high, b, u);
      else
        relax.with(options_)(colour, level.coefficients, level.low, level.high, u, b, u);
    }
  }

  void residual(std::size_t at, const Vector& b, const Vector& u, Vector& r) override {
    const Level& level = levels_[at];
    linear::residual.with(options_)(level.coefficients, level.low, level.high, u, b, r);
  }

  void restrictTo(std::size_t at, const Vector& fine, Vector& coarse) override {
    const Level& level = levels_[at];
    restrict.with(options_)(level.low, level.high, fine, coarse);
  }

  void restrictLoad(std::size_t at, const Vector& fine, Vector& coarse) override {
    const Level& level = levels_[at];
    loadOfCoarse.with(options_)(level.low, level.high, fine, coarse);
  }

  void correct(std::size_t at, const Vector& coarse, Vector& u) override {
    const Level& level = levels_[at];
    linear::correct.with(options_)(level.low, level.high, coarse, u, u);
  }

  /// Cubic, along one dimension after the other, the fastest first, for the fewest elements.
  void interpolate(std::size_t at, const Vector& coarse, Vector& u) override {
    Level& level = levels_[at];
    const Vector* from = &coarse;
    for (std::size_t i = 0; i < level.halved.size(); ++i) {
      const std::size_t axis = level.halved[i];
      Vector& to = i + 1 == level.halved.size() ? u : level.between[i];
      const auto end = [&](const sk::float4& ends) {
        return axis == 0 ? ends.x : axis == 1 ? ends.y : ends.z;
      };
      const float low = end(level.low), high = end(level.high);
      cubic.with(options_)(static_cast<int>(axis), low, high, *from, to);
      from = &to;
    }
  }

  void solveCoarsest(const Vector& b, Vector& u) override {
    const std::int64_t n = inverse_.shape()[0];
    linear::solveCoarsest.with(options_)(static_cast<int>(n), inverse_, b.reshape({n}), u.reshape({n}));
  }

 private:
  static void prepareInterpolation(Level& fine, const sk::Shape& coarse, sk::Storage storage) {
    const auto rank = static_cast<std::size_t>(coarse.rank());
    std::array<std::int64_t, 3> extents{};
    for (std::size_t d = 0; d < rank; ++d) extents[d] = coarse[static_cast<int>(d)];
    for (std::size_t axis = 0; axis < rank; ++axis) {
      const std::int64_t n = extentAlong(fine.stencil.grid, axis);
      if (extentAlong(coarse, axis) == n) continue;
      fine.halved.push_back(axis);
      extents[rank - 1 - axis] = n;
      const sk::Shape shape = shapeOf(std::span(extents).first(rank));
      if (shape != fine.stencil.grid)
        fine.between.push_back(fine.space.resized(shape).stream<float>(storage));
    }
  }

  std::vector<Level> levels_;
  Vector inverse_;  ///< of the coarsest grid's matrix, which has at most 3 elements along each dimension
  sk::CallOptions options_;
};

}  // namespace

Stencil coarsened(const Stencil& a) {
  Stencil coarse = a;
  std::array<std::int64_t, 3> extents{};
  const auto rank = static_cast<std::size_t>(a.grid.rank());
  double strongest = 0.0;
  for (std::size_t d = 0; d < rank; ++d)
    if (a.grid[static_cast<int>(d)] > smallestExtent) strongest = std::max(strongest, std::abs(a.along[d]));
  for (std::size_t d = 0; d < rank; ++d) {
    const std::int64_t n = a.grid[static_cast<int>(d)];
    // The spacing at most doubles: restriction reads four elements along a dimension.
    const std::int64_t half = a.ends[d] == Ends{} ? n / 2 : (n + 1) / 2;
    extents[d] = n > smallestExtent && std::abs(a.along[d]) >= strongCoupling * strongest ? half : n;
    const double ratio =
        static_cast<double>(doubleLength(a, d, extents[d])) / static_cast<double>(doubleLength(a, d, n));
    coarse.along[d] = a.along[d] * ratio * ratio;
    coarse.centre += 2.0 * (a.along[d] - coarse.along[d]);
  }
  coarse.grid = shapeOf(std::span(extents).first(rank));
  return coarse;
}

std::unique_ptr<Hierarchy> makeHierarchy(const Space& space, const Stencil& a, const Arithmetic& arithmetic,
                                         bool isNested) {
  if (a.centre == 0.0) throw sk::Error("multigrid divides by the stencil's centre, which is 0");
  for (int d = 0; d < a.grid.rank(); ++d)
    if (a.grid[d] > 0x7fff)
      throw sk::Error(
          fmt::format("multigrid takes grids of up to 32767 elements along a dimension, not {}", a.grid[d]));
  return std::make_unique<StencilHierarchy>(space, a, arithmetic, isNested);
}

std::unique_ptr<Preconditioner> makeMultigrid(const Space& space, const Stencil& a,
                                              const Arithmetic& arithmetic,
                                              const MultigridSettings& settings) {
  return makeCycles(makeHierarchy(space, a, arithmetic, settings.cycle == Cycle::Full), arithmetic, settings);
}

}  // namespace sk::linear
