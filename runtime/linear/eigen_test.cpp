// SPDX-License-Identifier: MIT
//
// Solutions beside those of Eigen's direct solvers in double precision, for systems that are hard in some way.
#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <sk/sk.hpp>

#include "layout.hpp"
#include "ordering.hpp"
#include "residual.hpp"
#include "solve.hpp"
#include "sparse.hpp"
#include "stencil.hpp"
#include "test_eigen.hpp"
#include "test_solves.hpp"
#include "text/named.hpp"

namespace sk::linear {
namespace {

/// ||x - y|| / ||y|| against what a residual of that size may mean: ||A^-1|| ||r|| / ||y||, and Eigen's own roundings. Frobenius norms
/// of matrices bound their 2-norms.
void checkSolution(const SparseMatrix& a, const std::vector<double>& b, const Solution& s) {
  const Eigen::MatrixXd m = eigenOf(a);
  const Eigen::FullPivLU<Eigen::MatrixXd> factors(m);
  const Eigen::VectorXd expected = factors.solve(vectorOf(b));
  const double inverseNorm = factors.inverse().norm();
  const double residual = (vectorOf(b) - m * vectorOf(s.x)).norm();
  const double condition = m.norm() * inverseNorm;
  CHECK((vectorOf(s.x) - expected).norm() <=
        inverseNorm * residual + 64.0 * condition * 0x1p-53 * expected.norm());
  // The solver's own account of the residual.
  CHECK(std::abs(residual / vectorOf(b).norm() - s.residualTrue) <= 1e-6 * s.residualTrue + 1e-14);
}

/// -div (along grad u) + (wind, wind) . grad u on a grid, by central differences.
SparseMatrix transport(std::int64_t w, std::int64_t h, double alongY, double wind) {
  std::vector<Entry> entries;
  for (std::int64_t y = 0; y < h; ++y)
    for (std::int64_t x = 0; x < w; ++x) {
      const std::int64_t i = y * w + x;
      entries.push_back({i, i, 2.0 + 2.0 * alongY});
      if (x > 0) entries.push_back({i, i - 1, -1.0 - wind});
      if (x + 1 < w) entries.push_back({i, i + 1, -1.0 + wind});
      if (y > 0) entries.push_back({i, i - w, -alongY - wind});
      if (y + 1 < h) entries.push_back({i, i + w, -alongY + wind});
    }
  return assemble(w * h, w * h, entries);
}

TEST_CASE("Solutions are Eigen's, on devices of every precision") {
  const SparseMatrix anisotropic = transport(7, 5, 1e-3, 0.0), windy = transport(7, 5, 1.0, 0.4);
  const std::vector<double> b = wavy(35);
  for (const char* name : {"native", "reference", "reference:quad"}) {
    sk::Device device(name);
    for (const std::string_view solver :
         {"cg", "pipelined", "chebyshev", "minres", "gmres", "bicgstab", "sor"}) {
      CAPTURE(name, solver);
      const bool isSymmetric = text::rowNamed(methodKinds(), solver, "solver").needsSymmetry;
      const SparseMatrix& a = isSymmetric ? anisotropic : windy;
      const Solution s = solveWith(device, a, b, {.solver = solver, .settings = {.tolerance = 1e-11}});
      CHECK(s.outcome == Outcome::Converged);
      checkSolution(a, b, s);
    }
    // Far from rounding errors, only norms come to the host.
    CHECK(
        solveWith(device, anisotropic, b, {.solver = "cg", .settings = {.tolerance = 1e-4}}).residualPlace ==
        "device");
  }
}

TEST_CASE("Incomplete factors and sweeps need fewer iterations, in either order") {
  sk::Device device = sk::Device::native();
  const SparseMatrix a = assemble(poisson({31, 29}));
  const std::vector<double> b = wavy(a.rows);
  const auto iterations = [&](std::string_view preconditioner, std::string_view ordering) {
    const Solution s =
        solveWith(device, a, b,
                  {.preconditioner = preconditioner, .settings = {.tolerance = 1e-6}, .ordering = ordering});
    CHECK(s.outcome == Outcome::Converged);
    return s.iterations;
  };
  const std::int64_t plain = iterations("jacobi", "colours");
  for (const std::string_view preconditioner : {"ssor", "ic0"})
    for (const std::string_view ordering : {"colours", "levels"}) {
      CAPTURE(preconditioner, ordering);
      CHECK(iterations(preconditioner, ordering) < 0.75 * static_cast<double>(plain));
    }
  CHECK(iterations("ic0", "levels") < iterations("ic0", "colours"));
}

TEST_CASE("Biconjugate gradients solve strong convection that begins at the boundary") {
  sk::Device device = sk::Device::native();
  for (const double wind : {0.9, 2.0}) {
    const SparseMatrix a = transport(48, 47, 1.0, wind);
    // A times ones is 0 but for the boundary.
    const std::vector<double> b = multiply(a, std::vector<double>(static_cast<std::size_t>(a.rows), 1.0));
    for (const std::string_view preconditioner : {"ssor", "ilu0"}) {
      CAPTURE(wind, preconditioner);
      const Solution s = solveWith(device, a, b,
                                   {.solver = "bicgstab",
                                    .preconditioner = preconditioner,
                                    .settings = {.tolerance = 1e-10, .every = 1}});
      CHECK(s.outcome == Outcome::Converged);
      CHECK(s.iterations < 200);
      double largest = 0.0;
      for (const HistoryPoint& point : s.history) largest = std::max(largest, point.residual);
      CHECK(largest < 1e4);  // residuals of 2^24 times b leave nothing of a float
    }
  }
}

TEST_CASE(
    "Orderings separate rows that depend on each other, and factors are exact where nothing is dropped") {
  const SparseMatrix a = transport(7, 5, 1.0, 0.3);
  CHECK(colours(a).groups() == 2);
  CHECK(levels(a).groups() == 11);  // the diagonals of the grid
  for (const Ordering& o : {colours(a), levels(a)}) {
    const SparseMatrix p = permuted(a, o.order);
    for (std::size_t g = 0; g + 1 < o.starts.size(); ++g)
      for (std::int64_t i = o.starts[g]; i < o.starts[g + 1]; ++i)
        for (auto k = static_cast<std::size_t>(p.starts[static_cast<std::size_t>(i)]);
             k < static_cast<std::size_t>(p.starts[static_cast<std::size_t>(i) + 1]); ++k)
          CHECK((p.column[k] == i || p.column[k] < o.starts[g] || p.column[k] >= o.starts[g + 1]));
  }
  SparseMatrix line = transport(13, 1, 0.0, 0.2);  // tridiagonal: its factors fill nothing
  const Eigen::MatrixXd expected = eigenOf(line);
  CHECK(factorise(line, true) == -1);
  const Eigen::MatrixXd factors = eigenOf(line);
  const Eigen::MatrixXd lower = factors.triangularView<Eigen::UnitLower>(),
                        upper = factors.triangularView<Eigen::Upper>();
  CHECK((lower * upper - expected).norm() <= 1e-14);
  SparseMatrix negative = scaled(transport(3, 3, 1.0, 0.0), -1.0);
  CHECK(factorise(negative, true) == 0);
}

TEST_CASE("Ill-conditioned systems report what they have reached") {
  sk::Device device = sk::Device::native();
  for (const std::int64_t n : {4, 8, 12}) {
    CAPTURE(n);
    const SparseMatrix a = hilbert(n);
    const std::vector<double> b = multiply(a, std::vector<double>(static_cast<std::size_t>(n), 1.0));
    for (const std::string_view solver : {"cg", "minres", "gmres"}) {
      const Solution s = solveWith(device, a, b, {.solver = solver, .layout = "dense"});
      CAPTURE(solver, s.residualTrue);
      CHECK((s.outcome == Outcome::Converged) == (s.residualTrue <= 1e-8));
      CHECK(s.residualTrue < 1e-4);
      CHECK((vectorOf(b) - eigenOf(a) * vectorOf(s.x)).norm() <=
            1.001 * s.residualTrue * vectorOf(b).norm() + 1e-15);
    }
  }
  // Conditions of 1e30 that a diagonal scaling takes away.
  std::vector<Entry> entries;
  const double rows[] = {1e-15, 1e15, 1.0, 1e-7, 1e7};
  for (std::int64_t i = 0; i < 5; ++i)
    for (std::int64_t j = 0; j < 5; ++j)
      if (std::abs(i - j) < 2) entries.push_back({i, j, (i == j ? 4.0 : -1.0) * rows[i] * rows[j]});
  const Solution s = solveWith(device, assemble(5, 5, entries), {1e-15, 0, 0, 0, 0}, {.solver = "cg"});
  for (const double x : s.x) CHECK(std::isfinite(x));
}

TEST_CASE("Singular, indefinite and tiny systems end with the outcome that they have") {
  sk::Device device = sk::Device::native();
  const SparseMatrix indefinite = shifted(transport(9, 7, 1.0, 0.0), 2.05);
  for (const std::string_view solver : {"minres", "gmres"}) {
    CAPTURE(solver);
    const Solution s = solveWith(device, indefinite, wavy(63),
                                 {.solver = solver, .preconditioner = "none", .method = {.restart = 63}});
    CHECK(s.outcome == Outcome::Converged);
    checkSolution(indefinite, wavy(63), s);
  }
  for (const std::string_view solver : {"cg", "pipelined", "chebyshev"})
    CHECK(solveWith(device, indefinite, wavy(63), {.solver = solver, .preconditioner = "none"}).outcome ==
          Outcome::NotPositiveDefinite);
  CHECK_THROWS_WITH(solveWith(device, scaled(indefinite, -1.0), wavy(63), {.preconditioner = "ic0"}),
                    Catch::Contains("is not positive definite"));

  const Entry zero[] = {{0, 1, 1.0}, {1, 0, 1.0}};
  CHECK_THROWS_WITH(
      solveWith(device, assemble(2, 2, zero), {1, 2}, {.solver = "sor", .preconditioner = "none"}),
      Catch::Contains("row 1 has no diagonal entry"));
  CHECK_THROWS_WITH(
      solveWith(device, assemble(2, 2, zero), {1, 2}, {.solver = "gmres", .preconditioner = "ilu0"}),
      Catch::Contains("pivot of 0 in row 1"));
  CHECK(solveWith(device, assemble(2, 2, zero), {1, 2}, {.solver = "gmres", .preconditioner = "none"}).x ==
        std::vector<double>{2, 1});
  const Entry one{0, 0, -3.0};
  for (const MethodKind& kind : methodKinds()) {
    if (kind.needsSymmetry && kind.name != "minres") continue;  // -3 is not positive
    CAPTURE(kind.name);
    const Solution s =
        solveWith(device, assemble(1, 1, std::span(&one, 1)), {6.0},
                  {.solver = kind.name, .preconditioner = kind.name == "minres" ? "none" : "jacobi"});
    CHECK(s.x == std::vector<double>{-2.0});
  }
}

TEST_CASE("Layouts agree, and store what they say") {
  const SparseMatrix a = transport(13, 11, 0.5, 0.0);
  const std::vector<double> b = wavy(a.rows);
  for (const char* name : {"native", "software"}) {
    sk::Device device(name);
    for (const LayoutKind& kind : layoutKinds()) {
      CAPTURE(name, kind.name);
      const Solution s = solveWith(device, a, b, {.layout = kind.name, .settings = {.tolerance = 1e-12}});
      CHECK(s.outcome == Outcome::Converged);
      CHECK(s.backwardError < 1e-12);
    }
  }
}

TEST_CASE("The device finds asymmetry, and the host its place") {
  const SparseMatrix a = transport(41, 37, 1.0, 0.0);
  SparseMatrix broken = a;
  broken.value[7001] *= 1.0 + 1e-9;
  for (const char* name : {"native", "software"}) {
    sk::Device device(name);
    const auto reason = [&](const SparseMatrix& m, std::string_view layout) {
      const Operator o = operatorOf(m);
      Arithmetic arithmetic;
      arithmetic.matrix = sk::Storage::Double;
      const auto matrix = makeMatrix(device, scaled(m, o.scale), layout, arithmetic);
      return asymmetryOnDevice(device, *matrix, o, arithmetic);
    };
    CAPTURE(name);
    CHECK(reason(a, "slices").empty());
    CHECK(reason(a, "rows").empty());
    CHECK_THAT(reason(broken, "slices"), Catch::StartsWith("entry ("));
    CHECK_THAT(reason(transport(41, 37, 1.0, 0.1), "rows"), Catch::StartsWith("entry ("));
  }
}

TEST_CASE("Residuals are those of double precision, wherever they are computed") {
  const SparseMatrix a = hilbert(20);
  const Operator o = operatorOf(a);
  const std::vector<double> b = wavy(20),
                            x = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20};
  const Eigen::VectorXd expected = vectorOf(b) - o.scale * (eigenOf(a) * vectorOf(x));
  for (const bool isDrawn : {false, true}) {
    sk::Device device = deviceNamed(isDrawn ? "essl300" : "native");
    for (const std::string_view layout : {"rows", "slices", "dense", "diagonals"}) {
      CAPTURE(isDrawn, layout);
      const auto matrix = makeMatrix(device, scaled(a, o.scale), layout, {});
      const auto residual = makeResidual(device, *matrix, o, {});
      CHECK(residual->place() == (isDrawn ? "host" : "device"));
      residual->start(b);
      Vector step = device.stream<float>({20});
      step.writeReals(x);
      const Norms norms = residual->attempt(step, 1.0);
      residual->accept();
      CHECK(std::abs(norms.two - expected.norm()) <= 1e-6 * expected.norm());
      Vector r = device.stream<float>({20}, sk::Storage::Double);
      residual->writeTo(r, 1.0);
      CHECK((vectorOf(r.readReals()) - expected).norm() <= 20 * 0x1p-53 * 20 * 20);
      CHECK(residual->solution() == x);
    }
  }
}

}  // namespace
}  // namespace sk::linear
