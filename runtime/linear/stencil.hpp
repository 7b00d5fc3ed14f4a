// SPDX-License-Identifier: MIT
//
// Operators on grids whose coefficients are the same everywhere: a matrix that nobody stores.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <sk/sparse_matrix.hpp>

#include "matrix.hpp"
#include "sparse.hpp"

namespace sk::linear {

/// Twice the length of dimension d, in spacings: an end is one spacing from the outermost element, or half of one where it is not Dirichlet.
std::int64_t doubleLength(const Stencil& a, std::size_t d, std::int64_t extent);
/// Whether all elements are 0 beyond the ends.
bool isDirichlet(const Stencil& a);
/// Whether A 1 = 0, but for roundings: a Laplacian whose ends are all Neumann or periodic.
bool hasConstantKernel(const Stencil& a);

/// The ends as kernels take them (ends.sk), from the fastest dimension to the slowest.
struct KernelEnds {
  sk::float4 low, high;
};
KernelEnds kernelEnds(const Stencil& a);

/// Coefficients as kernels take them: of an element, and of its neighbours in the fastest, the next and the slowest dimension.
sk::float4 kernelCoefficients(const Stencil& a);

/// Calls visit(element, neighbour, d) for both neighbours of every element in each dimension d: an element at a Neumann end is its own neighbour, and nothing is
/// beyond a Dirichlet end.
template <class Visit>
void visitNeighbours(const Stencil& a, Visit&& visit) {
  std::int64_t below = a.grid.size();
  for (std::size_t d = 0; d < static_cast<std::size_t>(a.grid.rank()); ++d) {
    const std::int64_t extent = a.grid[static_cast<int>(d)];
    if (extent == 0) return;
    const std::int64_t block = below;
    below /= extent;
    const std::int64_t last = block - below;
    for (std::int64_t first = 0; first < a.grid.size(); first += block) {
      for (std::int64_t i = first + below; i < first + block; ++i) visit(i, i - below, d);
      for (std::int64_t i = first; i < first + last; ++i) visit(i, i + below, d);
      for (std::int64_t i = first; i < first + below; ++i) {
        if (a.ends[d].low == Side::Neumann) visit(i, i, d);
        if (a.ends[d].low == Side::Periodic) visit(i, i + last, d);
        if (a.ends[d].high == Side::Neumann) visit(i + last, i + last, d);
        if (a.ends[d].high == Side::Periodic) visit(i + last, i, d);
      }
    }
  }
}

std::unique_ptr<Matrix> makeMatrix(const Stencil& a, const Arithmetic& arithmetic);
/// For vectors in a space of the grid's shape, which may be divided over ranks.
std::unique_ptr<Matrix> makeMatrix(const Space& space, const Stencil& a, const Arithmetic& arithmetic);

}  // namespace sk::linear
