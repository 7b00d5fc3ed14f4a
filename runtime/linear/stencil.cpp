// SPDX-License-Identifier: MIT
#include "stencil.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "fused.sk.hpp"
#include "grids.sk.hpp"
#include "products.sk.hpp"

namespace sk::linear {

namespace {

/// What matrices that are not stored have in common.
class UnstoredMatrix : public Matrix {
 public:
  UnstoredMatrix(std::optional<Space> space, const Stencil& a, const Arithmetic& arithmetic)
      : Matrix(arithmetic), space_(std::move(space)), grid_(a.grid), coefficients_(kernelCoefficients(a)) {}

  sk::Shape domain() const override { return grid_; }
  Space space(sk::Device& device) const override { return space_ ? *space_ : Matrix::space(device); }
  std::string layout() const override { return "stencil"; }
  std::int64_t stored() const override { return 0; }
  std::int64_t bytes() const override { return 0; }

 protected:
  std::optional<Space> space_;
  sk::Shape grid_;
  sk::float4 coefficients_;
};

/// The elements beyond all ends are 0.
class DirichletMatrix : public UnstoredMatrix {
 public:
  using UnstoredMatrix::UnstoredMatrix;
  void multiply(const Vector& x, Vector& y) override { stencilProduct.with(options())(coefficients_, x, y); }
  void multiply(const Vector& x, Vector& y, Vector& xy) override {
    stencilProductDot.with(foldOptions())(coefficients_, x, y, xy);
  }
  bool isFused() const override { return true; }
  void fusedDirection(const Vector& rr, const Vector& before, const Vector& r, Vector& p,
                      Vector& pq) override {
    linear::fusedDirection.with(foldOptions())(coefficients_, rr, before, r, p, p, pq);
  }
  void fusedStep(const Vector& rr, const Vector& pq, const Vector& p, Vector& x, Vector& r,
                 Vector& next) override {
    linear::fusedStep.with(foldOptions())(coefficients_, rr, pq, p, x, r, x, r, next);
  }
};

class EndedMatrix : public UnstoredMatrix {
 public:
  EndedMatrix(std::optional<Space> space, const Stencil& a, const Arithmetic& arithmetic)
      : UnstoredMatrix(std::move(space), a, arithmetic), ends_(kernelEnds(a)) {}

  using Matrix::multiply;
  void multiply(const Vector& x, Vector& y) override {
    stencilEnds.with(options())(coefficients_, ends_.low, ends_.high, x, y);
  }

