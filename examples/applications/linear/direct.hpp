// SPDX-License-Identifier: MIT
//
// Solutions by sparse factors, by Eigen on the host: what iterations are judged by. Where CMake has not found Eigen, all of it throws.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "operator.hpp"

namespace linear {

using namespace sk::linear;

struct DirectSolution {
  std::vector<double> x;
  std::string_view factors;  ///< "L D L^T", or "L U"
  std::int64_t entries = 0;  ///< of the factors
  double seconds = 0.0;
};

/// Solves A x = b by L D L^T if A is symmetric and has such factors, and else by L U with partial pivoting. Throws sk::Error if the matrix is singular, and, before the memory is taken, if the
/// host is known to have less than the factors may need.
DirectSolution solveDirectly(const Operator& a, std::span<const double> b);

}  // namespace linear
