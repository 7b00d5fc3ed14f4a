// SPDX-License-Identifier: MIT
//
// Matrices on grids whose coefficients differ from element to element.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>
#include <sk/sparse_matrix.hpp>

#include "matrix.hpp"
#include "sparse.hpp"
#include "stencil.hpp"

namespace sk::linear {

/// Where the entry k of row i is, as VaryingStencil stores it.
inline std::size_t entryAt(const VaryingStencil& a, std::size_t k, std::int64_t i) {
  return k * static_cast<std::size_t>(a.size()) + static_cast<std::size_t>(i);
}

/// Which neighbours have entries.
enum class Neighbourhood {
  Sides,  ///< 5 or 7 elements
  Edges,  ///< 9 or 19: also those that differ in two dimensions
  All,  ///< 9 or 27
};
std::vector<GridOffset> neighbourOffsets(int rank, Neighbourhood neighbourhood);

/// Positions in a grid of two or three dimensions.
class GridWalk {
 public:
  explicit GridWalk(const sk::Shape& grid, std::array<bool, 3> isPeriodic = {});

  std::size_t rank() const { return rank_; }
  GridOffset positionOf(std::int64_t element) const;
  std::int64_t elementAt(const GridOffset& position) const;
  /// The element at an offset of at most an extent along each dimension; -1 if it is outside.
  std::int64_t beside(const GridOffset& position, const GridOffset& offset) const;
  /// The same, and its position.
  std::int64_t beside(const GridOffset& position, const GridOffset& offset, GridOffset& found) const;
  /// To the next element in their order.
  void advance(GridOffset& position) const;

 private:
  std::size_t rank_;
  GridOffset extents_{1, 1, 1};
  std::array<std::int64_t, 3> strides_{};
  std::array<bool, 3> isPeriodic_;
};

bool hasConstantKernel(const VaryingStencil& a);
VaryingStencil scaled(VaryingStencil a, double scale);
/// The layout "stencil": entries in the order of the grid, no indices. Offsets come in the order of varying.sk.
/// For vectors in a space of the grid's shape, which may be divided over ranks.
std::unique_ptr<Matrix> makeMatrix(const Space& space, const VaryingStencil& a, const Arithmetic& arithmetic);
std::unique_ptr<Matrix> makeMatrix(sk::Device& device, const VaryingStencil& a, const Arithmetic& arithmetic);
/// The entries as varying.sk has them, {count, grid}, with the sums of rows in place of the diagonal.
Vector entriesOf(const Space& space, const VaryingStencil& a, sk::Storage storage);
/// The shape of a number of values for each element of a grid.
sk::Shape stackOf(std::int64_t count, const sk::Shape& grid);

/// Coefficients that jump from element to element of a grid, by the name of their pattern.
struct CoefficientPattern {
  std::string_view name;  ///< in "poisson:WxH:NAME=RATIO"
  std::string_view does;
  /// Returns a coefficient for each element: 1 in the background, and up to `ratio` elsewhere.
  std::vector<double> (*make)(const Stencil& grid, double ratio);
};

std::span<const CoefficientPattern> coefficientPatterns();

}  // namespace sk::linear
