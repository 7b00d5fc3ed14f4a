// SPDX-License-Identifier: MIT
//
// Geometric multigrid as a preconditioner, which is one cycle: for stencils with the same coefficients everywhere, and for others.
#pragma once

#include <memory>

#include <sk/sk.hpp>

#include "cycles.hpp"
#include "stencil.hpp"
#include "varying.hpp"

namespace sk::linear {

/// Grids whose stencils are discretised anew, coarser by coarser, for a matrix as the device has it. Solutions can be interpolated if `isNested`, cubically.
std::unique_ptr<Hierarchy> makeHierarchy(const Space& space, const Stencil& a, const Arithmetic& arithmetic,
                                         bool isNested);
inline std::unique_ptr<Hierarchy> makeHierarchy(sk::Device& device, const Stencil& a,
                                                const Arithmetic& arithmetic, bool isNested) {
  return makeHierarchy(Space(device, a.grid), a, arithmetic, isNested);
}

/// One cycle for z = A^-1 r, from z = 0, on these grids. Throws sk::Error if its centre is 0, or
/// an extent is 2^15 or more.
std::unique_ptr<Preconditioner> makeMultigrid(const Space& space, const Stencil& a,
                                              const Arithmetic& arithmetic,
                                              const MultigridSettings& settings);
inline std::unique_ptr<Preconditioner> makeMultigrid(sk::Device& device, const Stencil& a,
                                                     const Arithmetic& arithmetic,
                                                     const MultigridSettings& settings) {
  return makeMultigrid(Space(device, a.grid), a, arithmetic, settings);
}

/// The stencil for a grid with half the elements along each dimension that has more than three, and whose coefficient is at least a quarter of
/// the largest of these (semi-coarsening; Trottenberg et al., section 5.1): coefficients go with the square of the distance between elements.
Stencil coarsened(const Stencil& a);

/// The same for coefficients that differ, and jump, from element to element (multigrid_varying.cpp), on the coarse grids of galerkin.hpp. `a` is the matrix as the device has it, and symmetric. A sweep is two of Jacobi's iterations, whose factors are
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

}  // namespace sk::linear
