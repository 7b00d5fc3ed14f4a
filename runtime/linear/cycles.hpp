// SPDX-License-Identifier: MIT
//
// Cycles over a hierarchy of grids, whatever the equations on them and the transfers between them (U. Trottenberg, C. Oosterlee and
// A. Schueller, "Multigrid", 2001).
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <sk/sk.hpp>

#include "preconditioner.hpp"

namespace sk::linear {

enum class Cycle {
  V,
  W,
  F,
  Full,  ///< nested iteration from the coarsest grid up, with one F-cycle on each
};

struct MultigridSettings {
  Cycle cycle = Cycle::V;
  int before = 1;  ///< sweeps before the coarse grid's correction
  int after = 1;  ///< after it
  /// The sweeps after it reverse those before it: with as many of both, V-cycles are symmetric, as conjugate gradients need them. They converge
  /// a little more slowly.
  bool isSymmetric = true;
};

/// Extents up to this one are not halved.
inline constexpr std::int64_t smallestExtent = 3;
/// Dimensions are halved whose coefficient is at least this part of the largest: point smoothing leaves errors along weaker couplings.
inline constexpr double strongCoupling = 0.25;
/// The shape with these extents, two or three.
sk::Shape shapeOf(std::span<const std::int64_t> extents);

/// Parts of grids are at least as thick in the dimensions that are divided: transfers between grids read a few elements beyond them.
inline constexpr std::int64_t thinnestPart = 8;
/// Where the vectors of a grid are, if those of another one, which may be itself, are in `other`: divided alike, or on every rank if parts would be too thin.
Space spaceFor(const sk::Shape& grid, const Space& other);

/// Grids, 0 being the finest, their matrices, and the transfers between neighbours. Vectors have the shape of their grid. Grids may be divided over ranks, but none whose finer
/// neighbour is not: restrictions from a divided grid write a divided vector in any case.
class Hierarchy {
 public:
  virtual ~Hierarchy() = default;

  virtual std::size_t size() const = 0;
  /// Where the vectors of a grid are.
  virtual Space space(std::size_t at) const = 0;
  sk::Shape grid(std::size_t at) const { return space(at).shape(); }
  /// Whether constants are in the kernel of every matrix.
  virtual bool hasConstantKernel() const = 0;

  /// Relaxes A u = b. What u holds before does not count if `isZero`: it is 0 then.
  virtual void smooth(std::size_t at, const Vector& b, Vector& u, int sweeps, bool isReversed,
                      bool isZero) = 0;
  /// r = b - A u
  virtual void residual(std::size_t at, const Vector& b, const Vector& u, Vector& r) = 0;
  /// From grid `at` to the next coarser one: the transpose of the interpolation, but for a factor.
  virtual void restrictTo(std::size_t at, const Vector& fine, Vector& coarse) = 0;
  /// The right-hand side of the next coarser grid's own equations, for that of grid `at`.
  virtual void restrictLoad(std::size_t at, const Vector& fine, Vector& coarse) = 0;
  /// u += the interpolation, to grid `at`, of the next coarser grid's correction.
  virtual void correct(std::size_t at, const Vector& coarse, Vector& u) = 0;
  /// u = the interpolation, to grid `at`, of the next coarser grid's solution: of a higher order than that of corrections where there is one.
  virtual void interpolate(std::size_t at, const Vector& coarse, Vector& u) = 0;
  /// u = A^-1 b on the coarsest grid.
  virtual void solveCoarsest(const Vector& b, Vector& u) = 0;
};

/// One cycle for z = A^-1 r, from z = 0.
std::unique_ptr<Preconditioner> makeCycles(std::unique_ptr<Hierarchy> hierarchy, const Arithmetic& arithmetic,
                                           const MultigridSettings& settings);

}  // namespace sk::linear
