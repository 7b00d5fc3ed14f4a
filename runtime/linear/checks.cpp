// SPDX-License-Identifier: MIT
#include "checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include <fmt/format.h>

#include "residual.hpp"
#include "text/memory.hpp"

namespace sk::linear {

void checkChoice(const MethodKind& method, const PreconditionerKind& preconditioner, int sweepsBefore,
                 int sweepsAfter) {
  if (method.needsSymmetry && !preconditioner.isSymmetric)
    throw sk::Error(fmt::format(
        "the solver '{}' needs a symmetric preconditioner, which '{}' is not; take the solver '{}'",
        method.name, preconditioner.name, preconditioner.isCycle ? "stationary" : "gmres"));
  if (method.needsSymmetry && sweepsBefore != sweepsAfter)
    throw sk::Error(
        fmt::format("the solver '{}' needs as many sweeps after the correction as before it, not {} and {}; "
                    "take the solver 'stationary'",
                    method.name, sweepsAfter, sweepsBefore));
  if (sweepsBefore + sweepsAfter == 0)
    throw sk::Error("multigrid needs a sweep; take one before the correction and one after it");
}

void checkSymmetry(sk::Device& device, Matrix& matrix, const Arithmetic& arithmetic, const MethodKind& method,
                   const PreconditionerKind& preconditioner, const Operator& a) {
  if (!method.needsSymmetry && !preconditioner.needsSymmetry) return;
  const std::string asymmetry = asymmetryOnDevice(device, matrix, a, arithmetic);
  if (asymmetry.empty()) return;
  if (method.needsSymmetry)
    throw sk::Error(
        fmt::format("the solver '{}' needs a symmetric matrix: {}; take the solver 'gmres' or 'bicgstab'",
                    method.name, asymmetry));
  throw sk::Error(
      fmt::format("the preconditioner '{}' needs a symmetric matrix: {}; take the preconditioner 'ilu0'",
                  preconditioner.name, asymmetry));
}

void checkStructure(const SparseMatrix& a) {
  const auto fail = [](const std::string& what) {
    throw sk::Error(fmt::format("the matrix {}; assemble() makes one of entries", what),
                    sk::Error::Kind::Shape);
  };
  if (a.rows < 0 || a.columns < 0 || static_cast<std::int64_t>(a.starts.size()) != a.rows + 1)
    fail(fmt::format("has {} rows and {} starts of rows", a.rows, a.starts.size()));
  if (a.column.size() != a.value.size() || a.starts.front() != 0 || a.starts.back() != a.entries())
    fail(fmt::format("has {} columns of entries, {} values and rows that end with entry {}", a.column.size(),
                     a.value.size(), a.starts.back()));
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.rows); ++i)
    if (a.starts[i] > a.starts[i + 1]) fail(fmt::format("has a row {} that ends before it begins", i + 1));
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.rows); ++i)
    for (auto k = static_cast<std::size_t>(a.starts[i]); k < static_cast<std::size_t>(a.starts[i + 1]); ++k) {
      const bool isFirst = static_cast<std::int64_t>(k) == a.starts[i];
      if (a.column[k] < 0 || a.column[k] >= a.columns || (!isFirst && a.column[k] <= a.column[k - 1]))
        fail(fmt::format("has columns in row {} that do not ascend from 1 to {}", i + 1, a.columns));
      if (!std::isfinite(a.value[k]))
        throw sk::Error(fmt::format("entry ({}, {}) of the matrix is {}, which is not finite", i + 1,
                                    a.column[k] + 1, a.value[k]));
    }
}

void checkGridSize(const sk::Shape& grid, int entries) {
  constexpr std::int64_t most = 0x7fffffff;
  if (grid.size() > most)
    throw sk::Error(
        fmt::format("a grid of {} elements is too large; at most {} can be solved", grid.size(), most),
        sk::Error::Kind::Shape);
  // The diagonal, squares of rows, sums, the right-hand side, and two while it is scaled.
  constexpr int vectors = 6;
  text::requireMemory(fmt::format("a grid of {} elements", grid.size()),
                      (8.0 * vectors + 56.0 * entries) * static_cast<double>(grid.size()));
}

void checkGrid(const Stencil& a) {
  poisson(a.grid);  // two or three dimensions
  const auto rank = static_cast<std::size_t>(a.grid.rank());
  withEnds(a, std::span(a.ends).first(rank));  // pairs of them
  checkGridSize(a.grid, 0);
  if (!std::isfinite(a.centre) || !std::ranges::all_of(a.along, [](double c) { return std::isfinite(c); }))
    throw sk::Error("the coefficients of a stencil are finite numbers, which these are not");
}

void checkGrid(const VaryingStencil& a) {
  poisson(a.grid);
  const int rank = a.grid.rank();
  const bool isKnown =
      std::ranges::any_of(std::array{Neighbourhood::Sides, Neighbourhood::Edges, Neighbourhood::All},
                          [&](Neighbourhood n) { return a.offsets == neighbourOffsets(rank, n); });
  if (!isKnown)
    throw sk::Error("the offsets of a stencil that varies are those of diffusion(), in its order",
                    sk::Error::Kind::Shape);
  checkGridSize(a.grid, a.count());
  if (static_cast<std::int64_t>(a.value.size()) != a.count() * a.size())
    throw sk::Error(fmt::format("a grid of {} elements with {} offsets has {} values, not {}", a.size(),
                                a.count(), a.count() * a.size(), a.value.size()),
                    sk::Error::Kind::Shape);
}

}  // namespace sk::linear
