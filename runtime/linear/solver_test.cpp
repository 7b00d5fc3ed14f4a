// SPDX-License-Identifier: MIT
//
// What sk/linear.hpp promises: solutions and their true residuals, updates, and errors that name what is wrong and the way out.
#include <sk/linear.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "sparse.hpp"
#include "test_solves.hpp"

namespace sk::linear {
namespace {

/// ||b - A x|| / ||b|| in doubles.
double residualOf(const SparseMatrix& a, const std::vector<double>& b, const std::vector<double>& x) {
  std::vector<double> r = multiply(a, x);
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = b[i] - r[i];
  return norm(r) / norm(b);
}

/// An upwind discretisation, which is not symmetric.
SparseMatrix upwind(std::int64_t n) {
  std::vector<Entry> entries;
  for (std::int64_t i = 0; i < n; ++i) {
    entries.push_back({i, i, 2.5});
    if (i > 0) entries.push_back({i, i - 1, -1.5});
    if (i + 1 < n) entries.push_back({i, i + 1, -1.0});
  }
  return assemble(n, n, entries);
}

std::string errorOf(const auto& call, sk::Error::Kind kind = sk::Error::Kind::Misuse) {
  try {
    call();
  } catch (const sk::Error& error) {
    CHECK(error.kind() == kind);
    return error.what();
  }
  return "";
}

TEST_CASE("Every solver finds solutions whose true residual is within the tolerance") {
  sk::Device device = sk::Device::native();
  const SparseMatrix a = assemble(poisson({11, 9}));
  const std::vector<double> b = randomVector(99, 1);
  for (const Named& solver : solvers()) {
    CAPTURE(solver.name);
    const Solution s = solve(device, a, b, {.solver = std::string(solver.name), .tolerance = 1e-10});
    CHECK(s.isSolved());
    CHECK(s.outcome == Outcome::Converged);
    CHECK(s.iterations > 0);
    // The residual is computed here in doubles, with rounding errors of 6 products and sums of elements of x, of which none is larger than 100 times b's.
    CHECK(residualOf(a, b, s.x) == Approx(s.residualTrue).margin(1e-12));
    CHECK(s.residualTrue <= 1e-10);
    CHECK(s.residualError <= 0.01 * s.residualTrue);
  }
}

TEST_CASE("A solver takes many right-hand sides, and its device may be any") {
  for (sk::Device& device : testDevices()) {
    CAPTURE(device.profile());
    const SparseMatrix a = upwind(50);
    Solver solver(device, a, {.solver = "bicgstab", .preconditioner = "jacobi"});
    CHECK(solver.unknowns() == 50);
    CHECK(solver.layout() == "diagonals");
    CHECK(solver.storedEntries() == 150);
    for (const unsigned seed : {1, 2, 3}) {
      const std::vector<double> b = randomVector(50, seed);
      const Solution s = solver.solve(b);
      CHECK(s.isSolved());
      CHECK(residualOf(a, b, s.x) <= 1.01e-8);
    }
  }
}

TEST_CASE("Grids are solved by multigrid, and no entry of a stencil is stored") {
  sk::Device device = sk::Device::native();
  const std::array ends{Ends{Side::Neumann, Side::Dirichlet}, Ends{Side::Periodic, Side::Periodic}};
  const Stencil grid = withEnds(poisson({21, 30}), ends);
  const std::vector<double> b = randomVector(630, 4);
  Solver plain(device, grid, {.preconditioner = "multigrid"});
  CHECK(plain.storedEntries() == 0);
  const Solution s = plain.solve(b);
  CHECK(s.isSolved());
  CHECK(s.iterations <= 20);
  CHECK(residualOf(assemble(grid), b, s.x) <= 1.01e-8);

  std::vector<double> coefficient(630, 1.0);
  for (std::size_t i = 0; i < 300; ++i) coefficient[i] = 1e4;
  const VaryingStencil jumps = diffusion(grid, coefficient);
  const Solution t = Solver(device, jumps, {.preconditioner = "multigrid"}).solve(b);
  CHECK(t.isSolved());
  CHECK(t.iterations <= 25);
  CHECK(residualOf(assemble(jumps), b, t.x) <= 1.01e-8);
}

TEST_CASE("A solver follows other values of the same entries, with every preconditioner") {
  sk::Device device = sk::Device::native();
  const SparseMatrix a = assemble(poisson({9, 8}));
  const std::vector<double> b = randomVector(72, 2);
  for (const Named& preconditioner : preconditioners()) {
    if (preconditioner.does.find("grid") != std::string_view::npos ||
        preconditioner.name.ends_with("cycle") || preconditioner.name == "full")
      continue;
    for (const std::string solver : {"gmres", "sor"}) {
      CAPTURE(preconditioner.name, solver);
      Solver repeated(device, a, {.solver = solver, .preconditioner = std::string(preconditioner.name)});
      CHECK(repeated.solve(b).isSolved());
      // Symmetric, with larger diagonals, and 1000 times as large, so that the power of two that scales it changes, too.
      SparseMatrix other = shifted(scaled(a, 1000.0), -700.0);
      repeated.update(other);
      const Solution s = repeated.solve(b);
      CHECK(s.isSolved());
      CHECK(residualOf(other, b, s.x) <= 1.01e-8);
    }
  }
}

TEST_CASE("An update that fails leaves a solver that says so, and a later one repairs it") {
  sk::Device device = sk::Device::native();
  const SparseMatrix a = assemble(poisson({4, 4}));
  const std::vector<double> b(16, 1.0);
  Solver solver(device, a);
  SparseMatrix wrong = a;
  wrong.value[0] = std::numeric_limits<double>::infinity();
  CHECK(errorOf([&] { solver.update(wrong); }) == "entry (1, 1) of the matrix is inf, which is not finite");
  CHECK(solver.solve(b).isSolved());  // the old matrix
  wrong = a;
  wrong.value[1] = 7.0;
  CHECK(errorOf([&] { solver.update(wrong); }) ==
        "the solver 'cg' needs a symmetric matrix: entry (1, 2) is 7, and (2, 1) is -1; take the solver "
        "'gmres' or "
        "'bicgstab'");
  CHECK(errorOf([&] {
          solver.solve(b);
        }).starts_with("the solver has no matrix, because its last update failed"));
  solver.update(a);
  CHECK(solver.solve(b).isSolved());
  CHECK(errorOf([&] { solver.update(assemble(poisson({2, 8}))); }, sk::Error::Kind::Shape)
            .starts_with("an update has its entries where the solver's matrix has them"));
  CHECK(errorOf([&] {
          Solver(device, poisson({4, 4})).update(a);
        }).starts_with("an update takes other values of a sparse matrix, and this one is of a grid"));
}

TEST_CASE("What cannot be solved is refused with what is wrong and the way out") {
  sk::Device device = sk::Device::native();
  const SparseMatrix a = assemble(poisson({3, 3}));
  const std::vector<double> b(9, 1.0);
  const auto error = [&](const SparseMatrix& m, const Options& options,
                         sk::Error::Kind kind = sk::Error::Kind::Misuse) {
    return errorOf([&] { Solver(device, m, options); }, kind);
  };
  CHECK(error(a, {.solver = "gauss"}) ==
        "no solver is called 'gauss'; there are cg, pipelined, chebyshev, minres, stationary, sor, bicgstab, "
        "gmres");
  CHECK(error(a, {.preconditioner = "lu"})
            .starts_with("no preconditioner is called 'lu'; there are none, jacobi"));
  CHECK(error(a, {.layout = "csr"}).starts_with("no layout is called 'csr'; there are rows"));
  CHECK(error(a, {.tolerance = -1}) == "the option 'tolerance' is -1; it is from 0 to 1");
  CHECK(error(a, {.tolerance = NAN}) == "the option 'tolerance' is nan; it is from 0 to 1");
  CHECK(error(a, {.most = -1}) == "the option 'most' is -1; it is 0 or more iterations");
  CHECK(error(a, {.restart = 0}) == "the option 'restart' is 0; it is from 1 to 1000 steps");
  CHECK(error(a, {.omega = 2}) == "the option 'omega' is 2; it is between 0 and 2");
  CHECK(error(a, {.ordering = "rows"}) == "the option 'ordering' is rows; it is colours or levels");
  CHECK(error(a, {.preconditioner = "ilu0"}) ==
        "the solver 'cg' needs a symmetric preconditioner, which 'ilu0' is not; take the solver 'gmres'");
  CHECK(error(a, {.preconditioner = "multigrid"}).starts_with("multigrid needs a grid"));
  CHECK(error(a, {.layout = "stencil"}).starts_with("the layout 'stencil' is for matrices of grids"));
  CHECK(error(assemble(2, 3, {}), {}, sk::Error::Kind::Shape) ==
        "a system of equations has a square matrix; this one has 2 x 3");
  CHECK(error(upwind(4), {}) ==
        "the solver 'cg' needs a symmetric matrix: entry (1, 2) is -1, and (2, 1) is -1.5; take the solver "
        "'gmres' or "
        "'bicgstab'");
  const Entry noDiagonal[] = {{0, 1, 1.0}, {1, 0, 1.0}};
  CHECK(error(assemble(2, 2, noDiagonal), {}) ==
        "row 1 has no diagonal entry, or 0, and the preconditioner 'jacobi' divides by it; take the "
        "preconditioner "
        "'none'");
  SparseMatrix wrong = a;
  wrong.value[4] = NAN;
  CHECK(error(wrong, {}) == "entry (2, 2) of the matrix is nan, which is not finite");
  wrong = a;
  wrong.column[1] = 9;
  CHECK(error(wrong, {}, sk::Error::Kind::Shape) ==
        "the matrix has columns in row 1 that do not ascend from 1 to 9; assemble() makes one of entries");
  wrong = a;
  wrong.starts.pop_back();
  CHECK(error(wrong, {}, sk::Error::Kind::Shape).starts_with("the matrix has 9 rows and 9 starts of rows"));
  wrong = a;
  std::swap(wrong.starts[2], wrong.starts[3]);
  CHECK(error(wrong, {}, sk::Error::Kind::Shape)
            .starts_with("the matrix has a row 3 that ends before it begins"));
  wrong = a;
  wrong.starts.back() = 40;
  CHECK(error(wrong, {}, sk::Error::Kind::Shape)
            .starts_with("the matrix has 33 columns of entries, 33 values"));

  Solver solver(device, a);
  CHECK(errorOf([&] { solver.solve(std::vector<double>(8)); }, sk::Error::Kind::Shape) ==
        "the right-hand side has 8 elements, and the matrix 9 rows");
  std::vector<double> nan = b;
  nan[3] = NAN;
  CHECK(errorOf([&] { solver.solve(nan); }) ==
        "element 4 of the right-hand side is nan, which is not finite");
  CHECK(errorOf([&] { multiply(a, std::vector<double>(8)); }, sk::Error::Kind::Shape) ==
        "the vector has 8 elements, and the matrix 9 columns");
  Stencil infinite = poisson({3, 3});
  infinite.centre = INFINITY;
  CHECK(errorOf([&] {
          Solver(device, infinite);
        }).starts_with("the coefficients of a stencil are finite numbers"));
  CHECK(errorOf([&] { Solver(device, VaryingStencil{.grid = {3, 3}, .offsets = {{0, 0, 0}}, .value = b}); },
                sk::Error::Kind::Shape)
            .starts_with("the offsets of a stencil that varies are those of diffusion()"));
  sk::Device small(sk::DeviceOptions{.device = "native", .memoryLimit = 100});
  CHECK(errorOf([&] { Solver(small, a); }, sk::Error::Kind::Memory)
            .starts_with("a matrix of 9 unknowns needs about "));
}

TEST_CASE("No unknowns are solved, and a solution that is not found is an outcome") {
  sk::Device device = sk::Device::native();
  CHECK(solve(device, assemble(0, 0, {}), {}).isSolved());
  CHECK(errorOf([&] { solve(device, assemble(0, 0, {}), std::vector<double>(1)); }, sk::Error::Kind::Shape) ==
        "the right-hand side has 1 elements, and the matrix 0 rows");
  int calls = 0;
  const Solution s = solve(device, assemble(poisson({20, 20})), std::vector<double>(400, 1.0),
                           {.most = 4, .progress = [&](std::int64_t, double) { ++calls; }});
  CHECK(s.outcome == Outcome::MostIterations);
  CHECK(!s.isSolved());
  CHECK(s.residualTrue > 1e-8);
  CHECK(calls > 0);
  CHECK(nameOf(s.outcome) == "most iterations");
}

}  // namespace
}  // namespace sk::linear
