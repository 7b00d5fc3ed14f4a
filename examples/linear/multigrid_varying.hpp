// SPDX-License-Identifier: MIT
//
// Geometric multigrid for matrices whose coefficients differ, and jump, from element to element: as a preconditioner, one cycle.
#pragma once

#include <memory>

#include <sk/sk.hpp>

#include "cycles.hpp"
#include "varying.hpp"

namespace linear {

/// The coarse grids of galerkin.hpp. `a` is the matrix as the device has it, and symmetric. A sweep is two of Jacobi's iterations, whose factors are
/// those of Chebyshev's polynomial for the upper part of the spectrum. Elements whose rows are 0 stay 0.
std::unique_ptr<Hierarchy> makeHierarchy(const Space& space, const VaryingStencil& a,
                                         const Arithmetic& arithmetic);
inline std::unique_ptr<Hierarchy> makeHierarchy(sk::Device& device, const VaryingStencil& a,
                                                const Arithmetic& arithmetic) {
  return makeHierarchy(Space(device, a.grid), a, arithmetic);
}

/// One cycle for z = A^-1 r, from z = 0, on these grids.
std::unique_ptr<Preconditioner> makeMultigrid(const Space& space, const VaryingStencil& a,
                                              const Arithmetic& arithmetic,
                                              const MultigridSettings& settings);
inline std::unique_ptr<Preconditioner> makeMultigrid(sk::Device& device, const VaryingStencil& a,
                                                     const Arithmetic& arithmetic,
                                                     const MultigridSettings& settings) {
  return makeMultigrid(Space(device, a.grid), a, arithmetic, settings);
}

}  // namespace linear
