// SPDX-License-Identifier: MIT
#include "varying.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>

#include <fmt/format.h>

#include "varying.sk.hpp"

namespace sk::linear {

namespace {

class VaryingMatrix : public Matrix {
 public:
  VaryingMatrix(const Space& space, const VaryingStencil& a, const Arithmetic& arithmetic)
      : Matrix(arithmetic),
        space_(space),
        grid_(a.grid),
        count_(a.count()),
        entries_(entriesOf(space, a, arithmetic.matrix)) {}

  sk::Shape domain() const override { return grid_; }
  Space space(sk::Device&) const override { return space_; }
  std::string layout() const override { return "stencil"; }
  std::int64_t stored() const override { return count_ * grid_.size(); }
  std::int64_t bytes() const override { return stored() * entryBytes(); }

  using Matrix::multiply;
  void multiply(const Vector& x, Vector& y) override {
    productVarying.with(options())(count_, entries_, x, y);
  }

 private:
  Space space_;
  sk::Shape grid_;
  int count_;
  Vector entries_;
};

double harmonicMean(double a, double b) { return 2.0 * std::min(a, b) * (std::max(a, b) / (a + b)); }

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

std::vector<GridOffset> neighbourOffsets(int rank, Neighbourhood neighbourhood) {
  std::vector<GridOffset> offsets{{0, 0, 0}};
  const auto slot = [&](int axis) { return static_cast<std::size_t>(rank - 1 - axis); };  // 0 is the fastest
  for (int axis = 0; axis < rank; ++axis)
    for (const int step : {-1, 1}) {
      offsets.push_back({0, 0, 0});
      offsets.back()[slot(axis)] = step;
    }
  if (neighbourhood == Neighbourhood::Sides) return offsets;
  for (int fast = 0; fast < rank; ++fast)
    for (int slow = fast + 1; slow < rank; ++slow)
      for (const int there : {-1, 1})
        for (const int here : {-1, 1}) {
          offsets.push_back({0, 0, 0});
          offsets.back()[slot(fast)] = here;
          offsets.back()[slot(slow)] = there;
        }
  if (neighbourhood == Neighbourhood::Edges || rank == 2) return offsets;
  for (const int z : {-1, 1})
    for (const int y : {-1, 1})
      for (const int x : {-1, 1}) offsets.push_back({z, y, x});
  return offsets;
}

GridWalk::GridWalk(const sk::Shape& grid, std::array<bool, 3> isPeriodic)
    : rank_(static_cast<std::size_t>(grid.rank())), isPeriodic_(isPeriodic) {
  std::int64_t stride = 1;
  for (std::size_t d = rank_; d-- > 0;) {
    extents_[d] = static_cast<int>(grid[static_cast<int>(d)]);
    strides_[d] = stride;
    stride *= extents_[d];
  }
}

GridOffset GridWalk::positionOf(std::int64_t element) const {
  GridOffset position{};
  for (std::size_t d = 0; d < rank_; ++d) {
    position[d] = static_cast<int>(element / strides_[d]);
    element %= strides_[d];
  }
  return position;
}

std::int64_t GridWalk::elementAt(const GridOffset& position) const {
  std::int64_t element = 0;
  for (std::size_t d = 0; d < rank_; ++d) element += strides_[d] * position[d];
  return element;
}

std::int64_t GridWalk::beside(const GridOffset& position, const GridOffset& offset) const {
  GridOffset found{};
  return beside(position, offset, found);
}

std::int64_t GridWalk::beside(const GridOffset& position, const GridOffset& offset, GridOffset& found) const {
  std::int64_t element = 0;
  for (std::size_t d = 0; d < rank_; ++d) {
    int at = position[d] + offset[d];
    if (at < 0 || at >= extents_[d]) {
      if (!isPeriodic_[d]) return -1;
      at += at < 0 ? extents_[d] : -extents_[d];
    }
    element += strides_[d] * at;
    found[d] = at;
  }
  return element;
}

void GridWalk::advance(GridOffset& position) const {
  for (std::size_t d = rank_; d-- > 0;) {
    if (++position[d] < extents_[d]) return;
    position[d] = 0;
  }
}

VaryingStencil diffusion(const Stencil& grid, std::span<const double> coefficient) {
  const std::int64_t n = grid.size();
  if (static_cast<std::int64_t>(coefficient.size()) != n)
    throw sk::Error(
        fmt::format("a grid of {} elements needs as many coefficients, not {}", n, coefficient.size()));
  for (std::size_t i = 0; i < coefficient.size(); ++i)
    if (!std::isfinite(coefficient[i]) || coefficient[i] <= 0.0)
      throw sk::Error(fmt::format("a coefficient is finite and above 0, which number {}, {}, is not", i + 1,
                                  coefficient[i]));
  VaryingStencil a{.grid = grid.grid,
                   .offsets = neighbourOffsets(grid.grid.rank(), Neighbourhood::Sides),
                   .value = std::vector<double>(static_cast<std::size_t>(n) *
                                                static_cast<std::size_t>(2 * grid.grid.rank() + 1))};
  const auto rank = static_cast<std::size_t>(grid.grid.rank());
  for (std::size_t d = 0; d < rank; ++d) a.isPeriodic[d] = grid.ends[d].low == Side::Periodic;
  const GridWalk walk(a.grid, a.isPeriodic);
  GridOffset position{};
  for (std::int64_t i = 0; i < n; ++i, walk.advance(position)) {
    const double own = coefficient[static_cast<std::size_t>(i)];
    for (std::size_t k = 1; k < a.offsets.size(); ++k) {
      const std::size_t d = rank - 1 - (k - 1) / 2;
      const Side side = k % 2 == 1 ? grid.ends[d].low : grid.ends[d].high;
      const std::int64_t j = walk.beside(position, a.offsets[k]);
      if (j == i || (j < 0 && side == Side::Neumann)) continue;
      const double between =
          -grid.along[d] * (j < 0 ? own : harmonicMean(own, coefficient[static_cast<std::size_t>(j)]));
      a.value[entryAt(a, 0, i)] += between;
      if (j >= 0) a.value[entryAt(a, k, i)] = -between;
    }
  }
  return a;
}

bool hasConstantKernel(const VaryingStencil& a) {
  double largest = 0.0, imbalance = 0.0;
  for (std::int64_t i = 0; i < a.size(); ++i) {
    double sum = 0.0, magnitude = 0.0;
    for (std::size_t k = 0; k < a.offsets.size(); ++k) {
      sum += a.value[entryAt(a, k, i)];
      magnitude += std::abs(a.value[entryAt(a, k, i)]);
    }
    largest = std::max(largest, magnitude);
    imbalance = std::max(imbalance, magnitude > 0.0 ? std::abs(sum) / magnitude : 0.0);
  }
  return largest > 0.0 && imbalance <= 0x1p-44;
}

VaryingStencil scaled(VaryingStencil a, double scale) {
  for (double& v : a.value) v *= scale;
  return a;
}

SparseMatrix assemble(const VaryingStencil& a) {
  std::vector<Entry> entries;
  entries.reserve(a.value.size());
  const GridWalk walk(a.grid, a.isPeriodic);
  GridOffset position{};
  for (std::int64_t i = 0; i < a.size(); ++i, walk.advance(position))
    for (std::size_t k = 0; k < a.offsets.size(); ++k) {
      const double v = a.value[entryAt(a, k, i)];
      const std::int64_t j = walk.beside(position, a.offsets[k]);
      if (j >= 0 && (v != 0.0 || k == 0)) entries.push_back({i, j, v});
    }
  return assemble(a.size(), a.size(), entries);
}

sk::Shape stackOf(std::int64_t count, const sk::Shape& grid) {
  if (grid.rank() == 2) return {count, grid[0], grid[1]};
  return {count, grid[0], grid[1], grid[2]};
}

Vector entriesOf(const Space& space, const VaryingStencil& a, sk::Storage storage) {
  Vector entries = space.resized(stackOf(a.count(), a.grid)).stream<float>(storage);
  std::vector<double> value = a.value;
  for (std::int64_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 1; k < a.offsets.size(); ++k) value[entryAt(a, 0, i)] += a.value[entryAt(a, k, i)];
  entries.writeReals(value);
  return entries;
}

std::unique_ptr<Matrix> makeMatrix(const Space& space, const VaryingStencil& a,
                                   const Arithmetic& arithmetic) {
  return std::make_unique<VaryingMatrix>(space, a, arithmetic);
}

std::unique_ptr<Matrix> makeMatrix(sk::Device& device, const VaryingStencil& a,
                                   const Arithmetic& arithmetic) {
  return makeMatrix(Space(device, a.grid), a, arithmetic);
}

std::span<const CoefficientPattern> coefficientPatterns() { return patterns; }

}  // namespace sk::linear
