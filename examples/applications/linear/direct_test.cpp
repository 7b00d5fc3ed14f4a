// SPDX-License-Identifier: MIT
//
// Direct solutions: by which factors, how exact, and what is refused.
#include "direct.hpp"

#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "precise.hpp"
#include "test_solves.hpp"

namespace linear {
namespace {

/// Backward errors of factorisations are a few roundings; growth of pivots, and of rows, may multiply them by hundreds.
constexpr double most = 1e-13;

double residualOf(const Operator& a, const std::vector<double>& b, const std::vector<double>& x) {
  return preciseResidual(a, 1.0, x, b).norms.two / norm(b);
}

TEST_CASE("Symmetric matrices have factors L D L^T, and others L U") {
  const SparseMatrix plane = assemble(poisson({21, 17}));
  const std::vector<double> b = randomVector(357, 1);
  const DirectSolution first = solveDirectly(operatorOf(plane), b);
  CHECK(first.factors == "L D L^T");
  CHECK(first.entries >= 357 + 20 * 17);
  CHECK(residualOf(operatorOf(plane), b, first.x) < most);
  CHECK(solveDirectly(operatorOf(poisson({21, 17})), b).x == first.x);

  SparseMatrix turned = plane;
  turned.value[1] = -3.0;
  const DirectSolution second = solveDirectly(operatorOf(turned), b);
  CHECK(second.factors == "L U");
  CHECK(residualOf(operatorOf(turned), b, second.x) < most);

  const Entry exchange[] = {{0, 1, 2.0}, {1, 0, 2.0}};  // symmetric, and has no L D L^T
  const SparseMatrix a = assemble(2, 2, exchange);
  const DirectSolution third = solveDirectly(operatorOf(a), std::vector<double>{4.0, 6.0});
  CHECK(third.factors == "L U");
  CHECK(third.x == std::vector<double>{3.0, 2.0});
  CHECK(solveDirectly(operatorOf(assemble(0, 0, {})), {}).x.empty());
}

TEST_CASE("Singular matrices and wrong right-hand sides are refused") {
  const Entry ones[] = {{0, 0, 1.0}, {0, 1, 1.0}, {1, 0, 1.0}, {1, 1, 1.0}};
  CHECK_THROWS_WITH(solveDirectly(operatorOf(assemble(2, 2, ones)), std::vector<double>{1.0, 2.0}),
                    Catch::StartsWith("the matrix is singular, so that it has no factors"));
  const Entry neumann[] = {{0, 0, 1.0}, {0, 1, -1.0}, {1, 0, -1.0}, {1, 1, 1.0}};
  CHECK_THROWS_WITH(solveDirectly(operatorOf(assemble(2, 2, neumann)), std::vector<double>{1.0, -1.0}),
                    Catch::StartsWith("the matrix is singular, for its rows add up to 0"));
  CHECK_THROWS_WITH(solveDirectly(operatorOf(assemble(2, 2, ones)), std::vector<double>{1.0}),
                    "the right-hand side has 1 elements, and the matrix 2 rows");
}

}  // namespace
}  // namespace linear
