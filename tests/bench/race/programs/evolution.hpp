// SPDX-License-Identifier: MIT
//
// The reference of programs that repeat a step on a grid, in double precision: all of a small grid, and some blocks of a large
// one. A step reaches the cells beside each cell, so that the cells that a block needs lie within as many cells of it as there
// are steps.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "check.hpp"
#include "contender.hpp"

namespace race {

/// What a cell at the border has for a neighbour outside: itself, 0, or the cell at the opposite border.
enum class Edge { Clamp, Zero, Wrap };

/// Fields of a grid. Behind its cells, each has one more number: the 0 outside.
struct Lattice {
  std::int64_t rows = 0, columns = 0;
  std::vector<std::vector<double>> fields = {};
};

/// Where a cell and the cells beside it are in a field.
struct Cell {
  std::size_t here, west, east, north, south;
};

/// Calls visit(cell) for each cell.
template <class Visit>
void forEachCell(const Lattice& lattice, Edge edge, const Visit& visit) {
  const std::int64_t rows = lattice.rows, columns = lattice.columns, outside = rows * columns;
  const auto beyond = [&](std::int64_t itself, std::int64_t opposite) {
    return edge == Edge::Clamp ? itself : edge == Edge::Zero ? outside : opposite;
  };
  const auto at = [&](std::int64_t here, std::int64_t west, std::int64_t east, std::int64_t north,
                      std::int64_t south) {
    visit(Cell{static_cast<std::size_t>(here), static_cast<std::size_t>(west), static_cast<std::size_t>(east),
               static_cast<std::size_t>(north), static_cast<std::size_t>(south)});
  };
  for (std::int64_t y = 0; y < rows; ++y) {
    const std::int64_t first = y * columns, last = first + columns - 1;
    const auto north = [&](std::int64_t here) {
      return y > 0 ? here - columns : beyond(here, here + outside - columns);
    };
    const auto south = [&](std::int64_t here) {
      return y + 1 < rows ? here + columns : beyond(here, here - outside + columns);
    };
    at(first, beyond(first, last), first + 1, north(first), south(first));
    for (std::int64_t here = first + 1; here < last; ++here)
      at(here, here - 1, here + 1, north(here), south(here));
    at(last, last - 1, beyond(last, first), north(last), south(last));
  }
}

/// A program that repeats a step.
struct Evolution {
  Edge edge;
  int steps;
  /// A step, from `now` to `next`. Fields of `next` have the numbers of two steps before.
  std::function<void(const Lattice& now, Lattice& next)> step;
};

/// The check of an evolution from p.floats, a field each. The result has the fields one after the other. A grid of more than
/// `mostWhole` cells is checked in blocks, at its borders and inside.
Check evolutionCheck(const Problem& p, const Evolution& evolution, double tolerance,
                     std::int64_t mostWhole = std::int64_t{1} << 20);

}  // namespace race
