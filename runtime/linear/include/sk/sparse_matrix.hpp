// SPDX-License-Identifier: MIT
//
// Sparse matrices in host memory and in double precision: compressed rows, files in the Matrix Market format, and matrices of grids that
// nobody stores. sk/linear.hpp solves systems of equations with them. This header knows no device.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include <sk/shape.hpp>

namespace sk::linear {

/// An entry of a matrix, counted from 0.
struct Entry {
  std::int64_t row = 0;
  std::int64_t column = 0;
  double value = 0.0;
};

/// Row i has the entries starts[i] to starts[i + 1] - 1, in ascending order of their columns, no column twice. Entries may be 0.
struct SparseMatrix {
  std::int64_t rows = 0;
  std::int64_t columns = 0;
  std::vector<std::int64_t> starts{0};  ///< rows + 1
  std::vector<std::int32_t> column;  ///< of each entry
  std::vector<double> value;

  std::int64_t entries() const { return static_cast<std::int64_t>(value.size()); }
  std::int64_t length(std::int64_t row) const {
    return starts[static_cast<std::size_t>(row) + 1] - starts[static_cast<std::size_t>(row)];
  }
};

/// Sorts entries into rows. Entries of one place are added up; `duplicates` counts those that were added to another one. Throws
/// sk::Error if an entry is outside of the matrix, or if an extent is negative or 2^31 or more.
SparseMatrix assemble(std::int64_t rows, std::int64_t columns, std::span<const Entry> entries,
                      std::int64_t* duplicates = nullptr);

/// y = A x. The sums are those of double precision, in the order of the columns. Throws sk::Error if x has another size than a row.
std::vector<double> multiply(const SparseMatrix& a, std::span<const double> x);
SparseMatrix transpose(const SparseMatrix& a);

// ---- files --------------------------------------------------------------------------------------------------

/// Reads a file in the Matrix Market format (R. Boisvert, R. Pozo and K. Remington, "The Matrix Market exchange formats", NIST 1996):
/// coordinate or array; real, integer or pattern; general, symmetric or skew-symmetric. An array is stored like the others, without its zeros.
/// `duplicates` counts entries that the file has several times, which are added up. Throws sk::Error, "FILE:LINE:COLUMN: what is wrong", for a
/// file that is missing, has another format, has entries that are outside, not finite, missing or too many, is complex, or does not fit in memory.
SparseMatrix readMatrixMarket(const std::filesystem::path& file, std::int64_t* duplicates = nullptr);
/// Reads a vector: a matrix of one column, or of one row. Throws sk::Error as readMatrixMarket does, or if it is neither.
std::vector<double> readMatrixMarketVector(const std::filesystem::path& file);
/// Writes the entries of a matrix, with all digits, and the folder that they go to. Throws sk::Error if the file cannot be written.
void writeMatrixMarket(const std::filesystem::path& file, const SparseMatrix& a);
/// Writes a vector as an array of one column, likewise.
void writeMatrixMarketVector(const std::filesystem::path& file, std::span<const double> values);

// ---- grids --------------------------------------------------------------------------------------------------

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

/// A matrix whose coefficients are the same everywhere on a grid. (A x) at an element is centre times x there, plus along[d] times the sum of its two
/// neighbours in dimension d, 0 being the slowest. `ends` says what neighbours outside of the grid are. The grid has two or three dimensions.
struct Stencil {
  sk::Shape grid;
  double centre = 0.0;
  std::array<double, 3> along{};
  std::array<Ends, 3> ends{};

  std::int64_t size() const { return grid.size(); }
};

/// Minus the Laplacian times the square of the grid's spacing: 2 rank in the centre, -1 beside it. Throws sk::Error unless the grid has two or three dimensions.
Stencil poisson(const sk::Shape& grid);
/// The same with a diffusivity for each dimension, 0 being the slowest. Throws sk::Error unless as many as the grid has dimensions are finite and above 0.
Stencil poisson(const sk::Shape& grid, std::span<const double> diffusivity);
/// The stencil with other ends, one pair for each dimension, 0 being the slowest. Throws sk::Error if their number is another, or one end of a
/// dimension is periodic and the other is not.
Stencil withEnds(Stencil a, std::span<const Ends> ends);

/// A position, or the offset of a neighbour, in elements along each dimension; dimension 0 is the slowest.
using GridOffset = std::array<int, 3>;

/// A matrix on a grid whose coefficients differ from element to element; diffusion() makes one. Row i has the entry value[k * size() + i] for the element at
/// offsets[k] from element i, and 0 where that is outside of the grid. The first offset is the element itself.
struct VaryingStencil {
  sk::Shape grid;
  std::array<bool, 3> isPeriodic{};  ///< whether offsets wrap around, for each dimension
  std::vector<GridOffset> offsets;
  std::vector<double> value;

  std::int64_t size() const { return grid.size(); }
  int count() const { return static_cast<int>(offsets.size()); }
};

/// -div (coefficient grad u) by finite volumes around the elements of a stencil's grid, times the square of the spacing. The flux between two elements takes the harmonic mean of their
/// coefficients, which is exact where the coefficient jumps halfway between them; the flux to a Dirichlet end takes that of the outermost element. The stencil gives the grid, its ends
/// and the diffusivities along its dimensions, by which coefficients are multiplied. Throws sk::Error unless there is a finite coefficient above 0 for each element.
VaryingStencil diffusion(const Stencil& grid, std::span<const double> coefficient);

std::vector<double> multiply(const Stencil& a, std::span<const double> x);
/// The entries of these matrices, written out.
SparseMatrix assemble(const Stencil& a);
SparseMatrix assemble(const VaryingStencil& a);

}  // namespace sk::linear
