// SPDX-License-Identifier: MIT
#include "stencil.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "fused.sk.hpp"
#include "products.sk.hpp"

namespace linear {

namespace {

/// Calls visit(element, neighbour, dimension) for both neighbours of every element that are inside of the grid.
template <class Visit>
void visitNeighbours(const sk::Shape& grid, Visit&& visit) {
  std::int64_t below = grid.size();
  for (std::size_t d = 0; d < static_cast<std::size_t>(grid.rank()); ++d) {
    const std::int64_t extent = grid[static_cast<int>(d)];
    if (extent == 0) return;
    const std::int64_t block = below;
    below /= extent;
    for (std::int64_t first = 0; first < grid.size(); first += block) {
      for (std::int64_t i = first + below; i < first + block; ++i) visit(i, i - below, d);
      for (std::int64_t i = first; i < first + block - below; ++i) visit(i, i + below, d);
    }
  }
}

class StencilMatrix : public Matrix {
 public:
  StencilMatrix(const Stencil& a, const Arithmetic& arithmetic)
      : Matrix(arithmetic), grid_(a.grid), coefficients_(kernelCoefficients(a)) {}

  sk::Shape domain() const override { return grid_; }
  void multiply(const Vector& x, Vector& y) override {
    if (grid_.rank() == 2)
      stencil2.with(options())(coefficients_, x, y);
    else
      stencil3.with(options())(coefficients_, x, y);
  }
  void multiply(const Vector& x, Vector& y, Vector& xy) override {
    if (grid_.rank() == 2)
      stencil2Dot.with(foldOptions())(coefficients_, x, y, xy);
    else
      stencil3Dot.with(foldOptions())(coefficients_, x, y, xy);
  }
  bool isFused() const override { return true; }
  void fusedDirection(const Vector& rr, const Vector& before, const Vector& r, Vector& p,
                      Vector& pq) override {
    if (grid_.rank() == 2)
      fusedDirection2.with(foldOptions())(coefficients_, rr, before, r, p, p, pq);
    else
      fusedDirection3.with(foldOptions())(coefficients_, rr, before, r, p, p, pq);
  }
  void fusedStep(const Vector& rr, const Vector& pq, const Vector& p, Vector& x, Vector& r,
                 Vector& next) override {
    if (grid_.rank() == 2)
      fusedStep2.with(foldOptions())(coefficients_, rr, pq, p, x, r, x, r, next);
    else
      fusedStep3.with(foldOptions())(coefficients_, rr, pq, p, x, r, x, r, next);
  }
  std::string layout() const override { return "stencil"; }
  std::int64_t stored() const override { return 0; }
  std::int64_t bytes() const override { return 0; }

 private:
  sk::Shape grid_;
  sk::float4 coefficients_;
};

}  // namespace

sk::float4 kernelCoefficients(const Stencil& a) {
  const auto c = [](double value) { return static_cast<float>(value); };
  if (a.grid.rank() == 2) return {c(a.centre), c(a.along[1]), c(a.along[0]), 0.0f};
  return {c(a.centre), c(a.along[2]), c(a.along[1]), c(a.along[0])};
}

Stencil poisson(const sk::Shape& grid) {
  if (grid.rank() != 2 && grid.rank() != 3) throw std::runtime_error("a grid has two or three dimensions");
  return {.grid = grid, .centre = 2.0 * grid.rank(), .along = {-1.0, -1.0, grid.rank() == 3 ? -1.0 : 0.0}};
}

Stencil poisson(const sk::Shape& grid, std::span<const double> diffusivity) {
  Stencil a = poisson(grid);
  if (diffusivity.size() != static_cast<std::size_t>(grid.rank()))
    throw std::runtime_error(fmt::format("a grid of {} dimensions needs as many diffusivities, not {}",
                                         grid.rank(), diffusivity.size()));
  a.centre = 0.0;
  for (std::size_t d = 0; d < diffusivity.size(); ++d) {
    if (!std::isfinite(diffusivity[d]) || diffusivity[d] <= 0.0)
      throw std::runtime_error(
          fmt::format("a diffusivity is finite and above 0, which {} is not", diffusivity[d]));
    a.along[d] = -diffusivity[d];
    a.centre += 2.0 * diffusivity[d];
  }
  return a;
}

std::vector<double> multiply(const Stencil& a, std::span<const double> x) {
  std::vector<double> y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) y[i] = a.centre * x[i];
  visitNeighbours(a.grid, [&](std::int64_t i, std::int64_t j, std::size_t d) {
    y[static_cast<std::size_t>(i)] += a.along[d] * x[static_cast<std::size_t>(j)];
  });
  return y;
}

SparseMatrix assemble(const Stencil& a) {
  std::vector<Entry> entries;
  for (std::int64_t i = 0; i < a.size(); ++i) entries.push_back({i, i, a.centre});
  visitNeighbours(
      a.grid, [&](std::int64_t i, std::int64_t j, std::size_t d) { entries.push_back({i, j, a.along[d]}); });
  return assemble(a.size(), a.size(), entries);
}

std::unique_ptr<Matrix> makeMatrix(const Stencil& a, const Arithmetic& arithmetic) {
  return std::make_unique<StencilMatrix>(a, arithmetic);
}

}  // namespace linear
