// SPDX-License-Identifier: MIT
#include "multigrid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "multigrid.sk.hpp"
#include "vectors.sk.hpp"

namespace linear {

namespace {

constexpr std::int64_t smallest = 3;  ///< extents that are not halved
/// Dimensions are halved whose coefficient is at least this part of the largest: point smoothing leaves errors along weaker couplings.
constexpr double strong = 0.25;
constexpr int sweepsOnCoarsest = 8;  ///< of at most 3 elements along each dimension

sk::Shape shapeOf(std::span<const std::int64_t> extents) {
  if (extents.size() == 2) return {extents[0], extents[1]};
  return {extents[0], extents[1], extents[2]};
}

/// A grid of the hierarchy.
struct Level {
  Level(sk::Device& device, const Stencil& a, const Arithmetic& arithmetic)
      : stencil(a),
        coefficients(kernelCoefficients(a)),
        u(device.stream<float>(a.grid, arithmetic.vectors)),
        b(device.stream<float>(a.grid, arithmetic.vectors)),
        r(device.stream<float>(a.grid, arithmetic.vectors)) {}

  bool isPlane() const { return stencil.grid.rank() == 2; }

  Stencil stencil;
  sk::float4 coefficients;
  Vector u, b, r;
};

class Multigrid : public Preconditioner {
 public:
  Multigrid(sk::Device& device, const Stencil& a, const Arithmetic& arithmetic,
            const MultigridSettings& settings)
      : options_(arithmetic.options()), foldOptions_(arithmetic.foldOptions()), settings_(settings) {
    levels_.emplace_back(device, a, arithmetic);
    while (true) {
      const Stencil coarse = coarsened(levels_.back().stencil);
      if (coarse.grid == levels_.back().stencil.grid) break;
      levels_.emplace_back(device, coarse, arithmetic);
    }
  }

  void apply(const Vector& r, Vector& z, Vector& rz) override {
    if (settings_.cycle == Cycle::Full)
      nest(0, r, z);
    else
      cycle(0, r, z, settings_.cycle, true);
    dot.with(foldOptions_)(r, z, rz);
  }

 private:
  /// One cycle for u; what u holds does not count if `isZero`.
  void cycle(std::size_t at, const Vector& b, Vector& u, Cycle kind, bool isZero) {
    if (at + 1 == levels_.size()) return smooth(at, b, u, sweepsOnCoarsest, 0, isZero);
    smooth(at, b, u, settings_.before, 0, isZero);
    Level& level = levels_[at];
    Level& coarse = levels_[at + 1];
    restrictResidual(level, b, u, coarse.b);
    cycle(at + 1, coarse.b, coarse.u, kind, true);
    if (kind == Cycle::W) cycle(at + 1, coarse.b, coarse.u, Cycle::W, false);
    if (kind == Cycle::F) cycle(at + 1, coarse.b, coarse.u, Cycle::V, false);
    if (level.isPlane())
      correct2.with(options_)(coarse.u, u, u);
    else
      correct3.with(options_)(coarse.u, u, u);
    smooth(at, b, u, settings_.after, settings_.isSymmetric ? 1 : 0, false);
  }

  /// Interpolates the solution for the coarser grid, and lets a V-cycle follow.
  void nest(std::size_t at, const Vector& b, Vector& u) {
    if (at + 1 == levels_.size()) return smooth(at, b, u, sweepsOnCoarsest, 0, true);
    Level& level = levels_[at];
    Level& coarse = levels_[at + 1];
    if (level.isPlane())
      restrict2.with(options_)(b, coarse.b);
    else
      restrict3.with(options_)(b, coarse.b);
    // A cycle on this grid overwrites the right-hand sides of the coarser ones, which are no longer needed by then.
    nest(at + 1, coarse.b, coarse.u);
    if (level.isPlane())
      interpolate2.with(options_)(coarse.u, u);
    else
      interpolate3.with(options_)(coarse.u, u);
    cycle(at, b, u, Cycle::V, false);
  }

  void smooth(std::size_t at, const Vector& b, Vector& u, int sweeps, int firstColour, bool isZero) {
    Level& level = levels_[at];
    if (isZero && sweeps == 0) return u.fill(0.0f);
    for (int half = 0; half < 2 * sweeps; ++half) {
      const int colour = (half + firstColour) & 1;
      if (isZero && half == 0)
        relaxZero.with(options_)(colour, level.coefficients, b, u);
      else if (level.isPlane())
        relax2.with(options_)(colour, level.coefficients, u, b, u);
      else
        relax3.with(options_)(colour, level.coefficients, u, b, u);
    }
  }

  void restrictResidual(Level& level, const Vector& b, const Vector& u, Vector& coarse) {
    if (level.isPlane()) {
      residual2.with(options_)(level.coefficients, u, b, level.r);
      restrict2.with(options_)(level.r, coarse);
    } else {
      residual3.with(options_)(level.coefficients, u, b, level.r);
      restrict3.with(options_)(level.r, coarse);
    }
  }

  std::vector<Level> levels_;
  sk::CallOptions options_, foldOptions_;
  MultigridSettings settings_;
};

}  // namespace

Stencil coarsened(const Stencil& a) {
  Stencil coarse = a;
  std::array<std::int64_t, 3> extents{};
  const auto rank = static_cast<std::size_t>(a.grid.rank());
  double strongest = 0.0;
  for (std::size_t d = 0; d < rank; ++d)
    if (a.grid[static_cast<int>(d)] > smallest) strongest = std::max(strongest, std::abs(a.along[d]));
  for (std::size_t d = 0; d < rank; ++d) {
    const std::int64_t n = a.grid[static_cast<int>(d)];
    extents[d] = n > smallest && std::abs(a.along[d]) >= strong * strongest ? n / 2 : n;
    const double ratio = static_cast<double>(extents[d] + 1) / static_cast<double>(n + 1);
    coarse.along[d] = a.along[d] * ratio * ratio;
    coarse.centre += 2.0 * (a.along[d] - coarse.along[d]);
  }
  coarse.grid = shapeOf(std::span(extents).first(rank));
  return coarse;
}

std::unique_ptr<Preconditioner> makeMultigrid(sk::Device& device, const Stencil& a,
                                              const Arithmetic& arithmetic,
                                              const MultigridSettings& settings) {
  if (a.centre == 0.0) throw std::runtime_error("multigrid divides by the stencil's centre, which is 0");
  for (int d = 0; d < a.grid.rank(); ++d)
    if (a.grid[d] > 0x7fff)
      throw std::runtime_error(
          fmt::format("multigrid takes grids of up to 32767 elements along a dimension, not {}", a.grid[d]));
  return std::make_unique<Multigrid>(device, a, arithmetic, settings);
}

}  // namespace linear
