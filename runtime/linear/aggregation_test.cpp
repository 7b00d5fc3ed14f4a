// SPDX-License-Identifier: MIT
//
// Algebraic multigrid by smoothed aggregation: its levels, and solutions beside Eigen's direct solver in double precision.
#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/SparseCholesky>
#include <catch2/catch.hpp>
#include <sk/sk.hpp>

#include "aggregation.hpp"
#include "eigenvalues.hpp"
#include "layout.hpp"
#include "solve.hpp"
#include "sparse.hpp"
#include "stencil.hpp"
#include "test_eigen.hpp"
#include "test_solves.hpp"
#include "text/named.hpp"

namespace sk::linear {
namespace {

using Lower = Eigen::SparseMatrix<double>;

struct Wanted {
  std::string_view solver = "cg";
  std::string_view layout = "rows";
  Arithmetic arithmetic = {};
  double tolerance = 1e-10;
};

struct Reached {
  Solution solution;
  HierarchyAccount hierarchy;
};

Reached solveByAggregation(sk::Device& device, const SparseMatrix& a, const std::vector<double>& b,
                           const Wanted& choice = {}) {
  const Operator o = operatorOf(a);
  const auto matrix = makeMatrix(device, scaled(a, o.scale), choice.layout, choice.arithmetic);
  const auto preconditioner = text::rowNamed(preconditionerKinds(), "aggregation", "preconditioner")
                                  .make(device, *matrix, o, choice.arithmetic);
  const auto method = text::rowNamed(methodKinds(), choice.solver, "solver")
                          .make(device, *matrix, preconditioner.get(), choice.arithmetic, {.a = &o});
  return {solve(*method, o, b, choice.arithmetic, {.tolerance = choice.tolerance, .most = 500, .every = 1}),
          *preconditioner->hierarchy()};
}

/// 1 / the smallest eigenvalue, by inverse iteration.
double inverseNorm(const Eigen::SimplicialLDLT<Lower>& factors, Eigen::Index n) {
  Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(n, 1.0, 2.0);
  double norm = 0.0;
  for (int i = 0; i < 30; ++i) {
    v = factors.solve(v / v.norm());
    norm = v.norm();
  }
  return norm;
}

/// ||x - y|| against what the residual may mean, ||A^-1|| ||r||, where inverse iteration may miss half of the norm; and Eigen's own roundings.
void checkSolution(const SparseMatrix& a, const std::vector<double>& b, const Solution& s) {
  const Lower m = eigenOf(a);
  const Eigen::SimplicialLDLT<Lower> factors(m);
  REQUIRE(factors.info() == Eigen::Success);
  const Eigen::VectorXd expected = factors.solve(vectorOf(b)), x = vectorOf(s.x);
  const double norm = inverseNorm(factors, m.rows());
  const double rounding = 64.0 * norm * infinityNorm(a) * 0x1p-53 * expected.norm();
  CHECK((x - expected).norm() <= 2.0 * norm * (vectorOf(b) - m * x).norm() + rounding);
}

/// For a matrix whose kernel are the constants: the last unknown is 0, then the mean.
void checkSingularSolution(const SparseMatrix& a, const std::vector<double>& b, const Solution& s) {
  const Eigen::Index n = a.rows;
  const Lower m = eigenOf(a, n - 1), whole = eigenOf(a);
  const Eigen::SimplicialLDLT<Lower> factors(m);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(n), x = vectorOf(s.x);
  expected.head(n - 1) = factors.solve(vectorOf(b).head(n - 1));
  x.array() -= x.mean();
  expected.array() -= expected.mean();
  CHECK((x - expected).norm() <=
        2.0 * inverseNorm(factors, n - 1) * (vectorOf(b) - whole * x).norm() + 1e-11 * expected.norm());
}

std::vector<double> balanced(std::vector<double> b) {
  double sum = 0.0;
  for (const double v : b) sum += v;
  for (double& v : b) v -= sum / static_cast<double>(b.size());
  return b;
}

using Edge = std::pair<std::int64_t, std::int64_t>;

/// The Laplacian of a graph whose edges weigh weight(i, j), and `shift` on the diagonal.
template <class Weight>
SparseMatrix laplacian(std::int64_t n, const std::set<Edge>& edges, double shift, Weight&& weight) {
  std::vector<Entry> entries;
  for (std::int64_t i = 0; i < n; ++i) entries.push_back({i, i, shift});
  for (const auto& [i, j] : edges) {
    const double w = weight(i, j);
    for (const Entry& e : {Entry{i, i, w}, Entry{j, j, w}, Entry{i, j, -w}, Entry{j, i, -w}})
      entries.push_back(e);
  }
  return assemble(n, n, entries);
}

double one(std::int64_t, std::int64_t) { return 1.0; }

/// Points at random places of a square, and neighbours within a distance, twelve on average.
std::set<Edge> neighbours(std::int64_t n) {
  std::mt19937 random(5);
  std::vector<std::pair<double, double>> places;
  for (std::int64_t i = 0; i < n; ++i)
    places.emplace_back(static_cast<double>(random()) * 0x1p-32, static_cast<double>(random()) * 0x1p-32);
  std::ranges::sort(places);
  std::set<Edge> edges;
  const double reach = 4.0 / static_cast<double>(n);
  for (std::int64_t i = 0; i < n; ++i)
    for (std::int64_t j = i + 1; j < n; ++j) {
      const auto& p = places[static_cast<std::size_t>(i)];
      const auto& q = places[static_cast<std::size_t>(j)];
      const double x = p.first - q.first, y = p.second - q.second;
      if (x * x + y * y < reach) edges.insert({i, j});
    }
  return edges;
}

/// Each vertex joins two earlier ones, rather those with many edges: a few vertices have hundreds.
std::set<Edge> hubs(std::int64_t n) {
  std::mt19937 random(6);
  std::vector<std::int64_t> ends{0};
  std::set<Edge> edges;
  for (std::int64_t i = 1; i < n; ++i)
    for (int k = 0; k < 2; ++k) {
      const std::int64_t j = ends[random() % ends.size()];
      if (j == i) continue;
      edges.insert({j, i});
      ends.insert(ends.end(), {j, i});
    }
  return edges;
}

std::set<Edge> gridEdges(std::int64_t w, std::int64_t h) {
  std::set<Edge> edges;
  for (std::int64_t y = 0; y < h; ++y)
    for (std::int64_t x = 0; x < w; ++x) {
      if (x + 1 < w) edges.insert({y * w + x, y * w + x + 1});
      if (y + 1 < h) edges.insert({y * w + x, (y + 1) * w + x});
    }
  return edges;
}

/// Conductivities that differ by 10^3 between squares of 8 x 8 elements; the harmonic mean between elements.
SparseMatrix jumping(std::int64_t w, std::int64_t h) {
  const auto of = [w](std::int64_t i) { return ((i % w / 8 + i / w / 8) & 1) == 0 ? 1.0 : 1e3; };
  return laplacian(w * h, gridEdges(w, h), 0.05,
                   [&](std::int64_t i, std::int64_t j) { return 2.0 / (1.0 / of(i) + 1.0 / of(j)); });
}

SparseMatrix diagonalMatrix(std::int64_t n) {
  std::vector<Entry> entries;
  for (std::int64_t i = 0; i < n; ++i) entries.push_back({i, i, 1.0 + static_cast<double>(i % 7)});
  return assemble(n, n, entries);
}

TEST_CASE("Solutions with smoothed aggregation are Eigen's, after few iterations") {
  sk::Device device = sk::Device::native();
  struct Case {
    std::string_view name;
    SparseMatrix a;
    int most;  ///< iterations: about a quarter above what they were
  };
  const Case cases[] = {
      {"plane", assemble(poisson({47, 43})), 14},
      {"space", assemble(poisson({9, 10, 11})), 14},
      {"anisotropic plane", assemble(poisson({48, 44}, std::vector<double>{1.0, 1000.0})), 17},
      {"line", assemble(poisson({1, 1000})), 17},
      {"points of a plane", laplacian(1000, neighbours(1000), 1e-2, one), 30},
      {"hubs", laplacian(1000, hubs(1000), 1e-4, one), 40},
      {"jumping coefficients", jumping(40, 36), 42},
      {"dominant diagonals", laplacian(900, gridEdges(30, 30), 50.0, one), 10}};
  for (const Case& c : cases) {
    CAPTURE(c.name);
    const std::vector<double> b = wavy(c.a.rows);
    const Reached r = solveByAggregation(device, c.a, b);
    CHECK(r.solution.outcome == Outcome::Converged);
    CHECK(r.solution.iterations <= c.most);
    CHECK(r.hierarchy.operatorComplexity() < 2.0);
    checkSolution(c.a, b, r.solution);
  }
}

TEST_CASE("Levels are Galerkin products whose prolongators keep constants") {
  const AggregationHierarchy hierarchy = aggregationHierarchy(laplacian(1023, gridEdges(31, 33), 0.0, one));
  REQUIRE(hierarchy.levels.size() == 3);
  for (std::size_t l = 0; l + 1 < hierarchy.levels.size(); ++l) {
    CAPTURE(l);
    const AggregationLevel& level = hierarchy.levels[l];
    const SparseMatrix& coarse = hierarchy.levels[l + 1].matrix;
    CHECK(coarse.rows < level.matrix.rows / 5);  // a row and its neighbours, and some of theirs
    const std::vector<double> ones(static_cast<std::size_t>(coarse.rows), 1.0);
    for (const double sum : multiply(level.prolongator, ones)) CHECK(std::abs(sum - 1.0) <= 1e-14);
    const std::vector<double> x = wavy(coarse.rows);
    const std::vector<double> y = multiply(coarse, x);
    const std::vector<double> expected =
        multiply(level.restrictor, multiply(level.matrix, multiply(level.prolongator, x)));
    CHECK((vectorOf(y) - vectorOf(expected)).norm() <= 1e-14 * vectorOf(expected).norm());
    CHECK(infinityNorm(coarse) >= 0.5);
    CHECK(infinityNorm(coarse) < 1.0);
  }
  // The kernel is still that of constants, which the pseudo-inverse removes.
  const SparseMatrix& coarsest = hierarchy.levels.back().matrix;
  const std::vector<double> x = balanced(wavy(coarsest.rows)), ax = multiply(coarsest, x);
  Eigen::VectorXd back = Eigen::VectorXd::Zero(coarsest.rows);
  for (Eigen::Index i = 0; i < back.size(); ++i)
    for (Eigen::Index j = 0; j < back.size(); ++j)
      back(i) += hierarchy.coarsestInverse[static_cast<std::size_t>(i * back.size() + j)] *
                 ax[static_cast<std::size_t>(j)];
  CHECK((back - vectorOf(x)).norm() <= 1e-11 * back.norm());
}

TEST_CASE("Aggregates are of rows with strong entries in common, and weak entries go to the diagonal") {
  // Along x, entries are a thousandth of those along y.
  const SparseMatrix a = assemble(poisson({12, 9}, std::vector<double>{1000.0, 1.0}));
  const SparseMatrix strong = withoutWeakEntries(a, 0.08);
  const std::vector<std::int32_t> aggregate = aggregatesOf(strong);
  const std::vector<double> ones(108, 1.0);
  CHECK(multiply(strong, ones) == multiply(a, ones));
  for (std::size_t i = 0; i < aggregate.size(); ++i) {
    REQUIRE(aggregate[i] >= 0);
    for (std::size_t j = 0; j < i; ++j)
      if (aggregate[i] == aggregate[j]) CHECK(i % 9 == j % 9);  // one column of the grid
  }
  CHECK(aggregatesOf(withoutWeakEntries(diagonalMatrix(4), 0.08)) == std::vector<std::int32_t>(4, -1));
  // A row whose entries are all weak keeps its largest one: a star has one aggregate.
  std::set<Edge> star;
  for (std::int64_t i = 1; i < 2000; ++i) star.insert({0, i});
  CHECK(aggregatesOf(withoutWeakEntries(laplacian(2000, star, 0.0, one), 0.08)) ==
        std::vector<std::int32_t>(2000, 0));
}

TEST_CASE("Eigenvalue bounds bound, and pseudo-inverses invert") {
  const SparseMatrix a = assemble(poisson({20, 30}));
  const std::vector<double> inverse(600, 0.25);
  const double exact = 1.0 + 0.5 * (std::cos(std::acos(-1.0) / 21.0) + std::cos(std::acos(-1.0) / 31.0));
  CHECK(jacobiEigenvalueBound(a, inverse) >= exact);
  CHECK(jacobiEigenvalueBound(a, inverse) <= 2.0);
  CHECK(jacobiEigenvalueBound(diagonalMatrix(3), std::vector<double>{1.0, 0.5, 0.0}) == 1.0);
  // diag(2, 0, 3), turned by 45 degrees in the first plane
  const std::vector<double> p = pseudoInverse({1, 1, 0, 1, 1, 0, 0, 0, 3}, 3);
  const std::vector<double> expected{0.25, 0.25, 0, 0.25, 0.25, 0, 0, 0, 1.0 / 3.0};
  for (std::size_t i = 0; i < 9; ++i) CHECK(std::abs(p[i] - expected[i]) <= 1e-15);
  CHECK(pseudoInverse({}, 0).empty());
}

TEST_CASE("Smoothed aggregation needs as many iterations on large grids as on small ones") {
  sk::Device device = sk::Device::native();
  std::vector<std::int64_t> iterations;
  for (const std::int64_t n : {16, 32, 64, 128}) {
    const SparseMatrix a = assemble(poisson({n, n}));
    iterations.push_back(solveByAggregation(device, a, wavy(n * n), {.tolerance = 1e-8}).solution.iterations);
  }
  CAPTURE(iterations);
  CHECK(iterations.back() <= 12);
  CHECK(iterations.back() - iterations.front() <= 4);
}

TEST_CASE("Cycles of smoothed aggregation are the same on every device, in every layout of the matrix") {
  const Stencil grid = poisson({17, 23});
  const SparseMatrix a = assemble(grid);
  const Operator o = operatorOf(a), ofGrid = operatorOf(grid);
  const std::vector<double> r = wavy(a.rows);
  std::vector<double> expected;  // in doubles
  const auto cycle = [&](sk::Device& device, Matrix& matrix, const Operator& of,
                         const Arithmetic& arithmetic) {
    const auto preconditioner = text::rowNamed(preconditionerKinds(), "aggregation", "preconditioner")
                                    .make(device, matrix, of, arithmetic);
    Vector in = device.stream<float>(matrix.domain(), arithmetic.vectors),
           out = device.stream<float>(matrix.domain(), arithmetic.vectors),
           product = device.stream<float>({1}, arithmetic.sums());
    in.writeReals(r);
    preconditioner->apply(in, out, product);
    const std::vector<double> z = out.readReals();
    CHECK(std::abs(product.readReals()[0] - vectorOf(r).dot(vectorOf(z))) <=
          1e-5 * vectorOf(r).norm() * vectorOf(z).norm());
    return z;
  };
  {
    sk::Device device = sk::Device::native();
    const auto matrix = makeMatrix(device, scaled(a, o.scale), "slices", doubles);
    expected = cycle(device, *matrix, o, doubles);
  }
  // Some twenty products of at most 25 entries, of which the last few are not damped: 2^-24 each.
  const double bound = 200.0 * 0x1p-24 * vectorOf(expected).norm();
  for (sk::Device& device : testDevices()) {
    for (const std::string_view layout : {"slices", "diagonals"}) {
      CAPTURE(device.profile(), layout);
      const auto matrix = makeMatrix(device, scaled(a, o.scale), layout, {});
      CHECK((vectorOf(cycle(device, *matrix, o, {})) - vectorOf(expected)).norm() <= bound);
    }
    CAPTURE(device.profile());
    const auto stencil = makeMatrix(scaled(grid, ofGrid.scale), {});
    CHECK((vectorOf(cycle(device, *stencil, ofGrid, {})) - vectorOf(expected)).norm() <= bound);
    const Reached reached = solveByAggregation(device, a, r, {.layout = "slices", .tolerance = 1e-6});
    CHECK(reached.solution.outcome == Outcome::Converged);
    CHECK(reached.solution.iterations <= 8);
    checkSolution(a, r, reached.solution);
  }
}

TEST_CASE("The cycle is symmetric, and solves by itself and in other precisions") {
  sk::Device device = sk::Device::native();
  const SparseMatrix smooth = assemble(poisson({21, 22}));
  const Reached alone = solveByAggregation(device, smooth, wavy(smooth.rows), {.solver = "stationary"});
  CHECK(alone.solution.outcome == Outcome::Converged);
  CHECK(alone.solution.iterations <= 22);
  checkSolution(smooth, wavy(smooth.rows), alone.solution);
  const Arithmetic halves{
      .precision = sk::Precision::Single, .matrix = sk::Storage::Half, .vectors = sk::Storage::Half};
  for (const Arithmetic& arithmetic : {halves, doubles}) {
    const Reached r = solveByAggregation(device, smooth, wavy(smooth.rows), {.arithmetic = arithmetic});
    CHECK(r.solution.outcome == Outcome::Converged);
    CHECK(r.solution.iterations < 60);
    checkSolution(smooth, wavy(smooth.rows), r.solution);
  }
  const SparseMatrix a = jumping(24, 20);
  const Operator o = operatorOf(a);
  const auto matrix = makeMatrix(device, scaled(a, o.scale), "rows", {});
  const auto m =
      text::rowNamed(preconditionerKinds(), "aggregation", "preconditioner").make(device, *matrix, o, {});
  Vector u = device.stream<float>({a.rows}), v = device.stream<float>({a.rows}),
         mu = device.stream<float>({a.rows}), mv = device.stream<float>({a.rows}),
         product = device.stream<float>({1});
  const std::vector<double> x = wavy(a.rows), y = balanced(x);
  u.writeReals(x);
  v.writeReals(y);
  m->apply(u, mu, product);
  m->apply(v, mv, product);
  const Eigen::VectorXd zu = vectorOf(mu.readReals()), zv = vectorOf(mv.readReals());
  CHECK(std::abs(vectorOf(y).dot(zu) - vectorOf(x).dot(zv)) <= 1e-4 * vectorOf(x).norm() * zv.norm());
}

TEST_CASE("Singular matrices are solved where the right-hand side allows it, of one part or of several") {
  const SparseMatrix grid = laplacian(35 * 30, gridEdges(35, 30), 0.0, one);
  std::set<Edge> parts;  // 150 paths of seven vertices: each is an aggregate or two, and a part of the kernel
  for (std::int64_t i = 0; i < 1050; ++i)
    if (i % 7 != 6) parts.insert({i, i + 1});
  // Weights that leave roundings where the rows of a coarse matrix should be 0.
  const SparseMatrix paths = laplacian(1050, parts, 0.0, [](std::int64_t i, std::int64_t) {
    return 1.0 + 0.9 * std::sin(static_cast<double>(i));
  });
  std::vector<double> alternating(1050);
  for (std::size_t i = 0; i < 1050; ++i) alternating[i] = i % 7 == 0 ? 1.0 : i % 7 == 4 ? -1.0 : 0.0;
  for (const SparseMatrix& a : {grid, laplacian(1000, hubs(1000), 0.0, one)}) {
    sk::Device device = sk::Device::native();
    const std::vector<double> b = balanced(wavy(a.rows));
    const Reached r = solveByAggregation(device, a, b);
    CHECK(r.solution.outcome == Outcome::SingularAndCompatible);
    CHECK(r.solution.iterations < 50);
    checkSingularSolution(a, b, r.solution);
  }
  sk::Device device = sk::Device::native();
  const Reached r = solveByAggregation(device, paths, alternating);
  CHECK(r.solution.outcome == Outcome::SingularAndCompatible);
  CHECK(r.solution.iterations < 30);
  CHECK(solveByAggregation(device, grid, wavy(grid.rows)).solution.outcome ==
        Outcome::SingularAndIncompatible);
}

TEST_CASE("Matrices without rows or without neighbours, and small ones, need no coarse level") {
  sk::Device device = sk::Device::native();
  for (const std::int64_t n : {0, 1, 2, 100, 101, 1000}) {
    CAPTURE(n);
    const SparseMatrix a = diagonalMatrix(n);
    const std::vector<double> b = wavy(n);
    const Reached r = solveByAggregation(device, a, b);
    CHECK(r.solution.outcome == Outcome::Converged);
    REQUIRE(r.hierarchy.levels.size() == 1);
    CHECK(r.hierarchy.operatorComplexity() == 1.0);
    CHECK(r.solution.iterations <= 2);
    for (std::size_t i = 0; i < b.size(); ++i)
      CHECK(std::abs(r.solution.x[i] - b[i] / (1.0 + static_cast<double>(i % 7))) <= 1e-9);
  }
  const Entry two[] = {{0, 0, 2.0}, {0, 1, 1.0}, {1, 0, 1.0}, {1, 1, 2.0}};
  const Reached r = solveByAggregation(device, assemble(2, 2, two), {4.0, 5.0});
  CHECK(r.solution.iterations <= 2);
  CHECK(std::abs(r.solution.x[0] - 1.0) <= 1e-9);
  CHECK(std::abs(r.solution.x[1] - 2.0) <= 1e-9);
}

TEST_CASE("Matrices that smoothed aggregation cannot take are told, with what can") {
  sk::Device device = sk::Device::native();
  const Entry zero[] = {{0, 1, 1.0}, {1, 0, 1.0}, {1, 1, 1.0}};
  CHECK_THROWS_WITH(solveByAggregation(device, assemble(2, 2, zero), {1, 2}),
                    "row 1 has no diagonal entry, or 0, and the preconditioner 'aggregation' divides by it; "
                    "take the preconditioner 'none'");
  const Entry negative[] = {{0, 0, 1.0}, {1, 1, -2.0}};
  CHECK_THROWS_WITH(
      solveByAggregation(device, assemble(2, 2, negative), {1, 2}),
      "row 2 has the diagonal entry -2, and the preconditioner 'aggregation' needs positive "
      "ones, as positive definite matrices have; take the solver 'minres' and the preconditioner 'none'");
}

}  // namespace
}  // namespace sk::linear
