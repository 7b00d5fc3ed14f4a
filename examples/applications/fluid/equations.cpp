// SPDX-License-Identifier: MIT
#include "equations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "momentum.sk.hpp"
#include "multigrid.hpp"
#include "varying.hpp"

namespace fluid {

namespace {

Box boxOf(const Model& m) {
  const auto extent = [&](int d) {
    return m.isPeriodic(d) ? 0 : static_cast<std::int32_t>(m.cells[static_cast<std::size_t>(d)]);
  };
  const auto kind = [&](std::size_t side) { return static_cast<std::int32_t>(cellOf(m.sides[side])); };
  return {{extent(0), extent(1), extent(2)}, {kind(0), kind(2), kind(4)}, {kind(1), kind(3), kind(5)}};
}

class PressureMatrix : public linear::Matrix {
 public:
  PressureMatrix(const GridArguments& grid, const linear::Arithmetic& arithmetic)
      : Matrix(arithmetic), grid_(grid) {}
  sk::Shape domain() const override { return grid_.space.shape(); }
  linear::Space space(sk::Device&) const override { return grid_.space; }
  void multiply(const linear::Vector& x, linear::Vector& y) override {
    pressureProduct.with(options())(grid_.grid(), x, y);
  }
  void multiply(const linear::Vector& x, linear::Vector& y, linear::Vector& xy) override {
    pressureProductDot.with(foldOptions())(grid_.grid(), x, y, xy);
  }
  std::string layout() const override { return "stencil"; }
  std::int64_t stored() const override { return 0; }
  std::int64_t bytes() const override { return 0; }

 private:
  const GridArguments& grid_;
};

/// Calls visit(cell, neighbour, face) for the faces of all cells that are fluid: below and above along x, y and, in space, z.
template <class Visit>
void visitFaces(const Model& m, const std::vector<std::int8_t>& cells, Visit&& visit) {
  const sk::Shape shape = m.shape();
  const std::array<std::int64_t, 3> n = {shape[2], shape[1], shape[0]};
  std::int64_t cell = 0;
  for (std::int64_t z = 0; z < n[2]; ++z) {
    for (std::int64_t y = 0; y < n[1]; ++y) {
      for (std::int64_t x = 0; x < n[0]; ++x, ++cell) {
        if (cells[static_cast<std::size_t>(cell)] != Fluid) continue;
        for (int face = 0; face < 2 * m.rank(); ++face) {
          std::array<std::int64_t, 3> at = {x, y, z};
          const auto axis = static_cast<std::size_t>(face / 2);
          at[axis] = (at[axis] + (face % 2 == 0 ? -1 : 1) + n[axis]) % n[axis];
          visit(cell, m.index(at), face);
        }
      }
    }
  }
}

std::vector<int> facesOf(const Model& m, const std::vector<std::int8_t>& cells) {
  std::vector<int> faces(cells.size(), 0);
  visitFaces(m, cells, [&](std::int64_t cell, std::int64_t neighbour, int face) {
    const int kind = cells[static_cast<std::size_t>(neighbour)];
    if (kind == Fluid || kind == Outflow) faces[static_cast<std::size_t>(cell)] |= kind << (2 * face);
  });
  return faces;
}

/// Calls visit(row, column, coefficient) for every entry, several times for diagonal ones; what flows out has no column.
template <class Visit>
void visitEntries(const Model& m, const std::vector<std::int8_t>& cells, Visit&& visit) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto row = static_cast<std::int64_t>(i);
    if (cells[i] != Fluid) visit(row, row, 1.0);
  }
  visitFaces(m, cells, [&](std::int64_t row, std::int64_t column, int) {
    const std::int8_t kind = cells[static_cast<std::size_t>(column)];
    if (kind == Outflow) visit(row, row, 2.0);
    if (kind != Fluid) return;
    visit(row, row, 1.0);
    visit(row, column, -1.0);
  });
}

/// A stream for each cell, or of one element.
template <class T>
examples::GridStream<T> cellStream(const linear::Space& space, bool hasCells) {
  if (hasCells) return space.stream<T>();
  return space.device().stream<T>({1, 1, 1});
}

}  // namespace

GridArguments::GridArguments(const linear::Space& where, const Model& model)
    : bounds(static_cast<unsigned>(model.bounds())),
      isSpace(model.isSpace()),
      box(boxOf(model)),
      space(where),
      cell(cellStream<std::int8_t>(where, bounds == Anywhere)),
      faces(cellStream<int>(where, bounds == Anywhere)) {
  if (bounds != Anywhere) return;
  const std::vector<std::int8_t> cells = cellsOf(model);
  cell.write(cells);
  faces.write(facesOf(model, cells));
}

Grid GridArguments::grid() const {
  return {.bounds = bounds, .isSpace = isSpace, .box = box, .cell = cell, .faces = faces};
}

std::unique_ptr<linear::Matrix> makePressureMatrix(const GridArguments& grid,
                                                   const linear::Arithmetic& arithmetic) {
  return std::make_unique<PressureMatrix>(grid, arithmetic);
}

