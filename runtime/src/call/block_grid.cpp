// SPDX-License-Identifier: MIT
//
// Enumerates the block grids that are compatible with the result's shape.
#include "call/block_grid.hpp"

#include <algorithm>
#include <array>

namespace sk {

namespace {

Shape shapeOf(const std::array<std::int64_t, maxRank>& extents, int rank) {
  switch (rank) {
    case 1: return {extents[0]};
    case 2: return {extents[0], extents[1]};
    case 3: return {extents[0], extents[1], extents[2]};
    default: return {extents[0], extents[1], extents[2], extents[3]};
  }
}

bool divides(const Shape& grid, const Shape& domain) {
  for (int d = 0; d < domain.rank(); ++d) {
    if (grid[d] == 0 ? domain[d] != 0 : domain[d] % grid[d] != 0) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::vector<Shape> blockGrids(const Shape& domain, const Shape& result) {
  std::vector<Shape> grids;
  const int rank = domain.rank();
  for (unsigned kept = 0; kept < 1u << rank; ++kept) {  // bit d: dimension d belongs to the result
    std::array<std::int64_t, maxRank> extents{1, 1, 1, 1};
    int next = 0;
    for (int d = 0; d < rank; ++d) {
      if ((kept >> d & 1u) != 0) {
        extents[static_cast<std::size_t>(d)] = next < result.rank() ? result[next] : 1;
        ++next;
      }
    }
    if (next != result.rank()) {
      continue;
    }
    const Shape grid = shapeOf(extents, rank);
    if (divides(grid, domain) && std::find(grids.begin(), grids.end(), grid) == grids.end()) {
      grids.push_back(grid);
    }
  }
  return grids;
}

Shape oneBlock(Shape domain) {
  for (int d = 0; d < domain.rank(); ++d) domain = domain.with(d, 1);
  return domain;
}

}  // namespace sk
