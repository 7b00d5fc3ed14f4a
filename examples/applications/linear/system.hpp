// SPDX-License-Identifier: MIT
//
// The equations that a command line names: a matrix from a file or of a grid, and a right-hand side.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "operator_matrix.hpp"
#include "reordering.hpp"
#include "varying.hpp"

namespace linear {

using namespace sk::linear;

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
  std::string description() const { return description_; }

  /// Changes the order of the unknowns: "none" or "rcm" (reordering.hpp). Throws sk::Error for a grid, whose order is its own.
  void reorder(std::string_view name);
  /// A vector of the system in the order of its file.
  std::vector<double> inOwnOrder(std::span<const double> x) const { return inFormerOrder(x, order_); }
  /// The largest distance of an entry from the diagonal before reorder(), and after it; nothing without it.
  struct Bandwidths {
    std::int64_t before = 0, after = 0;
  };
  const std::optional<Bandwidths>& bandwidths() const { return bandwidths_; }

 private:
  std::optional<Stencil> stencil_;
  std::optional<VaryingStencil> varying_;
  SparseMatrix sparse_;
  std::vector<std::int32_t> order_;
  std::optional<Bandwidths> bandwidths_;
  Operator operator_;
  std::vector<double> b_;
  std::int64_t duplicates_ = 0;
  std::string description_;
};

}  // namespace linear
