// SPDX-License-Identifier: MIT
//
// Operators on grids whose coefficients are the same everywhere: a matrix that nobody stores.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "matrix.hpp"
#include "sparse.hpp"

namespace linear {

/// (A x) at an element is centre times x there, plus along[d] times the sum of its two neighbours in dimension d, 0 being the slowest. Elements
/// outside of the grid are 0 (Dirichlet). The grid has two or three dimensions.
struct Stencil {
  sk::Shape grid;
  double centre = 0.0;
  std::array<double, 3> along{};

  std::int64_t size() const { return grid.size(); }
};

/// Coefficients as kernels take them: of an element, and of its neighbours in the fastest, the next and the slowest dimension.
sk::float4 kernelCoefficients(const Stencil& a);

/// Minus the Laplacian times the square of the grid's spacing: 2 rank in the centre, -1 beside it.
Stencil poisson(const sk::Shape& grid);
/// The same with a diffusivity for each dimension, 0 being the slowest. Throws std::runtime_error unless as many as the grid has dimensions are
/// finite and above 0.
Stencil poisson(const sk::Shape& grid, std::span<const double> diffusivity);

std::vector<double> multiply(const Stencil& a, std::span<const double> x);
SparseMatrix assemble(const Stencil& a);
std::unique_ptr<Matrix> makeMatrix(const Stencil& a, const Arithmetic& arithmetic);

}  // namespace linear
