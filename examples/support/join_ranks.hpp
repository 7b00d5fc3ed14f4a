// SPDX-License-Identifier: MIT
//
// Examples on the ranks of MPI (library sk_examples_ranks). Where MPI is not installed, each process is alone.
#pragma once

#include <memory>
#include <string>

#include "support/ranks.hpp"

namespace examples {

/// All processes that a launcher has started with this one; without a launcher, this process alone. On all ranks but the first,
/// standard output leads nowhere from then on.
std::unique_ptr<Ranks> joinRanks();

/// Divides a grid over all ranks. MPI must have been initialized. Throws std::logic_error where it is not installed.
std::unique_ptr<DividedGrid> divideGrid(const std::string& device, const sk::Shape& shape, Ends ends);

}  // namespace examples
