// SPDX-License-Identifier: MIT
//
// What multigrid promises: a rate of convergence that does not depend on the grid, a symmetric preconditioner, nested iteration down to
// the discretisation's error.
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>
#include <sk/sk.hpp>

#include "compact.hpp"
#include "multigrid.hpp"
#include "operator.hpp"
#include "solve.hpp"
#include "stencil.hpp"
#include "test_solves.hpp"

namespace sk::linear {
namespace {

Stencil poissonWith(const sk::Shape& grid, const std::vector<Ends>& ends) {
  return withEnds(poisson(grid), ends);
}

void removeMean(std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x;
  for (double& x : v) x -= sum / static_cast<double>(v.size());
}

std::vector<double> appliedTo(sk::Device& device, Preconditioner& m, const Stencil& a,
                              const std::vector<double>& r, const Arithmetic& arithmetic) {
  Vector in = device.stream<float>(a.grid, arithmetic.vectors),
         out = device.stream<float>(a.grid, arithmetic.vectors);
  Vector rz = device.stream<float>({1}, arithmetic.sums());
  in.writeReals(r);
  m.apply(in, out, rz);
  return out.readReals();
}

/// The factor of the residual in one cycle, when it has settled: of the last three of eight.
double rateOf(sk::Device& device, const Stencil& a, const MultigridSettings& settings) {
  const std::unique_ptr<Preconditioner> m = makeMultigrid(device, a, doubles, settings);
  std::vector<double> r = randomVector(a.size(), 1);
  if (hasConstantKernel(a)) removeMean(r);
  double fifth = 0.0;
  for (int k = 0; k < 8; ++k) {
    const std::vector<double> product = multiply(a, appliedTo(device, *m, a, r, doubles));
    for (std::size_t i = 0; i < r.size(); ++i) r[i] -= product[i];
    if (hasConstantKernel(a)) removeMean(r);  // of rounding errors, which no cycle reduces
    if (k == 4) fifth = norm(r);
  }
  return fifth > 0.0 ? std::cbrt(norm(r) / fifth) : 0.0;
}

/// V(2,1)-cycles smooth twice before and once after each coarse correction.
constexpr MultigridSettings sweeps{.before = 2, .after = 1, .isSymmetric = false};

TEST_CASE("V(2,1)-cycles converge at one rate on every grid") {
  sk::Device device = sk::Device::native();
  for (const sk::Shape& grid :
       {sk::Shape{31, 31}, sk::Shape{32, 32}, sk::Shape{61, 67}, sk::Shape{127, 127}, sk::Shape{40, 3}}) {
    CAPTURE(grid[0], grid[1]);
    CHECK(rateOf(device, poisson(grid), sweeps) < 0.15);
  }
  CHECK(rateOf(device, poisson({15, 16, 17}), sweeps) < 0.3);
  CHECK(rateOf(device, poisson({1, 1}), {}) < 0.01);
}

TEST_CASE("Every grid of a hierarchy has a rate of its own, which the preconditioner measures") {
  for (sk::Device& device : testDevices()) {
    const bool isNative = device.profile() == sk::Device::native().profile();
    for (const sk::Shape& grid : {sk::Shape{64, 61}, sk::Shape{33, 90}, sk::Shape{127, 127}}) {
      if (!isNative && grid[0] != 33) continue;  // drawn on the host: slow
      CAPTURE(device.profile(), grid[0], grid[1]);
      const std::vector<LevelRate> rates = makeMultigrid(device, poisson(grid), {}, sweeps)->rates();
      REQUIRE(rates.size() >= 5);
      CHECK(rates.front().grid == grid);
      CHECK(rates.back().grid.size() <= 9);
      for (const LevelRate& level : rates) CHECK(level.rate <= 0.15);
      CHECK(rates.back().rate < 1e-5);  // solved by its inverse
      if (grid[0] == 127)
        CHECK(rates.front().rate == Approx(rateOf(device, poisson(grid), sweeps)).margin(0.02));
    }
  }
  sk::Device device = sk::Device::native();
  for (const LevelRate& level :
       makeMultigrid(device, poissonWith({20, 31}, {mirrors, ring}), {}, sweeps)->rates())
    CHECK(level.rate <= 0.15);
  CHECK(makeMultigrid(device, poisson({9, 9}), {}, {.before = 0, .after = 1})->rates()[0].rate > 0.15);
}

TEST_CASE("V(2,1)-cycles converge as fast where one dimension couples more strongly") {
  sk::Device device = sk::Device::native();
  for (const double ratio : {1e-3, 0.1, 10.0, 1e3}) {
    CAPTURE(ratio);
    const Stencil plane = poisson({45, 52}, std::array{1.0, ratio});
    CHECK(rateOf(device, plane, sweeps) < 0.2);
    const Stencil solid = poisson({12, 14, 17}, std::array{1.0, ratio, 1.0});
    CHECK(rateOf(device, solid, sweeps) < 0.3);
  }
  CHECK_THROWS_WITH(poisson({3, 4}, std::array{1.0}), Catch::Contains("as many diffusivities, not 1"));
  CHECK_THROWS_WITH(poisson({3, 4}, std::array{1.0, -2.0}), Catch::Contains("which -2 is not"));
}

TEST_CASE("V(2,1)-cycles converge at one rate whatever the ends of the grid") {
  sk::Device device = sk::Device::native();
  for (const std::int64_t n : {17, 32, 61})
    for (const Ends& ends : {mirrors, ring, mixed, turned})
      for (const Ends& others : {ends, fixedEnds}) {
        CAPTURE(n, static_cast<int>(ends.low), static_cast<int>(ends.high), others == ends);
        const Stencil a = poissonWith({n, n + 2}, {ends, others});
        // At the seams of two rings with odd extents, on this grid or a coarser one, neighbours of one colour are relaxed at once.
        const double bound = others == ring ? 0.2 : 0.15;
        CHECK(rateOf(device, a, sweeps) < bound);
      }
  for (const Ends& ends : {mirrors, ring, mixed}) {
    CAPTURE(static_cast<int>(ends.low), static_cast<int>(ends.high));
    const Stencil a = poissonWith({9, 10, 11}, {ends, ends, ends});
    CHECK(rateOf(device, a, sweeps) < 0.3);
  }
  for (const sk::Shape& grid : {sk::Shape{1, 2}, sk::Shape{3, 3}, sk::Shape{1, 40}}) {  // hardly a grid
    CAPTURE(grid[0], grid[1]);
    for (const Ends& ends : {mirrors, ring})
      CHECK(rateOf(device, poissonWith(grid, {ends, ends}), sweeps) < 0.15);
  }
}

TEST_CASE("A V-cycle is a symmetric preconditioner") {
  sk::Device device = sk::Device::native();
  for (const Stencil& a :
       {poisson({13, 18}), poisson({7, 9, 6}), poissonWith({13, 18}, {turned, ring}),
        poissonWith({13, 18}, {ring, mirrors}), poissonWith({7, 9, 6}, {mirrors, ring, mixed})}) {
    const std::unique_ptr<Preconditioner> m = makeMultigrid(device, a, doubles, {});
    std::vector<double> u = randomVector(a.size(), 2), v = randomVector(a.size(), 3);
    if (hasConstantKernel(a)) {
      removeMean(u);
      removeMean(v);
    }
    const std::vector<double> mu = appliedTo(device, *m, a, u, doubles),
                              mv = appliedTo(device, *m, a, v, doubles);
    double vMu = 0.0, uMv = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      vMu += v[i] * mu[i];
      uMv += u[i] * mv[i];
    }
    CHECK(std::abs(vMu - uMv) <= 1e-5 * norm(u) * norm(v));  // the weights between grids are floats
  }
}

Solution solved(sk::Device& device, const Stencil& a, const std::vector<double>& b,
                std::string_view preconditioner, double tolerance) {
  const Operator o = operatorOf(a);
  return solveBy(device, *makeMatrix(scaled(a, o.scale), Arithmetic{}), o, b,
                 {.preconditioner = preconditioner, .settings = {.tolerance = tolerance}});
}

/// The largest errors after one and two cycles of full multigrid, as parts of the largest error of the discretisation.
std::array<double, 2> nestedErrors(sk::Device& device, const KnownSolution& known,
                                   const Arithmetic& arithmetic) {
  const std::unique_ptr<Preconditioner> m =
      makeMultigrid(device, known.grid, arithmetic, {.cycle = Cycle::Full, .isSymmetric = false});
  const std::vector<double> b = known.secondOrder();
  const double discretisation = known.errorOf(solved(device, known.grid, b, "multigrid", 1e-10).x);
  std::vector<double> x(b.size(), 0.0);
  std::array<double, 2> errors{};
  for (double& error : errors) {
    std::vector<double> r = multiply(known.grid, x);
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = b[i] - r[i];
    const std::vector<double> z = appliedTo(device, *m, known.grid, r, arithmetic);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += z[i];
    error = known.errorOf(x) / discretisation;
  }
  return errors;
}

TEST_CASE("One cycle of full multigrid reaches the error of the discretisation") {
  for (sk::Device& device : testDevices()) {
    const bool isNative = device.profile() == sk::Device::native().profile();
    for (const auto& [rank, n] :
         {std::pair{2, 31}, std::pair{2, 64}, std::pair{2, 127}, std::pair{3, 15}, std::pair{3, 20}}) {
      if (!isNative && n != 31) continue;  // drawn on the host: slow
      CAPTURE(device.profile(), rank, n);
      const std::array<double, 2> errors = nestedErrors(device, KnownSolution(rank, n), {});
      CHECK(errors[0] < 1.1);
      CHECK(errors[1] == Approx(1).margin(0.03));
    }
  }
}

TEST_CASE("Solutions of coarse grids are interpolated to the fourth order at every end") {
  sk::Device device = sk::Device::native();
  const double pi = std::acos(-1.0);
  /// A smooth function that the ends of a dimension allow, from 0 to 1.
  const auto along = [&](const Ends& ends, double t) {
    if (ends == mirrors) return std::cos(pi * t) + 0.5 * std::cos(2 * pi * t);
    if (ends == ring) return std::sin(2 * pi * t + 0.3);
    if (ends == mixed) return t * (2 - t);
    if (ends == turned) return (1 - t) * (1 + t);
    return t * (1 - t) * std::exp(t);
  };
  /// The largest error on a grid of n elements along each dimension.
  const auto error = [&](const std::vector<Ends>& ends, std::int64_t n) {
    const Stencil fine = poissonWith(ends.size() == 2 ? sk::Shape{n, n} : sk::Shape{n, n, n}, ends);
    const auto values = [&](const sk::Shape& grid) {
      std::vector<double> product{1.0};
      for (std::size_t d = 0; d < ends.size(); ++d) {
        const std::int64_t extent = grid[static_cast<int>(d)];
        const double first = ends[d].low == Side::Dirichlet ? 2.0 : 1.0;
        std::vector<double> more;
        for (const double v : product)
          for (std::int64_t i = 0; i < extent; ++i)
            more.push_back(v * along(ends[d], (2.0 * static_cast<double>(i) + first) /
                                                  static_cast<double>(doubleLength(fine, d, extent))));
        product = more;
      }
      return product;
    };
    const std::unique_ptr<Hierarchy> levels = makeHierarchy(device, fine, doubles, true);
    const sk::Shape coarse = levels->grid(1);
    Vector in = device.stream<float>(coarse, sk::Storage::Double),
           out = device.stream<float>(fine.grid, sk::Storage::Double);
    in.writeReals(values(coarse));
    levels->interpolate(0, in, out);
    const std::vector<double> result = out.readReals(), expected = values(fine.grid);
    double largest = 0.0;
    for (std::size_t i = 0; i < result.size(); ++i)
      largest = std::max(largest, std::abs(result[i] - expected[i]));
    return largest;
  };
  for (const Ends& ends : {fixedEnds, mirrors, ring, mixed, turned}) {
    CAPTURE(static_cast<int>(ends.low), static_cast<int>(ends.high));
    CHECK(error({ends, fixedEnds}, 24) / error({ends, fixedEnds}, 48) > 12);  // 16, but for higher orders
    CHECK(error({ends, fixedEnds}, 33) < 3e-4);
    CHECK(error({fixedEnds, ends, ring}, 12) / error({fixedEnds, ends, ring}, 24) > 10);
    CHECK(std::isfinite(error({ends, ends}, 4)));
  }
}

TEST_CASE("Multigrid computes alike on every device") {
  std::vector<sk::Device> all = testDevices();
  for (const Stencil& a :
       {poisson({13, 18}), poissonWith({13, 17}, {turned, ring}), poissonWith({13, 18}, {ring, mirrors})}) {
    std::vector<double> r = randomVector(a.size(), 5);
    if (hasConstantKernel(a)) removeMean(r);
    const std::vector<double> expected =
        appliedTo(all[0], *makeMultigrid(all[0], a, doubles, {}), a, r, doubles);
    for (sk::Device& device : all) {
      CAPTURE(device.profile());
      const std::vector<double> z = appliedTo(device, *makeMultigrid(device, a, {}, {}), a, r, {});
      for (std::size_t i = 0; i < z.size(); ++i) CHECK(std::abs(z[i] - expected[i]) < 1e-5);
    }
  }
}

/// An eigenvector of minus the second difference on n elements, and its eigenvalue.
struct Eigenpair {
  Eigenpair(const Ends& ends, std::int64_t n, int k) : v(static_cast<std::size_t>(n)) {
    const double pi = std::acos(-1.0), length = static_cast<double>(n);
    const auto fill = [&](double angle, double first, bool isSine) {
      for (std::int64_t i = 0; i < n; ++i) {
        const double at = angle * (static_cast<double>(i) + first);
        v[static_cast<std::size_t>(i)] = isSine ? std::sin(at) : std::cos(at);
      }
      value = 4 * std::pow(std::sin(angle / 2), 2);
    };
    if (ends == fixedEnds)
      fill(pi * k / (length + 1), 1.0, true);
    else if (ends == mirrors)
      fill(pi * k / length, 0.5, false);
    else if (ends == ring)
      fill(2 * pi * k / length, 0.3, true);
    else if (ends == mixed)
      fill(pi * (k - 0.5) / (length + 0.5), 1.0, true);
    else if (ends == turned)
      fill(pi * (k - 0.5) / (length + 0.5), 0.5, false);
  }
  std::vector<double> v;
  double value = 0.0;
};

TEST_CASE("Products have the eigenvectors that the ends of the grid give") {
  const std::vector<std::vector<Ends>> cases = {
      {mirrors, ring},   {mixed, mirrors},       {ring, turned},          {fixedEnds, mirrors},
      {ring, fixedEnds}, {mirrors, ring, mixed}, {turned, mirrors, ring}, {ring, mixed, fixedEnds}};
  std::vector<sk::Device> all = testDevices();
  for (sk::Device& device : all)
    for (const std::vector<Ends>& ends : cases) {
      const bool isPlane = ends.size() == 2;
      const Stencil a = poissonWith(isPlane ? sk::Shape{7, 11} : sk::Shape{5, 6, 7}, ends);
      std::vector<double> v{1.0};
      double value = 0.0;
      for (std::size_t d = 0; d < ends.size(); ++d) {
        const Eigenpair e(ends[d], a.grid[static_cast<int>(d)], 2);
        value += e.value;
        std::vector<double> product;
        for (const double x : v)
          for (const double y : e.v) product.push_back(x * y);
        v = product;
      }
      CAPTURE(device.profile(), isPlane);
      const bool isNative = &device == &all[0];
      for (const Arithmetic& arithmetic : {Arithmetic{}, doubles}) {
        if (arithmetic.precision == sk::Precision::Double && !isNative) continue;
        Vector x = device.stream<float>(a.grid, arithmetic.vectors),
               y = device.stream<float>(a.grid, arithmetic.vectors);
        x.writeReals(v);
        makeMatrix(a, arithmetic)->multiply(x, y);
        const std::vector<double> av = y.readReals();
        // Coefficients add up to 4 rank; every term is rounded as it is added, and the eigenvector's elements are, too.
        const double rank = a.grid.rank();
        const double bound = 4 * rank * (2 * rank + 8) * arithmetic.roundoff();
        for (std::size_t i = 0; i < v.size(); ++i) CHECK(std::abs(av[i] - value * v[i]) <= bound);
      }
      const std::vector<double> host = multiply(a, v), stored = multiply(assemble(a), v);
      for (std::size_t i = 0; i < v.size(); ++i) {
        CHECK(std::abs(host[i] - value * v[i]) < 1e-13);
        CHECK(std::abs(stored[i] - value * v[i]) < 1e-13);
      }
    }
}

TEST_CASE("Singular grids drop the mean of the right-hand side, and tell it") {
  for (sk::Device& device : testDevices()) {
    if (device.profile() == "essl300") continue;  // drawn cycles are checked above
    CAPTURE(device.profile());
    const Stencil a = poissonWith({13, 11}, {mirrors, ring});
    const std::vector<double> x = randomVector(a.size(), 7);
    std::vector<double> b = multiply(a, x);
    for (double& v : b) v += 0.75;
    const Solution s = solved(device, a, b, "multigrid", 1e-10);
    CHECK(s.outcome == Outcome::SingularAndCompatible);
    CHECK(s.removedMean == Approx(0.75));
    CHECK(s.residualTrue <= 1e-10);
    CHECK(s.iterations <= 16);
    double sum = 0.0;
    for (const double v : s.x) sum += v;
    CHECK(std::abs(sum) < 1e-12);
    const std::vector<double> ax = multiply(a, s.x);
    for (std::size_t i = 0; i < b.size(); ++i) CHECK(std::abs(ax[i] - (b[i] - 0.75)) < 1e-8);
  }
  sk::Device device = sk::Device::native();
  const Solution constant =
      solved(device, poissonWith({5, 7}, {ring, ring}), std::vector<double>(35, 0.1), "jacobi", 1e-8);
  CHECK(constant.outcome == Outcome::SingularAndCompatible);
  CHECK(constant.iterations == 0);
  CHECK(constant.removedMean == Approx(0.1));
  const Stencil regular = poissonWith({9, 8}, {mirrors, mixed});
  CHECK(solved(device, regular, std::vector<double>(72, 1.0), "multigrid", 1e-8).outcome ==
        Outcome::Converged);
}

TEST_CASE("Ends of grids are pairs") {
  CHECK_THROWS_WITH(poissonWith({3, 4}, {ring}), Catch::Contains("as many pairs of ends, not 1"));
  CHECK_THROWS_WITH(poissonWith({3, 4}, {ring, {Side::Periodic, Side::Neumann}}),
                    Catch::Contains("is periodic"));
}

TEST_CASE("Coarse grids keep the equation") {
  Stencil a = poisson({9, 3});
  a.centre += 0.5;  // a reaction, which does not depend on the distance
  const Stencil coarse = coarsened(a);
  CHECK(coarse.grid == sk::Shape{4, 3});
  CHECK(coarse.along[0] == Approx(-0.25));
  CHECK(coarse.along[1] == -1.0);
  CHECK(coarse.centre == Approx(0.5 + 2 * 0.25 + 2));
  const Stencil ended = coarsened(poissonWith({9, 10}, {ring, mixed}));
  CHECK(ended.grid == sk::Shape{5, 5});
  CHECK(ended.along[0] == Approx(-std::pow(5.0 / 9.0, 2)));
  CHECK(ended.along[1] == Approx(-std::pow(5.5 / 10.5, 2)));
  sk::Device device = sk::Device::native();
  a.centre = 0.0;
  CHECK_THROWS_WITH(makeMultigrid(device, a, {}, {}), Catch::Contains("centre, which is 0"));
  CHECK_THROWS_WITH(makeMultigrid(device, poisson({40000, 2}), {}, {}), Catch::Contains("not 40000"));
}

}  // namespace
}  // namespace sk::linear
