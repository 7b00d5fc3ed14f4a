// SPDX-License-Identifier: MIT
//
// Poisson's equation to the fourth order with direct neighbours alone: Mehrstellenverfahren (L. Collatz, "The numerical treatment of differential equations", 1960), with 9 entries for an
// element on planes and 19 in space, and solutions that are known.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "stencil.hpp"
#include "varying.hpp"

namespace sk::linear {

/// Minus the Laplacian times the square of the spacing. The stencil gives the grid and its ends. Throws sk::Error if its diffusivities differ.
VaryingStencil compactPoisson(const Stencil& grid);

/// f at a position in elements of the grid, which may be one element outside.
using GridFunction = std::function<double(const GridOffset& position)>;
/// What is right of it: h^2 (f + h^2 / 12 times the Laplacian of f by differences), for each element. f beyond a Neumann end should be its mirror image.
std::vector<double> compactLoad(const Stencil& grid, double h, const GridFunction& f);

/// A solution of -Laplacian u = f on the unit square or cube, 0 at its borders, whose derivatives are not: the product of exp(x) sin(pi x), sin(2 pi y) and exp(-z) sin(pi z).
struct KnownSolution {
  Stencil grid;  ///< of n elements along each dimension
  double h = 0.0;

  KnownSolution(int rank, std::int64_t n);
  double solution(const GridOffset& position) const;
  double load(const GridOffset& position) const;
  /// The right-hand side of poisson(grid).
  std::vector<double> secondOrder() const;
  /// The right-hand side of compactPoisson(grid).
  std::vector<double> fourthOrder() const;
  /// The largest error of x.
  double errorOf(std::span<const double> x) const;
};

}  // namespace sk::linear
