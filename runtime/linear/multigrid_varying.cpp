// SPDX-License-Identifier: MIT
#include "multigrid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "galerkin.hpp"
#include "multigrid.sk.hpp"
#include "varying.sk.hpp"

namespace sk::linear {

namespace {

constexpr std::size_t steps = 2;  ///< of Jacobi's iteration in a sweep

/// 1 over the roots of Chebyshev's polynomial on the eigenvalues of D^-1 A from a part of their bound, the largest sum of magnitudes of a row, to this bound. Coarser grids correct errors
/// below. The part is 1 / 4 on planes and 1 / 6 in space: in Poisson's equation, errors that no coarser grid shows have eigenvalues above.
std::array<float, steps> sweepFactors(const VaryingStencil& a) {
  double bound = 1.0;
  for (std::int64_t i = 0; i < a.size(); ++i) {
    const double diagonal = a.value[entryAt(a, 0, i)];
    double sum = 0.0;
    for (std::size_t k = 0; k < a.offsets.size(); ++k) sum += std::abs(a.value[entryAt(a, k, i)]);
    if (diagonal > 0.0) bound = std::max(bound, sum / diagonal);
  }
  const double low = bound / (a.grid.rank() == 2 ? 4.0 : 6.0);
  std::array<float, steps> factors{};
  for (std::size_t k = 0; k < steps; ++k) {
    const double root =
        std::cos(std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(steps));
    factors[k] = static_cast<float>(2.0 / (bound + low + (bound - low) * root));
  }
  return factors;
}

/// As kernels take them, the fastest dimension first.
sk::int4 reversed(const GridOffset& v, int rank) {
  if (rank == 2) return {v[1], v[0], 0, 0};
  return {v[2], v[1], v[0], 0};
}

class VaryingHierarchy : public Hierarchy {
 public:
  VaryingHierarchy(const Space& space, const VaryingStencil& a, const Arithmetic& arithmetic)
      : options_(arithmetic.options()), hasConstantKernel_(linear::hasConstantKernel(a)) {
    // Entries of coarser grids become smaller, and those of jumping coefficients differ by more than halves can.
    const sk::Storage storage =
        arithmetic.matrix == sk::Storage::Half ? sk::Storage::Single : arithmetic.matrix;
    VaryingStencil coarse = a;
    Space where = placeOf(a.grid, space);
    while (true) {
      const Coarsening c = coarsening(coarse);
      levels_.push_back(levelOf(where, coarse, c, storage));
      if (c.coarse == coarse.grid) break;
      coarse = galerkin(coarse, c);
      where = placeOf(coarse.grid, where);
    }
    inverse_ = space.device().stream<float>({coarse.size(), coarse.size()}, storage);
    inverse_.writeReals(symmetricInverse(coarse, hasConstantKernel_));
  }

  std::size_t size() const override { return levels_.size(); }
  Space space(std::size_t at) const override { return levels_[at].space; }
  bool hasConstantKernel() const override { return hasConstantKernel_; }

  void smooth(std::size_t at, const Vector& b, Vector& u, int sweeps, bool isReversed, bool isZero) override {
    const Level& level = levels_[at];
    const std::size_t all = steps * static_cast<std::size_t>(sweeps);
    for (std::size_t k = 0; k < all; ++k) {
      const float omega = level.factors[(isReversed ? all - 1 - k : k) % steps];
      if (isZero && k == 0)
        relaxVaryingZero.with(options_)(level.count, omega, level.entries, b, u);
      else
        relaxVarying.with(options_)(level.count, omega, level.entries, u, b, u);
    }
  }

  void residual(std::size_t at, const Vector& b, const Vector& u, Vector& r) override {
    const Level& level = levels_[at];
    residualVarying.with(options_)(level.count, level.entries, u, b, r);
  }

  void restrictTo(std::size_t at, const Vector& fine, Vector& coarse) override {
    const Level& level = levels_[at];
    restrictVarying.with(options_)(level.share, level.first, level.step, level.weights, fine, coarse);
  }

  /// Galerkin's equations are those of restricted ones.
  void restrictLoad(std::size_t at, const Vector& fine, Vector& coarse) override {
    restrictTo(at, fine, coarse);
  }

  void correct(std::size_t at, const Vector& coarse, Vector& u) override {
    const Level& level = levels_[at];
    correctVarying.with(options_)(level.first, level.step, level.isPeriodic, level.weights, coarse, u, u);
  }

  void interpolate(std::size_t at, const Vector& coarse, Vector& u) override {
    u.fill(0.0f);
    correct(at, coarse, u);
  }

  void solveCoarsest(const Vector& b, Vector& u) override {
    const std::int64_t n = inverse_.shape()[0];
    linear::solveCoarsest.with(options_)(static_cast<int>(n), inverse_, b.reshape({n}), u.reshape({n}));
  }

 private:
  struct Level {
    explicit Level(const Space& where) : space(where) {}

    Space space;
    int count = 0;
    std::array<float, steps> factors{};
    Vector entries;
    Vector weights;  ///< of the interpolation, {3^rank, coarse grid}
    sk::int4 first, step, isPeriodic;
    float share = 1.0f;
  };

  /// The coarsest grid is on every rank.
  static Space placeOf(const sk::Shape& grid, const Space& other) {
    return grid.size() <= solvedDirectly ? Space(other.device(), grid) : spaceFor(grid, other);
  }

  static Level levelOf(const Space& space, const VaryingStencil& a, const Coarsening& c,
                       sk::Storage storage) {
    const int rank = a.grid.rank();
    Level level(space);
    level.count = a.count();
    level.factors = sweepFactors(a);
    level.entries = entriesOf(space, a, storage);
    level.first = reversed(c.first, rank);
    level.step = reversed(c.step, rank);
    level.isPeriodic = reversed({a.isPeriodic[0], a.isPeriodic[1], a.isPeriodic[2]}, rank);
    level.share = 1.0f / static_cast<float>(c.share());
    if (!c.weight.empty()) {
      level.weights =
          placeOf(c.coarse, space).resized(stackOf(rank == 2 ? 9 : 27, c.coarse)).stream<float>(storage);
      level.weights.writeReals(c.weight);
    }
    return level;
  }

  std::vector<Level> levels_;
  Vector inverse_;
  sk::CallOptions options_;
  bool hasConstantKernel_;
};

}  // namespace

std::unique_ptr<Hierarchy> makeHierarchy(const Space& space, const VaryingStencil& a,
                                         const Arithmetic& arithmetic) {
  return std::make_unique<VaryingHierarchy>(space, a, arithmetic);
}

std::unique_ptr<Preconditioner> makeMultigrid(const Space& space, const VaryingStencil& a,
                                              const Arithmetic& arithmetic,
                                              const MultigridSettings& settings) {
  return makeCycles(makeHierarchy(space, a, arithmetic), arithmetic, settings);
}

}  // namespace sk::linear
