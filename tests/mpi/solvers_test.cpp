// SPDX-License-Identifier: MIT
//
// Promises: the solvers of sk::linear find the same solutions, in the same number of iterations, on any number of ranks as on one
// device, to the bit, if their scalar products are exact; what cannot be divided is refused.
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "method.hpp"
#include "preconditioner.hpp"
#include "ranks.hpp"
#include "solve.hpp"
#include "support/named.hpp"
#include "support/ranks.hpp"
#include "system.hpp"

namespace {

using sk::linear::Solution;

struct Choice {
  std::string_view system, solver, preconditioner;
};

const sk::linear::Arithmetic exactSums{.accumulate = sk::Accumulate::Exact};

Solution solved(const linear::System& system, const sk::linear::Space& space, const Choice& choice) {
  const sk::linear::Operator& a = system.matrix();
  const auto matrix = sk::linear::makeMatrix(space, a, "auto", exactSums);
  const auto preconditioner =
      examples::rowNamed(sk::linear::preconditionerKinds(), choice.preconditioner, "preconditioner")
          .make(space.device(), *matrix, a, exactSums);
  const auto method = examples::rowNamed(sk::linear::methodKinds(), choice.solver, "solver")
                          .make(space.device(), *matrix, preconditioner.get(), exactSums, {.a = &a});
  return sk::linear::solve(*method, a, system.rightHandSide(), exactSums, {.tolerance = 1e-8, .most = 150});
}

/// The first rank, which has the solution, compares it with that of one device.
void compare(const Choice& choice) {
  INFO(choice.system << ", " << choice.solver << ", " << choice.preconditioner);
  const linear::System system(std::string(choice.system), "");
  const auto grid = examples::divideGrid("", sk::linear::shapeOf(system.matrix()), examples::Ends::Joined);
  const Solution ranks = solved(system, sk::linear::Space(*grid), choice);
  if (rankOfWorld() != 0) {
    CHECK(ranks.x.empty());
    return;
  }
  sk::Device device;
  const Solution plain =
      solved(system, sk::linear::Space(device, sk::linear::shapeOf(system.matrix())), choice);
  CHECK(ranks.outcome == plain.outcome);
  CHECK(ranks.iterations == plain.iterations);
  CHECK(ranks.iterations > 0);
  CHECK(ranks.restarts == plain.restarts);
  CHECK(ranks.x == plain.x);
  CHECK(ranks.residualTrue == Approx(plain.residualTrue));  // a sum in doubles
}

TEST_CASE("methods find the bits of one device") {
  for (const std::string_view method :
       {"cg", "pipelined", "chebyshev", "minres", "stationary", "sor", "bicgstab", "gmres"}) {
    compare({"poisson:31x23", method, "jacobi"});
    compare({"poisson:9x8x7:periodic,neumann-dirichlet,dirichlet", method, "none"});
  }
}

TEST_CASE("preconditioners find the bits of one device") {
  for (const std::string_view preconditioner : {"none", "jacobi", "spai0", "chebyshev"}) {
    compare({"poisson:29x30", "cg", preconditioner});
    compare({"poisson:23x24:noise=100", "cg", preconditioner});
  }
}

// The parts of the first two grids or three are thick enough to be divided; the coarser ones are on every rank.
TEST_CASE("multigrid finds the bits of one device") {
  compare({"poisson:131x97", "cg", "multigrid"});
  compare({"poisson:96x50:periodic,neumann-dirichlet", "cg", "multigrid"});
  compare({"poisson:40x35x33:dirichlet,periodic,dirichlet-neumann", "cg", "multigrid"});
  compare({"poisson:97x64:1,1000", "cg", "multigrid"});
  compare({"poisson:90x70", "stationary", "w-cycle"});
  compare({"poisson:70x90", "bicgstab", "f-cycle"});
}

TEST_CASE("nested iteration on a plane finds the bits of one device") {
  compare({"poisson:36x40:periodic,neumann-dirichlet", "stationary", "full"});
}

TEST_CASE("nested iteration finds the bits of one device") {
  compare({"poisson:99x66", "stationary", "full"});
  compare({"poisson:36x33x34", "stationary", "full"});
}

TEST_CASE("multigrid for coefficients that vary finds the bits of one device") {
  compare({"poisson:98x64:inclusions=1e3", "cg", "multigrid"});
  compare({"poisson:64x55:blocks=100:periodic,neumann-dirichlet", "cg", "multigrid"});
  compare({"poisson:33x36x34:noise=10:dirichlet,neumann-dirichlet,periodic", "cg", "multigrid"});
  compare({"poisson:70x55:compact:periodic,dirichlet", "cg", "multigrid"});
}

TEST_CASE("parts that are thinner than multigrid takes are solved on every rank") {
  compare({"poisson:13x12", "cg", "multigrid"});
  compare({"poisson:11x9:noise=10", "cg", "multigrid"});
}

TEST_CASE("layouts of rows are refused") {
  if (ranksOfWorld() == 1) return;
  const linear::System system("poisson:31x23", "");
  const auto grid = examples::divideGrid("", sk::linear::shapeOf(system.matrix()), examples::Ends::Joined);
  CHECK_THROWS_WITH(sk::linear::makeMatrix(sk::linear::Space(*grid), system.matrix(), "slices", exactSums),
                    Catch::Contains("the layout 'slices' is for one process"));
  const linear::System compact("poisson:31x23:compact", "");
  CHECK_THROWS_WITH(solved(compact, sk::linear::Space(*grid), {"", "sor", "none"}),
                    Catch::Contains("grids without entries for corners"));
}

}  // namespace
