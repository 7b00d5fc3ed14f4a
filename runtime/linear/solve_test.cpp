// SPDX-License-Identifier: MIT
//
// Solves whose outcome is known: what converges, to which residual, and what each failure is called.
#include <cmath>
#include <memory>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>
#include <sk/sk.hpp>

#include "layout.hpp"
#include "solve.hpp"
#include "sparse.hpp"
#include "stencil.hpp"
#include "test_solves.hpp"

namespace sk::linear {
namespace {

std::vector<double> ones(std::int64_t n) { return std::vector<double>(static_cast<std::size_t>(n), 1.0); }

/// Convection against diffusion on a line: not symmetric.
SparseMatrix convection(std::int64_t n) {
  std::vector<Entry> entries;
  for (std::int64_t i = 0; i < n; ++i) {
    entries.push_back({i, i, 2.0});
    if (i > 0) entries.push_back({i, i - 1, -1.4});
    if (i + 1 < n) entries.push_back({i, i + 1, -0.6});
  }
  return assemble(n, n, entries);
}

SparseMatrix diagonalMatrix(const std::vector<double>& d) {
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < d.size(); ++i)
    entries.push_back({static_cast<std::int64_t>(i), static_cast<std::int64_t>(i), d[i]});
  return assemble(static_cast<std::int64_t>(d.size()), static_cast<std::int64_t>(d.size()), entries);
}

TEST_CASE("Every solver and preconditioner reaches the tolerance in double precision") {
  sk::Device device = sk::Device::native();
  const SparseMatrix symmetric = assemble(poisson({17, 19})), other = convection(101);
  for (const MethodKind& method : methodKinds()) {
    const SparseMatrix& a = method.needsSymmetry ? symmetric : other;
    const std::vector<double> b = multiply(a, wavy(a.columns));
    for (const PreconditionerKind& preconditioner : preconditionerKinds()) {
      if (preconditioner.name == "multigrid") break;  // this one and the next are for grids
      if (method.name == "stationary" && (preconditioner.name == "none" || preconditioner.name == "spai0"))
        continue;
      if (method.name == "sor" && preconditioner.name != "none") continue;  // has none
      if (method.needsSymmetry && !preconditioner.isSymmetric) continue;
      if (!method.needsSymmetry && preconditioner.needsSymmetry) continue;
      CAPTURE(method.name, preconditioner.name);
      const Solution s =
          solveWith(device, a, b, {.solver = method.name, .preconditioner = preconditioner.name});
      CHECK(s.outcome == Outcome::Converged);
      CHECK(s.residualTrue <= 1e-8);
      CHECK(s.iterations < 6000);
    }
  }
}

TEST_CASE("Refinement reaches the backward error of double precision from each precision") {
  sk::Device device = sk::Device::native();
  const SparseMatrix a = assemble(poisson({16, 16}));
  const std::vector<double> b = multiply(a, ones(a.columns));
  const Arithmetic precisions[] = {
      {},
      {.precision = sk::Precision::Half, .matrix = sk::Storage::Half, .vectors = sk::Storage::Half},
      {.precision = sk::Precision::Single, .matrix = sk::Storage::Half, .vectors = sk::Storage::Single},
      doubles};
  for (const Arithmetic& arithmetic : precisions) {
    CAPTURE(static_cast<int>(arithmetic.precision), static_cast<int>(arithmetic.vectors));
    const Solution s = solveWith(device, a, b, {.arithmetic = arithmetic, .settings = {.tolerance = 1e-14}});
    CHECK(s.outcome == Outcome::Converged);
    CHECK(s.backwardError < 1e-15);
    const double error = std::abs(s.x[100] - 1.0);
    CHECK(error < 1e-11);  // cond(A) is about 120
  }
}

/// ||b - A x|| / ||b|| with 113 bits.
double residualInQuad(const SparseMatrix& a, const std::vector<double>& x, const std::vector<double>& b) {
  using Quad = __float128;
  Quad residual = 0, norm = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    Quad r = b[i];
    for (auto k = static_cast<std::size_t>(a.starts[i]); k < static_cast<std::size_t>(a.starts[i + 1]); ++k)
      r -= Quad(a.value[k]) * Quad(x[static_cast<std::size_t>(a.column[k])]);
    residual += r * r;
    norm += Quad(b[i]) * Quad(b[i]);
  }
  return std::sqrt(static_cast<double>(residual / norm));
}

