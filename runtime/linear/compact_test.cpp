// SPDX-License-Identifier: MIT
//
// The orders of discretisations, measured with solutions that are known.
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <catch2/catch.hpp>
#include <sk/sk.hpp>

#include "compact.hpp"
#include "test_solves.hpp"

namespace sk::linear {
namespace {

/// The largest error of the solution by conjugate gradients with multigrid in doubles.
double errorAt(sk::Device& device, int rank, std::int64_t n, bool isCompact) {
  const KnownSolution known(rank, n);
  const VaryingStencil compact = compactPoisson(known.grid);
  const SparseMatrix sparse = assemble(compact);
  Operator a = isCompact ? operatorOf(sparse) : operatorOf(known.grid);
  if (isCompact) a.varying = &compact;
  const std::unique_ptr<Matrix> matrix = isCompact ? makeMatrix(device, scaled(compact, a.scale), doubles)
                                                   : makeMatrix(scaled(known.grid, a.scale), doubles);
  const Solution s = solveBy(
      device, *matrix, a, isCompact ? known.fourthOrder() : known.secondOrder(),
      {.preconditioner = "multigrid", .arithmetic = doubles, .settings = {.tolerance = 1e-11, .every = 1}});
  CHECK(s.outcome == Outcome::Converged);
  CHECK(s.iterations < 25);
  return known.errorOf(s.x);
}

TEST_CASE("Errors fall with the second and the fourth power of the spacing") {
  sk::Device device = sk::Device::native();
  for (const int rank : {2, 3})
    for (const bool isCompact : {false, true}) {
      CAPTURE(rank, isCompact);
      const std::int64_t n = rank == 2 ? 31 : 15;
      const double coarse = errorAt(device, rank, n, isCompact),
                   fine = errorAt(device, rank, 2 * n + 1, isCompact);
      CHECK(std::log2(coarse / fine) == Approx(isCompact ? 4.0 : 2.0).margin(0.1));
    }
  CHECK(errorAt(device, 2, 31, true) < errorAt(device, 2, 31, false) / 100);
}

TEST_CASE("Compact discretisations keep their order at Neumann and periodic ends") {
  constexpr double pi = std::numbers::pi;
  /// The residual of cos(pi x) cos(2 pi y) cos(pi z), which is as large as the sixth power of the spacing.
  const auto residual = [&](int rank, std::int64_t n) {
    std::vector<Ends> ends{mirrors, mirrors, mirrors};
    ends.resize(static_cast<std::size_t>(rank));
    ends[1] = ring;
    const Stencil grid = withEnds(poisson(rank == 2 ? sk::Shape{n, n} : sk::Shape{n, n, n}), ends);
    const double h = 1.0 / static_cast<double>(n);
    const GridFunction u = [&](const GridOffset& at) {
      double product = 1.0;
      for (std::size_t d = 0; d < static_cast<std::size_t>(rank); ++d)
        product *= std::cos((d == 1 ? 2.0 : 1.0) * pi * h * (at[d] + 0.5));
      return product;
    };
    const double eigenvalue = pi * pi * (rank + 3);
    const std::vector<double> b =
        compactLoad(grid, h, [&](const GridOffset& at) { return eigenvalue * u(at); });
    std::vector<double> values;
    const GridWalk walk(grid.grid);
    GridOffset at{};
    for (std::int64_t i = 0; i < grid.size(); ++i, walk.advance(at)) values.push_back(u(at));
    const SparseMatrix a = assemble(compactPoisson(grid));
    CHECK(asymmetry(a).empty());
    const std::vector<double> product = multiply(a, values);
    double largest = 0.0;
    for (std::size_t i = 0; i < b.size(); ++i) largest = std::max(largest, std::abs(product[i] - b[i]));
    return largest;
  };
  for (const int rank : {2, 3})
    CHECK(std::log2(residual(rank, 10) / residual(rank, 20)) == Approx(6.0).margin(0.3));
}

}  // namespace
}  // namespace sk::linear
