// SPDX-License-Identifier: MIT
//
// Geometric multigrid for stencils (U. Trottenberg, C. Oosterlee and A. Schueller, "Multigrid", 2001): as a preconditioner, one cycle.
#pragma once

#include <memory>
#include <vector>

#include <sk/sk.hpp>

#include "preconditioner.hpp"
#include "stencil.hpp"

namespace linear {

enum class Cycle {
  V,
  W,
  F,
  Full,  ///< nested iteration from the coarsest grid up, with one V-cycle on each
};

struct MultigridSettings {
  Cycle cycle = Cycle::V;
  int before = 1;  ///< red-black sweeps before the coarse grid's correction
  int after = 1;  ///< after it
  /// The sweeps after it take the colours in the opposite order: with as many sweeps as before, V-cycles are symmetric, as
  /// conjugate gradients need them. They converge a little more slowly.
  bool isSymmetric = true;
};

/// One cycle for z = A^-1 r, from z = 0. `a` is the matrix as the device has it. Throws std::runtime_error if its centre is 0, or
/// an extent is 2^15 or more.
std::unique_ptr<Preconditioner> makeMultigrid(sk::Device& device, const Stencil& a,
                                              const Arithmetic& arithmetic,
                                              const MultigridSettings& settings);

/// The stencil for a grid with half the elements along each dimension that has more than three, and whose coefficient is at least a quarter of
/// the largest of these (semi-coarsening; Trottenberg et al., section 5.1): coefficients go with the square of the distance between elements.
Stencil coarsened(const Stencil& a);

}  // namespace linear