TEST_CASE(
    "The reported residual is the true one to 1 %, also where doubles leave only rounding errors of it") {
  // Hilbert's matrix and a right-hand side for which x is huge: ||A|| ||x|| is up to 10^12 times ||b||.
  const SparseMatrix bad = hilbert(12), grid = assemble(poisson({13, 11}));
  for (const char* profile : {"native", "essl300"}) {  // the device computes residuals, and the host
    sk::Device device = deviceNamed(profile);
    for (const SparseMatrix* a : {&bad, &grid}) {
      const std::vector<double> b = wavy(a->rows);
      for (const double tolerance : {1e-2, 1e-8, 1e-15, 0.0}) {
        for (const Arithmetic& arithmetic : {Arithmetic{}, doubles}) {
          const bool inDoubles = arithmetic.precision == sk::Precision::Double;
          if (inDoubles && profile != std::string_view("native")) continue;
          CAPTURE(profile, a->rows, tolerance, inDoubles);
          const Solution s = solveWith(
              device, *a, b,
              {.arithmetic = arithmetic, .settings = {.tolerance = tolerance, .most = 300, .every = 8}});
          const double exact = residualInQuad(*a, s.x, b);
          CHECK(std::abs(s.residualTrue - exact) <= s.residualError);
          CHECK(s.residualError <= 0.01001 * exact);
        }
      }
    }
  }
}

TEST_CASE("Devices that draw solve like native ones") {
  const SparseMatrix a = assemble(poisson({9, 10}));
  const std::vector<double> b = multiply(a, ones(a.columns));
  for (const char* profile : {"glsl330", "essl300"}) {
    sk::Device device = deviceNamed(profile);
    const bool isEs = std::string_view(profile) == "essl300";
    for (const std::string_view solver :
         isEs ? std::vector<std::string_view>{"cg", "bicgstab", "sor", "pipelined"}
              : std::vector<std::string_view>{"cg", "gmres", "chebyshev"}) {
      CAPTURE(profile, solver);
      const Solution s =
          solveWith(device, a, b, {.solver = solver, .settings = {.tolerance = isEs ? 1e-6 : 1e-12}});
      CHECK(s.outcome == Outcome::Converged);
    }
  }
}

TEST_CASE("Fused iterations for stencils are those of a stored matrix") {
  for (const sk::Shape& grid : {sk::Shape{9, 14}, sk::Shape{5, 6, 7}}) {
    const Stencil stencil = poisson(grid);
    const std::vector<double> b = multiply(stencil, ones(stencil.size()));
    const Operator o = operatorOf(stencil);
    for (const bool isDrawn : {false, true}) {
      sk::Device device = deviceNamed(isDrawn ? "essl300" : "native");
      const auto stored =
          solveWith(device, assemble(stencil), b, {.preconditioner = "none", .layout = "rows"});
      const std::unique_ptr<Matrix> matrix = makeMatrix(scaled(stencil, o.scale), Arithmetic{});
      REQUIRE(matrix->isFused());
      const Solution fused = solveBy(device, *matrix, o, b, {.preconditioner = "none"});
      CHECK(fused.outcome == Outcome::Converged);
      CHECK(std::abs(fused.iterations - stored.iterations) <= 2);
    }
  }
}

TEST_CASE("Minimal residuals solve what is indefinite, and what is singular and compatible") {
  const SparseMatrix indefinite = shifted(assemble(poisson({9, 11})), 2.05);
  const std::vector<double> b = multiply(indefinite, ones(99));
  std::vector<Entry> ends;  // a line whose ends are free
  for (std::int64_t i = 0; i + 1 < 30; ++i)
    for (const Entry& e : {Entry{i, i, 1}, Entry{i + 1, i + 1, 1}, Entry{i, i + 1, -1}, Entry{i + 1, i, -1}})
      ends.push_back(e);
  const SparseMatrix free = assemble(30, 30, ends);
  std::vector<double> balanced(30, 0.0);
  balanced[3] = 1.0;
  balanced[20] = -1.0;
  for (const bool isDrawn : {false, true}) {
    sk::Device device = deviceNamed(isDrawn ? "glsl330" : "native");
    const Solution s = solveWith(device, indefinite, b, {.solver = "minres", .preconditioner = "none"});
    CHECK(s.outcome == Outcome::Converged);
    CHECK(s.iterations < 400);
    CHECK(solveWith(device, free, balanced, {.solver = "minres", .preconditioner = "jacobi"}).outcome ==
          Outcome::SingularAndCompatible);
  }
  sk::Device device = sk::Device::native();
  // A matrix with negative diagonal entries, whose quotients are no positive definite preconditioner.
  SparseMatrix negative = assemble(poisson({6, 5}));
  for (double& v : negative.value) v = -v;
  CHECK(solveWith(device, negative, wavy(negative.rows), {.solver = "minres", .preconditioner = "jacobi"})
            .outcome == Outcome::NotPositiveDefinite);
  CHECK(solveWith(device, negative, wavy(negative.rows), {.solver = "minres", .preconditioner = "none"})
            .outcome == Outcome::Converged);
  CHECK(solveWith(device, free, ones(30), {.solver = "minres"}).outcome == Outcome::SingularAndIncompatible);
}

