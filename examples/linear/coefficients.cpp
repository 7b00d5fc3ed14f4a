// SPDX-License-Identifier: MIT
#include "coefficients.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "varying.hpp"

namespace linear {

namespace {

/// Positions from 0 to 1 in the domain, 0 being the slowest dimension.
using Point = std::array<double, 3>;

template <class Of>
std::vector<double> coefficientsOf(const Stencil& grid, const Of& of) {
  std::vector<double> coefficient;
  coefficient.reserve(static_cast<std::size_t>(grid.size()));
  const GridWalk walk(grid.grid);
  GridOffset position{};
  for (std::int64_t i = 0; i < grid.size(); ++i, walk.advance(position)) {
    Point at{};
    for (std::size_t d = 0; d < walk.rank(); ++d) {
      const double first = grid.ends[d].low == Side::Dirichlet ? 1.0 : 0.5;
      at[d] = 2.0 * (position[d] + first) /
              static_cast<double>(doubleLength(grid, d, grid.grid[static_cast<int>(d)]));
    }
    coefficient.push_back(of(at, walk.rank()));
  }
  return coefficient;
}

/// Discs, or balls, whose centres and radii suit no coarse grid.
std::vector<double> inclusions(const Stencil& grid, double ratio) {
  struct Ball {
    Point centre;
    double radius;
  };
  static constexpr Ball balls[] = {{{0.23, 0.31, 0.27}, 0.137}, {{0.71, 0.26, 0.62}, 0.171},
                                   {{0.34, 0.73, 0.69}, 0.113}, {{0.77, 0.69, 0.33}, 0.159},
                                   {{0.52, 0.48, 0.51}, 0.061}, {{0.12, 0.87, 0.46}, 0.083}};
  return coefficientsOf(grid, [&](const Point& at, std::size_t rank) {
    for (const Ball& ball : balls) {
      double squared = 0.0;
      for (std::size_t d = 0; d < rank; ++d) squared += std::pow(at[d] - ball.centre[d], 2);
      if (squared < ball.radius * ball.radius) return ratio;
    }
    return 1.0;
  });
}

/// A checkerboard of four fields along each dimension, whose borders coarse grids have, too.
std::vector<double> blocks(const Stencil& grid, double ratio) {
  return coefficientsOf(grid, [&](const Point& at, std::size_t rank) {
    int sum = 0;
    for (std::size_t d = 0; d < rank; ++d) sum += static_cast<int>(4.0 * at[d]);
    return sum % 2 == 0 ? 1.0 : ratio;
  });
}

/// Random for every element, from 1 to the ratio, with a uniform logarithm.
std::vector<double> noise(const Stencil& grid, double ratio) {
  std::minstd_rand random(1);
  return coefficientsOf(grid, [&](const Point&, std::size_t) {
    return std::pow(ratio, static_cast<double>(random()) / static_cast<double>(std::minstd_rand::max()));
  });
}

constexpr CoefficientPattern patterns[] = {
    {"inclusions", "discs or balls of the ratio in a background of 1", inclusions},
    {"blocks", "a checkerboard of 1 and the ratio, four fields along each dimension", blocks},
    {"noise", "random for each element, from 1 to the ratio", noise},
};

}  // namespace

std::span<const CoefficientPattern> coefficientPatterns() { return patterns; }

}  // namespace linear
