// SPDX-License-Identifier: MIT
#include "compact.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace sk::linear {

namespace {

constexpr double pi = std::numbers::pi;

/// A factor of the known solution, and its second derivative, along the fastest, the next or the slowest dimension.
struct Factor {
  double value, second;
};

Factor exponentialSine(double rate, double x) {
  const double s = std::sin(pi * x), c = std::cos(pi * x), e = std::exp(rate * x);
  return {e * s, e * ((rate * rate - pi * pi) * s + 2.0 * rate * pi * c)};
}

Factor factorOf(std::size_t axis, double x) {
  if (axis == 0) return exponentialSine(1.0, x);
  if (axis == 2) return exponentialSine(-1.0, x);
  const double s = std::sin(2.0 * pi * x);
  return {s, -4.0 * pi * pi * s};
}

std::array<Factor, 3> factorsAt(const KnownSolution& known, const GridOffset& position) {
  const auto rank = static_cast<std::size_t>(known.grid.grid.rank());
  std::array<Factor, 3> factors{{{1, 0}, {1, 0}, {1, 0}}};
  for (std::size_t d = 0; d < rank; ++d) factors[d] = factorOf(rank - 1 - d, known.h * (position[d] + 1));
  return factors;
}

template <class Of>
std::vector<double> forEachElement(const Stencil& grid, const Of& of) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(grid.size()));
  const GridWalk walk(grid.grid);
  GridOffset position{};
  for (std::int64_t i = 0; i < grid.size(); ++i, walk.advance(position)) values.push_back(of(position));
  return values;
}

}  // namespace

VaryingStencil compactPoisson(const Stencil& grid) {
  const auto rank = static_cast<std::size_t>(grid.grid.rank());
  for (std::size_t d = 1; d < rank; ++d)
    if (grid.along[d] != grid.along[0])
      throw sk::Error("compact discretisations need the same diffusivity along all dimensions");
  VaryingStencil a{
      .grid = grid.grid, .offsets = neighbourOffsets(grid.grid.rank(), Neighbourhood::Edges), .value = {}};
  for (std::size_t d = 0; d < rank; ++d) a.isPeriodic[d] = grid.ends[d].low == Side::Periodic;
  a.value.assign(a.offsets.size() * static_cast<std::size_t>(a.size()), 0.0);
  const double side = (rank == 2 ? 4.0 : 2.0) / 6.0 * grid.along[0], edge = grid.along[0] / 6.0;
  const double centre = rank == 2 ? -4.0 * (side + edge) : -6.0 * side - 12.0 * edge;
  const GridWalk walk(a.grid);
  GridOffset position{};
  for (std::int64_t i = 0; i < a.size(); ++i, walk.advance(position))
    for (std::size_t k = 0; k < a.offsets.size(); ++k) {
      GridOffset offset = a.offsets[k];
      const int distance = std::abs(offset[0]) + std::abs(offset[1]) + std::abs(offset[2]);
      bool isInside = true;
      for (std::size_t d = 0; d < rank; ++d) {
        const int at = position[d] + offset[d];
        if (at >= 0 && at < a.grid[static_cast<int>(d)]) continue;
        const Side end = at < 0 ? grid.ends[d].low : grid.ends[d].high;
        if (end == Side::Dirichlet) isInside = false;
        if (end == Side::Neumann) offset[d] = 0;  // the mirror image of this element
      }
      if (!isInside) continue;
      const auto slot = std::ranges::find(a.offsets, offset) - a.offsets.begin();
      a.value[entryAt(a, static_cast<std::size_t>(slot), i)] += distance == 0   ? centre
                                                                : distance == 1 ? side
                                                                                : edge;
    }
  return a;
}

std::vector<double> compactLoad(const Stencil& grid, double h, const GridFunction& f) {
  return forEachElement(grid, [&](const GridOffset& position) {
    const double own = f(position);
    double difference = 0.0;
    for (std::size_t d = 0; d < static_cast<std::size_t>(grid.grid.rank()); ++d)
      for (const int step : {-1, 1}) {
        GridOffset beside = position;
        beside[d] += step;
        difference += f(beside) - own;
      }
    return h * h * (own + difference / 12.0);
  });
}

KnownSolution::KnownSolution(int rank, std::int64_t n)
    : grid(poisson(rank == 2 ? sk::Shape{n, n} : sk::Shape{n, n, n})), h(1.0 / static_cast<double>(n + 1)) {}

double KnownSolution::solution(const GridOffset& position) const {
  const std::array<Factor, 3> f = factorsAt(*this, position);
  return f[0].value * f[1].value * f[2].value;
}

double KnownSolution::load(const GridOffset& position) const {
  const std::array<Factor, 3> f = factorsAt(*this, position);
  return -(f[0].second * f[1].value * f[2].value + f[0].value * f[1].second * f[2].value +
           f[0].value * f[1].value * f[2].second);
}

std::vector<double> KnownSolution::secondOrder() const {
  return forEachElement(grid, [&](const GridOffset& position) { return h * h * load(position); });
}

std::vector<double> KnownSolution::fourthOrder() const {
  return compactLoad(grid, h, [&](const GridOffset& position) { return load(position); });
}

double KnownSolution::errorOf(std::span<const double> x) const {
  double largest = 0.0;
  std::size_t i = 0;
  forEachElement(grid, [&](const GridOffset& position) {
    largest = std::max(largest, std::abs(x[i++] - solution(position)));
    return 0.0;
  });
  return largest;
}

}  // namespace sk::linear
