// SPDX-License-Identifier: MIT
//
// Orders of unknowns, and incomplete factors with a dual threshold.
#include "ordering.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <sk/linear.hpp>

#include "reordering.hpp"
#include "test_solves.hpp"

namespace sk::linear {
namespace {

std::vector<std::int32_t> shuffledOrder(std::int64_t n) {
  std::vector<std::int32_t> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  std::mt19937 random(7);
  for (std::size_t i = order.size(); i-- > 1;) std::swap(order[i], order[random() % (i + 1)]);
  return order;
}

bool isPermutation(std::vector<std::int32_t> order) {
  std::ranges::sort(order);
  for (std::size_t i = 0; i < order.size(); ++i)
    if (order[i] != static_cast<std::int32_t>(i)) return false;
  return true;
}

/// L U as a full matrix, row by row.
std::vector<double> product(const SparseMatrix& factors) {
  const auto n = static_cast<std::size_t>(factors.rows);
  std::vector<double> l(n * n, 0.0), u(n * n, 0.0), lu(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    l[i * n + i] = 1.0;
    for (auto k = static_cast<std::size_t>(factors.starts[i]);
         k < static_cast<std::size_t>(factors.starts[i + 1]); ++k) {
      const auto j = static_cast<std::size_t>(factors.column[k]);
      (j < i ? l : u)[i * n + j] = factors.value[k];
    }
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t j = 0; j < n; ++j) lu[i * n + j] += l[i * n + k] * u[k * n + j];
  return lu;
}

/// Upwind convection on a plane, in an order that hides the grid.
SparseMatrix shuffledConvection(std::int64_t n) {
  std::vector<Entry> entries;
  for (std::int64_t i = 0; i < n * n; ++i) {
    entries.push_back({i, i, 4.3});
    if (i % n > 0) entries.push_back({i, i - 1, -1.8});
    if (i % n + 1 < n) entries.push_back({i, i + 1, -0.4});
    if (i >= n) entries.push_back({i, i - n, -1.2});
    if (i + n < n * n) entries.push_back({i, i + n, -0.9});
  }
  return permuted(assemble(n * n, n * n, entries), shuffledOrder(n * n));
}

TEST_CASE("Reverse Cuthill-McKee finds the bands of grids and chains whatever their order") {
  const SparseMatrix plane = assemble(poisson({12, 30}));
  CHECK(bandwidth(plane) == 30);
  const SparseMatrix hidden = permuted(plane, shuffledOrder(360));
  CHECK(bandwidth(hidden) > 200);
  const std::vector<std::int32_t> order = reverseCuthillMcKee(hidden);
  CHECK(isPermutation(order));
  // Levels are the diagonals of the grid, of at most 12 elements, and entries connect neighbouring ones.
  CHECK(bandwidth(permuted(hidden, order)) <= 2 * 12);
  const SparseMatrix chain = permuted(assemble(poisson({1, 50})), shuffledOrder(50));
  CHECK(bandwidth(permuted(chain, reverseCuthillMcKee(chain))) == 1);
  // Parts that nothing connects, rows without entries, and entries on one side of the diagonal only.
  const Entry few[] = {{0, 7, 1}, {7, 3, 1}, {2, 6, 1}};
  const SparseMatrix parts = assemble(9, 9, few);
  CHECK(isPermutation(reverseCuthillMcKee(parts)));
  CHECK(bandwidth(permuted(parts, reverseCuthillMcKee(parts))) == 1);
  CHECK(reverseCuthillMcKee(assemble(0, 0, {})).empty());
  CHECK(bandwidth(assemble(3, 3, {})) == 0);
}

TEST_CASE("Vectors go to another order and back") {
  const std::vector<std::int32_t> order = {2, 0, 1};
  const std::vector<double> v = {10, 11, 12};
  CHECK(inOrder(v, order) == std::vector<double>{12, 10, 11});
  CHECK(inFormerOrder(inOrder(v, order), order) == v);
  CHECK(inOrder(v, {}) == v);
}

TEST_CASE("Without thresholds, incomplete factors are those of the matrix; with them, they are small") {
  const SparseMatrix a = shuffledConvection(6);
  SparseMatrix all, some, none;
  REQUIRE(factoriseByThreshold(a, {.drop = 0.0, .fill = 36}, all) == -1);
  const std::vector<double> lu = product(all);
  for (std::size_t i = 0; i < 36; ++i) {
    std::vector<double> row(36, 0.0);
    for (auto k = static_cast<std::size_t>(a.starts[i]); k < static_cast<std::size_t>(a.starts[i + 1]); ++k)
      row[static_cast<std::size_t>(a.column[k])] = a.value[k];
    // Rounding errors of 36 products of numbers below 5, whose pivots are above 2.
    for (std::size_t j = 0; j < 36; ++j) CHECK(std::abs(lu[i * 36 + j] - row[j]) < 1e-13);
  }
  REQUIRE(factoriseByThreshold(a, {.drop = 1e-3, .fill = 3}, some) == -1);
  for (std::int64_t i = 0; i < 36; ++i) CHECK(some.length(i) <= 7);
  CHECK(some.entries() < all.entries());
  REQUIRE(factoriseByThreshold(a, {.drop = 0.5, .fill = 0}, none) == -1);
  CHECK(none.entries() == 36);
  const Entry zero[] = {{0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1}};
  CHECK(factoriseByThreshold(assemble(2, 2, zero), {}, none) == 1);
}

TEST_CASE("ILUT needs fewer iterations the more it keeps, on every device") {
  const SparseMatrix a = shuffledConvection(20);
  const std::vector<double> b = randomVector(400, 3);
  for (sk::Device& device : testDevices()) {
    CAPTURE(device.profile());
    const auto iterationsOf = [&](const Options& options) {
      const Solution s = solve(device, a, b, options);
      CHECK(s.isSolved());
      return s.iterations;
    };
    const std::int64_t pattern =
        iterationsOf({.solver = "bicgstab", .preconditioner = "ilu0", .ordering = "levels"});
    const std::int64_t more = iterationsOf({.solver = "bicgstab",
                                            .preconditioner = "ilut",
                                            .ordering = "levels",
                                            .reorder = "rcm",
                                            .drop = 1e-4,
                                            .fill = 20});
    CHECK(more < pattern);
    CHECK(more <= 8);
    if (device.profile() != "native") continue;
    for (const char* ordering : {"colours", "levels"})
      iterationsOf({.solver = "gmres", .preconditioner = "ilut", .ordering = ordering, .fill = 5});
  }
}

TEST_CASE("A reordered solver takes and gives vectors in the order of its matrix, and names rows by it") {
  sk::Device device = sk::Device::native();
  SparseMatrix a = permuted(assemble(poisson({15, 8})), shuffledOrder(120));
  const std::vector<double> b = randomVector(120, 5);
  Solver solver(device, a, {.reorder = "rcm"});
  const auto residual = [&] {
    const std::vector<double> x = solver.solve(b).x;
    std::vector<double> r = multiply(a, x);
    for (std::size_t i = 0; i < r.size(); ++i) r[i] -= b[i];
    return norm(r) / norm(b);
  };
  CHECK(residual() <= 1.01e-8);
  a = shifted(a, -1.0);
  solver.update(a);
  CHECK(residual() <= 1.01e-8);
  CHECK_THROWS_WITH(solver.solve(std::vector<double>(5)),
                    "the right-hand side has 5 elements, and the matrix 120 rows");
  std::vector<double> wrong = b;
  wrong[77] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(solver.solve(wrong), "element 78 of the right-hand side is nan, which is not finite");
  SparseMatrix turned = a;
  const auto last = static_cast<std::size_t>(a.starts[120] - 1);  // of row 120, which is not the diagonal's
  const std::string column = std::to_string(turned.column[last] + 1);
  turned.value[last] += 1.0;
  if (turned.column[last] != 119) {
    CHECK_THROWS_WITH(Solver(device, turned, {.reorder = "rcm"}),
                      Catch::Contains("(120, " + column + ")") && Catch::Contains("(" + column + ", 120)"));
  }
  CHECK_THROWS_WITH(Solver(device, a, {.reorder = "amd"}), "the option 'reorder' is amd; it is none or rcm");
  CHECK_THROWS_WITH(Solver(device, a, {.drop = 1.0}), "the option 'drop' is 1; it is from 0 to below 1");
  CHECK_THROWS_WITH(Solver(device, a, {.fill = -1}),
                    "the option 'fill' is -1; it is from 0 to 100000 entries");
  CHECK_THROWS_WITH(Solver(device, poisson({4, 4}), {.reorder = "rcm"}),
                    Catch::StartsWith("a grid keeps the order"));
  const Entry singular[] = {{0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1}};
  CHECK_THROWS_WITH(Solver(device, assemble(2, 2, singular), {.solver = "gmres", .preconditioner = "ilut"}),
                    "the preconditioner 'ilut' has a pivot of 0 in row 2; take the preconditioner 'none'");
}

}  // namespace
}  // namespace sk::linear
