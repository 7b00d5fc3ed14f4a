// SPDX-License-Identifier: MIT
//
// The reduction that folds partial results of another, in order: its `combine` alone.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "sk/program.hpp"

namespace sk::mpi {

struct Combination {
  explicit Combination(const program::Reduction& of)
      : operands(of.combine.parameters.size()),
        reduction{.fold = of.combine, .combine = of.combine, .combineOperands = operands, .seeded = true} {
    std::iota(operands.begin(), operands.end(), std::uint8_t{0});
    reduction.commutative = of.commutative;
  }
  Combination(const Combination&) = delete;
  Combination& operator=(const Combination&) = delete;

  std::vector<std::uint8_t> operands;
  program::Reduction reduction;
};

}  // namespace sk::mpi
