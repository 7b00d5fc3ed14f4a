// SPDX-License-Identifier: MIT
#include "cycles.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "residual.sk.hpp"
#include "vectors.sk.hpp"

namespace sk::linear {

namespace {

std::vector<double> noise(std::int64_t n) {
  std::minstd_rand random(1);
  std::vector<double> v(static_cast<std::size_t>(n));
  for (double& x : v) x = std::uniform_real_distribution<double>(-1.0, 1.0)(random);
  return v;
}

void removeMean(Vector& u) {
  std::vector<double> v = u.readReals();
  double sum = 0.0;
  for (const double x : v) sum += x;
  for (double& x : v) x -= sum / static_cast<double>(v.size());
  u.writeReals(v);
}

class Cycles : public Preconditioner {
 public:
  Cycles(std::unique_ptr<Hierarchy> hierarchy, const Arithmetic& arithmetic,
         const MultigridSettings& settings)
      : hierarchy_(std::move(hierarchy)),
        arithmetic_(arithmetic),
        options_(arithmetic.options()),
        foldOptions_(arithmetic.foldOptions()),
        settings_(settings) {
    for (std::size_t at = 0; at < hierarchy_->size(); ++at)
      levels_.push_back({vector(at), vector(at), vector(at), {}});
    for (std::size_t at = 1; at < levels_.size(); ++at) {
      if (levels_[at - 1].u.isDivided() && !levels_[at].u.isDivided())
        levels_[at].divided =
            hierarchy_->space(at - 1).resized(hierarchy_->grid(at)).stream<float>(arithmetic_.vectors);
    }
  }

  void apply(const Vector& r, Vector& z, Vector& rz) override {
    Level& finest = levels_[0];
    if (r.isDivided() && !finest.u.isDivided()) {
      r.copyTo(finest.b);
      begin(0, finest.b, finest.u);
      finest.u.copyTo(z);
    } else {
      begin(0, r, z);
    }
    dot.with(foldOptions_)(r, z, rz);
  }

  std::vector<LevelRate> rates() override {
    std::vector<LevelRate> rates;
    for (std::size_t at = 0; at < hierarchy_->size(); ++at)
      rates.push_back({hierarchy_->grid(at), rateOf(at)});
    return rates;
  }

 private:
  struct Level {
    Vector u, b, r;
    Vector divided;  ///< what is restricted to it, if the finer grid is divided and this one is not
  };

  Vector vector(std::size_t at) const { return hierarchy_->space(at).stream<float>(arithmetic_.vectors); }

  bool isCoarsest(std::size_t at) const { return at + 1 == hierarchy_->size(); }

  void begin(std::size_t at, const Vector& b, Vector& u) {
    if (settings_.cycle == Cycle::Full)
      nest(at, b, u);
    else
      cycle(at, b, u, settings_.cycle, true);
  }

  /// One cycle for u; what u holds does not count if `isZero`.
  void cycle(std::size_t at, const Vector& b, Vector& u, Cycle kind, bool isZero) {
    if (isCoarsest(at)) return hierarchy_->solveCoarsest(b, u);
    smooth(at, b, u, settings_.before, false, isZero);
    Level& coarse = levels_[at + 1];
    hierarchy_->residual(at, b, u, levels_[at].r);
    hierarchy_->restrictTo(at, levels_[at].r, coarse.divided ? coarse.divided : coarse.b);
    if (coarse.divided) coarse.divided.copyTo(coarse.b);
    cycle(at + 1, coarse.b, coarse.u, kind, true);
    if (kind == Cycle::W) cycle(at + 1, coarse.b, coarse.u, Cycle::W, false);
    if (kind == Cycle::F) cycle(at + 1, coarse.b, coarse.u, Cycle::V, false);
    hierarchy_->correct(at, coarse.u, u);
    smooth(at, b, u, settings_.after, settings_.isSymmetric, false);
  }

  /// Interpolates the solution for the coarser grid, and lets an F-cycle follow: V-cycles leave too much of smooth errors in space, where they cost nearly as much.
  void nest(std::size_t at, const Vector& b, Vector& u) {
    if (isCoarsest(at)) return hierarchy_->solveCoarsest(b, u);
    Level& coarse = levels_[at + 1];
    hierarchy_->restrictLoad(at, b, coarse.divided ? coarse.divided : coarse.b);
    if (coarse.divided) coarse.divided.copyTo(coarse.b);
    // A cycle on this grid overwrites the right-hand sides of the coarser ones, which are no longer needed by then.
    nest(at + 1, coarse.b, coarse.u);
    hierarchy_->interpolate(at, coarse.u, u);
    cycle(at, b, u, Cycle::F, false);
  }

  void smooth(std::size_t at, const Vector& b, Vector& u, int sweeps, bool isReversed, bool isZero) {
    if (isZero && sweeps == 0) return u.fill(0.0f);
    if (sweeps > 0) hierarchy_->smooth(at, b, u, sweeps, isReversed, isZero);
  }

  /// For A u = 0, whose solution has no rounding errors that would end the decrease, from random numbers.
  double rateOf(std::size_t at) {
    constexpr int cycles = 10, settled = 4;
    Vector u = vector(at), zero = vector(at), r = vector(at), z = vector(at);
    Vector squares = hierarchy_->space(at).device().stream<float>({1}, arithmetic_.sums());
    u.writeReals(noise(u.size()));
    zero.fill(0.0f);
    std::vector<double> norms;
    double scale = 1.0;
    while (true) {
      // Sweeps change the mean, whose rounding errors would soon exceed the residual.
      if (hierarchy_->hasConstantKernel()) removeMean(u);
      hierarchy_->residual(at, zero, u, r);
      dot.with(foldOptions_)(r, r, squares);
      const double norm = std::sqrt(squares.readReals()[0]);
      norms.push_back(norm / scale);
      if (!(norm > 0.0) || !std::isfinite(norm) || norms.size() > cycles) break;
      begin(at, r, z);
      axpy.with(options_)(1.0f, z, u, u);
      // The numbers stay within the range of floats, and of halves.
      const int exponent = -std::ilogb(norm);
      scaleTo.with(options_)(std::ldexp(1.0f, exponent), u, u);
      scale = std::ldexp(scale, exponent);
    }
    const std::size_t last = norms.size() - 1, first = last > settled ? last - settled : 0;
    if (last == 0 || !(norms[last] > 0.0)) return 0.0;
    return std::pow(norms[last] / norms[first], 1.0 / static_cast<double>(last - first));
  }

  std::unique_ptr<Hierarchy> hierarchy_;
  Arithmetic arithmetic_;
  sk::CallOptions options_, foldOptions_;
  MultigridSettings settings_;
  std::vector<Level> levels_;
};

}  // namespace

sk::Shape shapeOf(std::span<const std::int64_t> extents) {
  if (extents.size() == 2) return {extents[0], extents[1]};
  return {extents[0], extents[1], extents[2]};
}

Space spaceFor(const sk::Shape& grid, const Space& other) {
  const Space space = other.resized(grid);
  return space.isDivided() && space.thinnest() < thinnestPart ? space.undivided() : space;
}

std::unique_ptr<Preconditioner> makeCycles(std::unique_ptr<Hierarchy> hierarchy, const Arithmetic& arithmetic,
                                           const MultigridSettings& settings) {
  return std::make_unique<Cycles>(std::move(hierarchy), arithmetic, settings);
}

}  // namespace sk::linear
