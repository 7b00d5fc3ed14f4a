// SPDX-License-Identifier: MIT
//
// Grids whose coefficients jump: their products, what Galerkin's coarse grids promise, and solutions beside those of Eigen.
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/SparseCholesky>
#include <catch2/catch.hpp>
#include <sk/sk.hpp>

#include "galerkin.hpp"
#include "multigrid.hpp"
#include "solve.hpp"
#include "test_eigen.hpp"
#include "test_solves.hpp"
#include "text/named.hpp"
#include "varying.hpp"

namespace sk::linear {
namespace {

VaryingStencil withPattern(const sk::Shape& grid, const std::vector<Ends>& ends, std::string_view pattern,
                           double ratio) {
  const Stencil a = withEnds(poisson(grid), ends);
  return diffusion(a, text::rowNamed(coefficientPatterns(), pattern, "pattern").make(a, ratio));
}

/// Entries for all neighbours, random and symmetric, on a grid that is periodic along its fastest dimension.
VaryingStencil randomStencil(const sk::Shape& grid, Neighbourhood neighbourhood) {
  VaryingStencil a{.grid = grid,
                   .isPeriodic = {false, grid.rank() == 2, grid.rank() == 3},
                   .offsets = neighbourOffsets(grid.rank(), neighbourhood),
                   .value = {}};
  a.value.assign(a.offsets.size() * static_cast<std::size_t>(grid.size()), 0.0);
  std::mt19937 random(3);
  const GridWalk walk(grid, a.isPeriodic);
  for (std::int64_t i = 0; i < grid.size(); ++i) {
    a.value[entryAt(a, 0, i)] += 0.25;
    for (std::size_t k = 1; k < a.offsets.size(); ++k) {
      const std::int64_t j = walk.beside(walk.positionOf(i), a.offsets[k]);
      if (j <= i) continue;
      const double entry = -std::uniform_real_distribution<double>(0.1, 1)(random);
      std::size_t back = 1;
      for (GridOffset o = a.offsets[k]; a.offsets[back] != GridOffset{-o[0], -o[1], -o[2]};) ++back;
      a.value[entryAt(a, k, i)] = a.value[entryAt(a, back, j)] = entry;
      a.value[entryAt(a, 0, i)] -= entry;
      a.value[entryAt(a, 0, j)] -= entry;
    }
  }
  return a;
}

std::vector<double> readBack(sk::Device& device, const sk::Shape& shape, const std::vector<double>& v,
                             const Arithmetic& arithmetic, auto&& call) {
  Vector in = device.stream<float>(v.size() == static_cast<std::size_t>(shape.size()) ? shape : sk::Shape{1},
                                   arithmetic.vectors);
  in.writeReals(v);
  return call(in).readReals();
}

TEST_CASE("Products with varying coefficients are those of the stored matrix on every device") {
  for (sk::Device& device : testDevices())
    for (const VaryingStencil& a :
         {withPattern({11, 14}, {ring, mixed}, "noise", 1e3),
          withPattern({5, 6, 7}, {mirrors, ring, fixedEnds}, "noise", 1e3),
          randomStencil({9, 12}, Neighbourhood::All), randomStencil({5, 6, 7}, Neighbourhood::Edges),
          randomStencil({6, 5, 7}, Neighbourhood::All)}) {
      CAPTURE(device.profile(), a.grid.rank(), a.count());
      if (device.profile() == "essl300" && a.count() > 9) continue;  // these programs take long to build
      const std::vector<double> x = randomVector(a.size(), 1);
      const SparseMatrix stored = assemble(a);
      CHECK(asymmetry(stored).empty());
      const std::vector<double> expected = multiply(stored, x);
      const std::vector<double> y = readBack(device, a.grid, x, {}, [&](const Vector& in) {
        Vector out = device.stream<float>(a.grid);
        makeMatrix(device, a, {})->multiply(in, out);
        return out;
      });
      // Each of the terms is rounded about three times, and their sum once for each.
      const double bound = (a.count() + 3) * 0x1p-24 * 2 * infinityNorm(stored);
      for (std::size_t i = 0; i < y.size(); ++i) CHECK(std::abs(y[i] - expected[i]) <= bound);
    }
}

TEST_CASE("Galerkin's matrices are the restriction of the matrix of the interpolation") {
  sk::Device device = sk::Device::native();
  for (const VaryingStencil& a :
       {withPattern({20, 22}, {mixed, ring}, "noise", 10),
        withPattern({21, 20}, {ring, mirrors}, "noise", 10),
        withPattern({7, 9, 8}, {mirrors, fixedEnds, ring}, "noise", 10),
        randomStencil({19, 22}, Neighbourhood::All), randomStencil({7, 8, 9}, Neighbourhood::All)}) {
    const Coarsening c = coarsening(a);
    const VaryingStencil coarse = galerkin(a, c);
    CAPTURE(a.grid.rank(), a.count(), c.coarse[0], c.coarse[1]);
    CHECK(c.share() > 1);
    const SparseMatrix fineMatrix = assemble(a), coarseMatrix = assemble(coarse);
    const std::vector<double> v = randomVector(coarse.size(), 2);
    const std::unique_ptr<Hierarchy> levels = makeHierarchy(device, a, doubles);
    REQUIRE(levels->grid(1) == c.coarse);
    const std::vector<double> interpolated = readBack(device, c.coarse, v, doubles, [&](const Vector& in) {
      Vector out = device.stream<float>(a.grid, sk::Storage::Double);
      levels->interpolate(0, in, out);
      return out;
    });
    const std::vector<double> product = multiply(fineMatrix, interpolated);
    const std::vector<double> restricted = readBack(device, a.grid, product, doubles, [&](const Vector& in) {
      Vector out = device.stream<float>(c.coarse, sk::Storage::Double);
      levels->restrictTo(0, in, out);
      return out;
    });
    const std::vector<double> expected = multiply(coarseMatrix, v);
    for (std::size_t i = 0; i < v.size(); ++i)
      CHECK(std::abs(restricted[i] - expected[i]) <= 1e-14 * infinityNorm(fineMatrix));
    if (!hasConstantKernel(a)) continue;
    CHECK(hasConstantKernel(coarse));
  }
}

TEST_CASE("Interpolation keeps the flux where a coefficient jumps") {
  // Along a row with the coefficients 1 and 9, the flux between elements is 1, 1.8 and 9 times their difference.
  const Stencil grid = withEnds(poisson({1, 501}), std::array{mirrors, mirrors});
  std::vector<double> coefficient(501, 9.0);
  coefficient[0] = coefficient[1] = coefficient[2] = 1.0;
  const Coarsening c = coarsening(diffusion(grid, coefficient));
  REQUIRE(c.coarse == sk::Shape{1, 250});  // elements 1, 3, 5 ...
  const auto weight = [&](int offset, std::size_t j) {
    return c.weight[static_cast<std::size_t>(offset + 4) * 250 + j];
  };
  CHECK(weight(1, 0) == Approx(1 / 2.8));  // of element 1 for element 2
  CHECK(weight(-1, 1) == Approx(1.8 / 2.8));
  CHECK(weight(1, 1) == Approx(0.5));
  CHECK(weight(-1, 0) == Approx(1));  // element 0, which has no other neighbour
}

TEST_CASE("Galerkin cycles for constant coefficients converge at one rate on every grid") {
  sk::Device device = sk::Device::native();
  const MultigridSettings settings{.before = 2, .after = 1, .isSymmetric = false};
  for (const std::vector<Ends>& ends : {std::vector{fixedEnds, fixedEnds}, {mixed, ring}, {mirrors, mirrors}})
    for (const sk::Shape& grid : {sk::Shape{64, 61}, sk::Shape{33, 40}}) {
      CAPTURE(grid[0], static_cast<int>(ends[0].high));
      for (const LevelRate& level :
           makeMultigrid(device, withPattern(grid, ends, "noise", 1), doubles, settings)->rates())
        CHECK(level.rate <= 0.15);
    }
  for (const LevelRate& level :
       makeMultigrid(device, withPattern({15, 16, 17}, {fixedEnds, mixed, ring}, "noise", 1), doubles,
                     settings)
           ->rates())
    CHECK(level.rate <= 0.3);
  // Semi-coarsening, as for constant coefficients.
  const Stencil thin = poisson({45, 52}, std::array{1.0, 1e3});
  const std::vector<double> ones(static_cast<std::size_t>(thin.size()), 1.0);
  for (const LevelRate& level : makeMultigrid(device, diffusion(thin, ones), doubles, settings)->rates())
    CHECK(level.rate <= 0.3);
}

TEST_CASE("Galerkin cycles compute alike on every device") {
  std::vector<sk::Device> all = testDevices();
  for (const VaryingStencil& a : {withPattern({22, 20}, {ring, mixed}, "inclusions", 100),
                                  withPattern({7, 8, 8}, {mixed, ring, mirrors}, "blocks", 100)}) {
    const std::vector<double> r = randomVector(a.size(), 5);
    const auto applied = [&](sk::Device& device, const Arithmetic& arithmetic) {
      return readBack(device, a.grid, r, arithmetic, [&](const Vector& in) {
        Vector out = device.stream<float>(a.grid, arithmetic.vectors);
        Vector rz = device.stream<float>({1}, arithmetic.sums());
        makeMultigrid(device, a, arithmetic, {})->apply(in, out, rz);
        return out;
      });
    };
    const std::vector<double> expected = applied(all[0], doubles);
    double largest = 0.0;
    for (const double v : expected) largest = std::max(largest, std::abs(v));
    for (sk::Device& device : all) {
      CAPTURE(device.profile(), a.grid.rank());
      if (device.profile() == "essl300" && a.grid.rank() == 3) continue;  // these programs take long to build
      const std::vector<double> z = applied(device, {});
      for (std::size_t i = 0; i < z.size(); ++i) CHECK(std::abs(z[i] - expected[i]) < 1e-4 * largest);
    }
  }
}

TEST_CASE("Coefficients of grids are checked") {
  CHECK_THROWS_WITH(diffusion(poisson({2, 3}), std::vector<double>(5, 1.0)),
                    "a grid of 6 elements needs as many coefficients, not 5");
  CHECK_THROWS_WITH(diffusion(poisson({1, 2}), std::vector<double>{1.0, 0.0}),
                    "a coefficient is finite and above 0, which number 2, 0, is not");
}

}  // namespace
}  // namespace sk::linear
