// SPDX-License-Identifier: MIT
//
// The two systems of equations of a step, as matrices for the solvers of sk::linear: neither is stored.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <sk/sk.hpp>

#include "matrix.hpp"
#include "model.hpp"
#include "operator.hpp"
#include "preconditioner.hpp"
#include "pressure.sk.hpp"
#include "support/grid_stream.hpp"

namespace linear = sk::linear;

namespace fluid {

/// A model's grid as kernels take it.
struct GridArguments {
  /// In a space of the model's shape.
  GridArguments(const linear::Space& where, const Model& model);

  /// Refers to the streams.
  Grid grid() const;

  unsigned bounds;
  bool isSpace;
  Box box;
  linear::Space space;
  // Both streams have one element, which kernels do not read, if the model has no obstacles.
  examples::GridStream<std::int8_t> cell;
  examples::GridStream<int> faces;
};

/// Minus the Laplacian of pressures times the square of the spacing. `grid` must outlive it.
std::unique_ptr<linear::Matrix> makePressureMatrix(const GridArguments& grid,
                                                   const linear::Arithmetic& arithmetic);
/// The same on the host, for preconditioners and checks. `cells` are those of cellsOf().
linear::Operator pressureOperator(const Model& model, const std::vector<std::int8_t>& cells);

/// A V-cycle for the same equations, with Galerkin's coarse grids: faces that are closed are coefficients of 0, and cells that are not fluid have no equations, so that obstacles of any
/// shape need nothing else. The coarse grids are made on the host, once.
std::unique_ptr<linear::Preconditioner> makePressureMultigrid(const linear::Space& space, const Model& model,
                                                              const std::vector<std::int8_t>& cells,
                                                              const linear::Arithmetic& arithmetic);

/// 1 - c times the Laplacian of a velocity along an axis.
class ViscousMatrix : public linear::Matrix {
 public:
  /// `grid` must outlive it.
  ViscousMatrix(const GridArguments& grid, int axis, const linear::Arithmetic& arithmetic);
  /// c is viscosity times time step over the square of the spacing. Recorded loops follow it.
  void setCoefficient(double c);

  sk::Shape domain() const override { return grid_.space.shape(); }
  linear::Space space(sk::Device&) const override { return grid_.space; }
  using Matrix::multiply;
  void multiply(const linear::Vector& x, linear::Vector& y) override;
  std::string layout() const override { return "stencil"; }
  std::int64_t stored() const override { return 0; }
  std::int64_t bytes() const override { return 0; }

 private:
  const GridArguments& grid_;
  int axis_;
  linear::Vector c_;
};

}  // namespace fluid