linear::Operator pressureOperator(const Model& model, const std::vector<std::int8_t>& cells) {
  linear::Operator o;
  o.size = static_cast<std::int64_t>(cells.size());
  o.diagonal.assign(cells.size(), 0.0);
  o.rowSquares.assign(cells.size(), 0.0);
  std::vector<double> sums(cells.size(), 0.0);
  visitEntries(model, cells, [&](std::int64_t row, std::int64_t column, double value) {
    const auto i = static_cast<std::size_t>(row);
    sums[i] += std::abs(value);
    if (column == row)
      o.diagonal[i] += value;
    else
      o.rowSquares[i] += value * value;
  });
  for (std::size_t i = 0; i < cells.size(); ++i) {
    // A fluid cell that is closed in on all sides: the residual is 0 there, and stays so.
    if (o.diagonal[i] == 0.0) o.diagonal[i] = 1.0;
    o.rowSquares[i] += o.diagonal[i] * o.diagonal[i];
    o.infinityNorm = std::max(o.infinityNorm, sums[i]);
    o.jacobiBound = std::max(o.jacobiBound, sums[i] / o.diagonal[i]);
  }
  o.multiply = [model, cells](std::span<const double> x) {
    std::vector<double> y(x.size(), 0.0);
    visitEntries(model, cells, [&](std::int64_t row, std::int64_t column, double value) {
      y[static_cast<std::size_t>(row)] += value * x[static_cast<std::size_t>(column)];
    });
    return y;
  };
  return o;
}

namespace {

linear::VaryingStencil pressureStencil(const Model& model, const std::vector<std::int8_t>& cells) {
  const sk::Shape shape = model.shape();
  const auto rank = static_cast<std::size_t>(model.rank());
  linear::VaryingStencil a{.grid = model.isSpace() ? shape : sk::Shape{shape[1], shape[2]},
                           .offsets = linear::neighbourOffsets(model.rank(), linear::Neighbourhood::Sides),
                           .value = {}};
  for (std::size_t d = 0; d < rank; ++d) a.isPeriodic[d] = model.isPeriodic(static_cast<int>(rank - 1 - d));
  a.value.assign(a.offsets.size() * cells.size(), 0.0);
  visitFaces(model, cells, [&](std::int64_t cell, std::int64_t neighbour, int face) {
    const std::int8_t kind = cells[static_cast<std::size_t>(neighbour)];
    if (kind == Outflow) a.value[entryAt(a, 0, cell)] += 2.0;
    if (kind != Fluid || neighbour == cell) return;
    a.value[entryAt(a, 0, cell)] += 1.0;
    a.value[entryAt(a, static_cast<std::size_t>(face) + 1, cell)] -= 1.0;
  });
  return a;
}

/// Cycles for planes have two dimensions, and the flow's streams three.
class PlaneMultigrid : public linear::Preconditioner {
 public:
  PlaneMultigrid(const linear::Space& plane, std::unique_ptr<linear::Preconditioner> cycle,
                 const linear::Arithmetic& arithmetic)
      : cycle_(std::move(cycle)),
        r_(plane.stream<float>(arithmetic.vectors)),
        z_(plane.stream<float>(arithmetic.vectors)),
        options_(arithmetic.options()) {}

  void apply(const linear::Vector& r, linear::Vector& z, linear::Vector& rz) override {
    planeOf.with(options_)(r, r_);
    cycle_->apply(r_, z_, rz);
    layerOf.with(options_)(z_, z);
  }

 private:
  std::unique_ptr<linear::Preconditioner> cycle_;
  linear::Vector r_, z_;
  sk::CallOptions options_;
};

}  // namespace

std::unique_ptr<linear::Preconditioner> makePressureMultigrid(const linear::Space& space, const Model& model,
                                                              const std::vector<std::int8_t>& cells,
                                                              const linear::Arithmetic& arithmetic) {
  const linear::VaryingStencil a = pressureStencil(model, cells);
  if (model.isSpace()) return linear::makeMultigrid(space, a, arithmetic, {});
  const linear::Space plane = space.resized(a.grid);
  return std::make_unique<PlaneMultigrid>(plane, linear::makeMultigrid(plane, a, arithmetic, {}), arithmetic);
}

ViscousMatrix::ViscousMatrix(const GridArguments& grid, int axis, const linear::Arithmetic& arithmetic)
    : Matrix(arithmetic),
      grid_(grid),
      axis_(axis),
      c_(grid.space.device().stream<float>({1}, arithmetic.sums())) {}

void ViscousMatrix::setCoefficient(double c) { c_.writeReals(std::array{c}); }

void ViscousMatrix::multiply(const linear::Vector& x, linear::Vector& y) {
  const auto product = [&](const auto& kernel) { kernel.with(options())(grid_.grid(), c_, x, y); };
  if (axis_ == 0) product(viscousProduct_0);
  if (axis_ == 1) product(viscousProduct_1);
  if (axis_ == 2) product(viscousProduct_2);
}

}  // namespace fluid