 private:
  KernelEnds ends_;
};

std::unique_ptr<Matrix> makeIn(const std::optional<Space>& space, const Stencil& a,
                               const Arithmetic& arithmetic) {
  if (!isDirichlet(a)) return std::make_unique<EndedMatrix>(space, a, arithmetic);
  return std::make_unique<DirichletMatrix>(space, a, arithmetic);
}

}  // namespace

std::int64_t doubleLength(const Stencil& a, std::size_t d, std::int64_t extent) {
  const auto of = [](Side side) { return side == Side::Dirichlet ? 1 : 0; };
  return 2 * extent + of(a.ends[d].low) + of(a.ends[d].high);
}

bool isDirichlet(const Stencil& a) {
  return std::ranges::all_of(a.ends, [](const Ends& ends) { return ends == Ends{}; });
}

bool hasConstantKernel(const Stencil& a) {
  double sum = a.centre, magnitude = std::abs(a.centre);
  for (std::size_t d = 0; d < static_cast<std::size_t>(a.grid.rank()); ++d) {
    if (a.ends[d].low == Side::Dirichlet || a.ends[d].high == Side::Dirichlet) return false;
    sum += 2.0 * a.along[d];
    magnitude += 2.0 * std::abs(a.along[d]);
  }
  return std::abs(sum) <= 0x1p-44 * magnitude;
}

KernelEnds kernelEnds(const Stencil& a) {
  const auto rank = static_cast<std::size_t>(a.grid.rank());
  const auto code = [&](std::size_t axis, Side Ends::* side) {
    if (axis >= rank) return 0.0f;
    const std::size_t d = rank - 1 - axis;
    switch (a.ends[d].*side) {
      case Side::Dirichlet: return 0.0f;
      case Side::Neumann: return 1.0f;
      // One element is its own neighbour, as at Neumann ends, and part of the diagonal.
      case Side::Periodic: return a.grid[static_cast<int>(d)] == 1 ? 1.0f : 2.0f;
    }
    return 0.0f;
  };
  return {{code(0, &Ends::low), code(1, &Ends::low), code(2, &Ends::low), 0.0f},
          {code(0, &Ends::high), code(1, &Ends::high), code(2, &Ends::high), 0.0f}};
}

Stencil withEnds(Stencil a, std::span<const Ends> ends) {
  if (ends.size() != static_cast<std::size_t>(a.grid.rank()))
    throw sk::Error(fmt::format("a grid of {} dimensions needs as many pairs of ends, not {}", a.grid.rank(),
                                ends.size()));
  for (std::size_t d = 0; d < ends.size(); ++d) {
    if ((ends[d].low == Side::Periodic) != (ends[d].high == Side::Periodic))
      throw sk::Error("one end of a dimension is periodic, and the other is not");
    a.ends[d] = ends[d];
  }
  return a;
}

sk::float4 kernelCoefficients(const Stencil& a) {
  const auto c = [](double value) { return static_cast<float>(value); };
  if (a.grid.rank() == 2) return {c(a.centre), c(a.along[1]), c(a.along[0]), 0.0f};
  return {c(a.centre), c(a.along[2]), c(a.along[1]), c(a.along[0])};
}

Stencil poisson(const sk::Shape& grid) {
  if (grid.rank() != 2 && grid.rank() != 3) throw sk::Error("a grid has two or three dimensions");
  return {.grid = grid, .centre = 2.0 * grid.rank(), .along = {-1.0, -1.0, grid.rank() == 3 ? -1.0 : 0.0}};
}

Stencil poisson(const sk::Shape& grid, std::span<const double> diffusivity) {
  Stencil a = poisson(grid);
  if (diffusivity.size() != static_cast<std::size_t>(grid.rank()))
    throw sk::Error(fmt::format("a grid of {} dimensions needs as many diffusivities, not {}", grid.rank(),
                                diffusivity.size()));
  a.centre = 0.0;
  for (std::size_t d = 0; d < diffusivity.size(); ++d) {
    if (!std::isfinite(diffusivity[d]) || diffusivity[d] <= 0.0)
      throw sk::Error(fmt::format("a diffusivity is finite and above 0, which {} is not", diffusivity[d]));
    a.along[d] = -diffusivity[d];
    a.centre += 2.0 * diffusivity[d];
  }
  return a;
}

std::vector<double> multiply(const Stencil& a, std::span<const double> x) {
  std::vector<double> y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) y[i] = a.centre * x[i];
  visitNeighbours(a, [&](std::int64_t i, std::int64_t j, std::size_t d) {
    y[static_cast<std::size_t>(i)] += a.along[d] * x[static_cast<std::size_t>(j)];
  });
  return y;
}

SparseMatrix assemble(const Stencil& a) {
  std::vector<Entry> entries;
  for (std::int64_t i = 0; i < a.size(); ++i) entries.push_back({i, i, a.centre});
  visitNeighbours(
      a, [&](std::int64_t i, std::int64_t j, std::size_t d) { entries.push_back({i, j, a.along[d]}); });
  return assemble(a.size(), a.size(), entries);
}

std::unique_ptr<Matrix> makeMatrix(const Stencil& a, const Arithmetic& arithmetic) {
  return makeIn(std::nullopt, a, arithmetic);
}

std::unique_ptr<Matrix> makeMatrix(const Space& space, const Stencil& a, const Arithmetic& arithmetic) {
  return makeIn(space, a, arithmetic);
}

}  // namespace sk::linear
