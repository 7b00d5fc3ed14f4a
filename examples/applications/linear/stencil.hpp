// SPDX-License-Identifier: MIT
//
// Operators on grids whose coefficients are the same everywhere: a matrix that nobody stores.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "matrix.hpp"
#include "sparse.hpp"

namespace linear {

/// What lies beyond an end of a grid.
enum class Side {
  Dirichlet,  ///< 0, one spacing from the outermost elements
  Neumann,  ///< the mirror image of the outermost elements, half a spacing from the end: no flux
  Periodic,  ///< the elements at the other end
};

/// The two ends of a dimension, of which both are periodic or none.
struct Ends {
  Side low = Side::Dirichlet, high = Side::Dirichlet;
  bool operator==(const Ends&) const = default;
};

/// (A x) at an element is centre times x there, plus along[d] times the sum of its two neighbours in dimension d, 0 being the slowest. `ends`
/// says what neighbours outside of the grid are. The grid has two or three dimensions.
struct Stencil {
  sk::Shape grid;
  double centre = 0.0;
  std::array<double, 3> along{};
  std::array<Ends, 3> ends{};

  std::int64_t size() const { return grid.size(); }
};

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

/// Minus the Laplacian times the square of the grid's spacing: 2 rank in the centre, -1 beside it.
Stencil poisson(const sk::Shape& grid);
/// The same with a diffusivity for each dimension, 0 being the slowest. Throws std::runtime_error unless as many as the grid has dimensions are
/// finite and above 0.
Stencil poisson(const sk::Shape& grid, std::span<const double> diffusivity);

/// The stencil with other ends, one pair for each dimension, 0 being the slowest. Throws std::runtime_error if their number is another, or one end of
/// a dimension is periodic and the other is not.
Stencil withEnds(Stencil a, std::span<const Ends> ends);

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

std::vector<double> multiply(const Stencil& a, std::span<const double> x);
SparseMatrix assemble(const Stencil& a);
std::unique_ptr<Matrix> makeMatrix(const Stencil& a, const Arithmetic& arithmetic);
/// For vectors in a space of the grid's shape, which may be divided over ranks.
std::unique_ptr<Matrix> makeMatrix(const Space& space, const Stencil& a, const Arithmetic& arithmetic);

}  // namespace linear
