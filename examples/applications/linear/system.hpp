// SPDX-License-Identifier: MIT
//
// The equations that a command line names: a matrix from a file or of a grid, and a right-hand side.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "layout.hpp"
#include "operator.hpp"
#include "varying.hpp"

namespace linear {

class System {
 public:
  /// `matrix` is a Matrix Market file, or "poisson:WxH" or "poisson:WxHxD" for Poisson's equation on a grid; ":X,Y" or
  /// ":X,Y,Z" after it are diffusivities along the dimensions, in the order of the extents, and ":periodic,dirichlet-neumann" are the ends, one pair or one word for both, for
  /// each dimension or for all. ":compact" is the fourth-order discretisation (compact.hpp). ":PATTERN=RATIO" has coefficients that jump from element to element (varying.hpp), and ":coefficients=FILE", which comes last, those of a Matrix Market
  /// file, one for each element, the fastest dimension first. The right-hand side
  /// is a file, or A times ones if there is none; on singular grids, A times random numbers. Throws std::runtime_error if one of them is wrong.
  System(const std::string& matrix, const std::filesystem::path& rightHandSide);
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  const Operator& matrix() const { return operator_; }
  const std::vector<double>& rightHandSide() const { return b_; }
  /// Entries of the matrix that were given several times, and added up.
  std::int64_t duplicates() const { return duplicates_; }
  std::int64_t entries() const;
  std::string description() const { return description_; }

  /// Bytes that makeMatrix() takes of a device for the layout; 0 for a stencil of constant coefficients. Throws std::runtime_error for an unknown layout.
  std::int64_t matrixBytes(std::string_view layout, std::int64_t entryBytes) const;

  /// Copies the scaled matrix to a device: a stencil where "auto" or "stencil" asks for a grid's layout.
  std::unique_ptr<Matrix> makeMatrix(sk::Device& device, std::string_view layout,
                                     const Arithmetic& arithmetic, std::vector<LayoutCost>* costs) const;
  /// The same for vectors in a space, whose shape is the grid's if it is divided over ranks. Throws std::runtime_error if the matrix cannot be divided.
  std::unique_ptr<Matrix> makeMatrix(const Space& space, std::string_view layout,
                                     const Arithmetic& arithmetic, std::vector<LayoutCost>* costs) const;
  /// The shape of vectors: the grid's, or {unknowns}.
  sk::Shape shape() const;

 private:
  std::optional<Stencil> stencil_;
  std::optional<VaryingStencil> varying_;
  SparseMatrix sparse_;
  Operator operator_;
  std::vector<double> b_;
  std::int64_t duplicates_ = 0;
  std::string description_;
};

}  // namespace linear
