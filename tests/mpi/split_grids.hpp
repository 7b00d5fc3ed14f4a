// SPDX-License-Identifier: MIT
//
// A grid of 14 columns, and all ways to split it over the ranks.
#pragma once

#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "ranks.hpp"
#include "sk/mpi.hpp"

inline constexpr std::int64_t columns = 14;

/// start(index) for each element of a grid, row-major.
template <class T, class Start>
std::vector<T> valuesOf(const sk::Shape& grid, Start&& start) {
  std::vector<T> values;
  for (std::int64_t k = 0; k < grid.size(); ++k) values.push_back(start(sk::Index{k / columns, k % columns}));
  return values;
}

inline bool isSame(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

/// Calls visit(domain) for every split of the ranks.
template <class Visit>
void forEachSplit(sk::DomainOptions options, Visit&& visit) {
  for (int rows = 1; rows <= ranksOfWorld(); ++rows) {
    if (ranksOfWorld() % rows != 0) continue;
    options.split = {rows, ranksOfWorld() / rows};
    sk::Domain domain(MPI_COMM_WORLD, options);
    INFO("split " << sk::toString(domain.split()));
    visit(domain);
  }
}