TEST_CASE("What cannot be solved says why") {
  sk::Device device = sk::Device::native();
  const std::vector<double> b = ones(4);
  const auto outcomeOf = [&](const SparseMatrix& a, const Choice& choice) {
    const Solution s = solveWith(device, a, b, choice);
    for (const double x : s.x) CHECK(std::isfinite(x));
    return s.outcome;
  };
  CHECK(outcomeOf(diagonalMatrix({1, 2, -3, 4}), {.preconditioner = "none"}) == Outcome::NotPositiveDefinite);
  const Entry turned[] = {{0, 1, 1}, {1, 0, -1}, {2, 3, 1}, {3, 2, -1}};  // r . A r = 0
  CHECK(outcomeOf(assemble(4, 4, turned), {.solver = "bicgstab", .preconditioner = "none"}) ==
        Outcome::Breakdown);
  CHECK(outcomeOf(assemble(poisson({2, 2})), {.settings = {.tolerance = 0.0, .most = 0}}) ==
        Outcome::MostIterations);

  const SparseMatrix empty = assemble(4, 4, {});
  CHECK_THROWS_WITH(outcomeOf(empty, {}), Catch::Contains("row 1 has no diagonal entry"));
  CHECK(outcomeOf(empty, {.preconditioner = "none"}) == Outcome::NotPositiveDefinite);
  CHECK_THROWS_WITH(solveWith(device, diagonalMatrix({1, 2, 3}), b, {}),
                    "the right-hand side has 4 elements, and the matrix 3 rows");
  CHECK_THROWS_WITH(solveWith(device, diagonalMatrix({1, 2, 3, 4}), {1, 2, NAN, 4}, {}),
                    Catch::Contains("not finite"));
}

TEST_CASE("A tolerance below the roundoff ends as stagnated, with the best that was found") {
  sk::Device device = sk::Device::native();
  const SparseMatrix a = assemble(poisson({7, 5}));
  std::vector<double> b;
  for (int i = 0; i < 35; ++i) b.push_back(1.0 / (i + 3));
  const Solution fine = solveWith(device, a, b, {.settings = {.tolerance = 1e-18}});
  CHECK(fine.outcome == Outcome::Stagnated);
  CHECK(fine.backwardError < 1e-15);
  const Solution once = solveWith(device, a, b, {.settings = {.tolerance = 1e-12, .refines = false}});
  CHECK(once.outcome == Outcome::Stagnated);
  CHECK(once.residualRecurred <= 1e-12);
  CHECK(once.residualTrue > 1e-9);
}

TEST_CASE("A residual that falls no more ends the iterations") {
  sk::Device device = sk::Device::native();
  const SparseMatrix a = assemble(poisson({15, 15}));
  // Vectors of 11 bits, and a tolerance that asks for 26.
  const Solution s = solveWith(device, a, multiply(a, ones(225)),
                               {.arithmetic = {.matrix = sk::Storage::Half, .vectors = sk::Storage::Half},
                                .settings = {.refines = false}});
  CHECK(s.outcome == Outcome::Stagnated);
  CHECK(s.iterations < 2000);
}

TEST_CASE("A right-hand side of zeros, and matrices of any magnitude, are solved") {
  sk::Device device = sk::Device::native();
  const SparseMatrix a = assemble(poisson({5, 5}));
  const Solution zero = solveWith(device, a, std::vector<double>(25, 0.0), {});
  CHECK(zero.outcome == Outcome::Converged);
  CHECK(zero.iterations == 0);
  CHECK(zero.x == std::vector<double>(25, 0.0));
  for (const double magnitude : {1e-30, 1e30}) {
    CAPTURE(magnitude);
    const SparseMatrix tiny = scaled(a, magnitude);
    const Solution s = solveWith(device, tiny, multiply(tiny, ones(25)), {});
    CHECK(s.outcome == Outcome::Converged);
    CHECK(std::abs(s.x[12] - 1.0) < 1e-7);
    CHECK(solveWith(device, tiny, ones(25), {}).outcome == Outcome::Converged);
  }
  const SparseMatrix spread = diagonalMatrix({1e-30, 1e30, 1, -1e-20 * -1.0});
  CHECK(solveWith(device, diagonalMatrix({1, 1e5, 1e-5, 3}), ones(4), {}).outcome == Outcome::Converged);
  CHECK(operatorOf(spread).scale == 0x1p-100);
}

TEST_CASE("A matrix whose rows sum to zero is known to be singular") {
  const Entry neumann[] = {{0, 0, 1}, {0, 1, -1}, {1, 0, -1}, {1, 1, 2}, {1, 2, -1}, {2, 1, -1}, {2, 2, 1}};
  CHECK(operatorOf(assemble(3, 3, neumann)).hasConstantKernel);
  CHECK(!operatorOf(assemble(poisson({3, 3}))).hasConstantKernel);
}

TEST_CASE("Asymmetry is told with its place") {
  CHECK(asymmetry(assemble(poisson({3, 4}))).empty());
  CHECK(asymmetry(convection(3)) == "entry (1, 2) is -0.6, and (2, 1) is -1.4");
  CHECK_THROWS_WITH(operatorOf(assemble(2, 3, {})), Catch::Contains("2 x 3"));
}

}  // namespace
}  // namespace sk::linear
