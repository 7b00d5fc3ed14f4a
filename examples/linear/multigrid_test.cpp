// SPDX-License-Identifier: MIT
//
// What multigrid promises: a rate of convergence that does not depend on the grid, a symmetric preconditioner, nested iteration down to
// the discretisation's error.
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <sk/sk.hpp>

#include "multigrid.hpp"
#include "operator.hpp"
#include "stencil.hpp"

namespace linear {
namespace {

constexpr Arithmetic doubles{
    .precision = sk::Precision::Double, .matrix = sk::Storage::Double, .vectors = sk::Storage::Double};

std::vector<double> randomVector(std::int64_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<double> v(static_cast<std::size_t>(n));
  for (double& x : v) x = std::uniform_real_distribution<double>(-1, 1)(random);
  return v;
}

double norm(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
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
  double fifth = 0.0;
  for (int k = 0; k < 8; ++k) {
    const std::vector<double> product = multiply(a, appliedTo(device, *m, a, r, doubles));
    for (std::size_t i = 0; i < r.size(); ++i) r[i] -= product[i];
    if (k == 4) fifth = norm(r);
  }
  return fifth > 0.0 ? std::cbrt(norm(r) / fifth) : 0.0;
}

TEST_CASE("V(2,1)-cycles converge at one rate on every grid") {
  sk::Device device = sk::Device::native();
  for (const sk::Shape& grid :
       {sk::Shape{31, 31}, sk::Shape{32, 32}, sk::Shape{61, 67}, sk::Shape{127, 127}, sk::Shape{40, 3}}) {
    CAPTURE(grid[0], grid[1]);
    CHECK(rateOf(device, poisson(grid), {.before = 2, .after = 1, .isSymmetric = false}) < 0.15);
  }
  CHECK(rateOf(device, poisson({15, 16, 17}), {.before = 2, .after = 1, .isSymmetric = false}) < 0.3);
  CHECK(rateOf(device, poisson({1, 1}), {}) < 0.01);
}

TEST_CASE("V(2,1)-cycles converge as fast where one dimension couples more strongly") {
  sk::Device device = sk::Device::native();
  for (const double ratio : {1e-3, 0.1, 10.0, 1e3}) {
    CAPTURE(ratio);
    const Stencil plane = poisson({45, 52}, std::array{1.0, ratio});
    CHECK(rateOf(device, plane, {.before = 2, .after = 1, .isSymmetric = false}) < 0.2);
    const Stencil solid = poisson({12, 14, 17}, std::array{1.0, ratio, 1.0});
    CHECK(rateOf(device, solid, {.before = 2, .after = 1, .isSymmetric = false}) < 0.3);
  }
  CHECK_THROWS_WITH(poisson({3, 4}, std::array{1.0}), Catch::Contains("as many diffusivities, not 1"));
  CHECK_THROWS_WITH(poisson({3, 4}, std::array{1.0, -2.0}), Catch::Contains("which -2 is not"));
}

TEST_CASE("A V-cycle is a symmetric preconditioner") {
  sk::Device device = sk::Device::native();
  for (const sk::Shape& grid : {sk::Shape{13, 18}, sk::Shape{7, 9, 6}}) {
    const Stencil a = poisson(grid);
    const std::unique_ptr<Preconditioner> m = makeMultigrid(device, a, doubles, {});
    const std::vector<double> u = randomVector(a.size(), 2), v = randomVector(a.size(), 3);
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

/// The largest error against sin(pi x) sin(pi y), which solves Poisson's equation for 2 pi^2 times itself, after one full
/// multigrid cycle.
double nestedError(sk::Device& device, std::int64_t n) {
  const Stencil a = poisson({n, n});
  const std::unique_ptr<Preconditioner> m =
      makeMultigrid(device, a, doubles, {.cycle = Cycle::Full, .isSymmetric = false});
  const double pi = std::acos(-1.0), h = 1.0 / static_cast<double>(n + 1);
  std::vector<double> exact(static_cast<std::size_t>(n * n)), b(exact.size());
  for (std::int64_t i = 0; i < n * n; ++i) {
    const double u =
        std::sin(pi * h * static_cast<double>(i % n + 1)) * std::sin(pi * h * static_cast<double>(i / n + 1));
    exact[static_cast<std::size_t>(i)] = u;
    b[static_cast<std::size_t>(i)] = 2 * pi * pi * h * h * u;
  }
  const std::vector<double> x = appliedTo(device, *m, a, b, doubles);
  double largest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, std::abs(x[i] - exact[i]));
  return largest;
}

TEST_CASE(
    "Full multigrid reaches the error of the discretisation, which falls with the square of the distance") {
  sk::Device device = sk::Device::native();
  for (const std::int64_t n : {31, 63}) {
    CAPTURE(n);
    const double pi = std::acos(-1.0);
    const double discretisation =
        std::pow(pi / static_cast<double>(n + 1), 2) / 12.0;  // for this solution, but for higher orders
    CHECK(nestedError(device, n) < 2 * discretisation);
  }
}

TEST_CASE("Multigrid computes alike where it is drawn") {
  const Stencil a = poisson({13, 18});
  const std::vector<double> r = randomVector(a.size(), 5);
  sk::Device native = sk::Device::native();
  const std::vector<double> expected =
      appliedTo(native, *makeMultigrid(native, a, doubles, {}), a, r, doubles);
  for (const char* profile : {"glsl330", "essl300"}) {
    CAPTURE(profile);
    sk::Device device(sk::DeviceOptions{.device = "software", .profile = profile});
    const std::vector<double> z = appliedTo(device, *makeMultigrid(device, a, {}, {}), a, r, {});
    for (std::size_t i = 0; i < z.size(); ++i) CHECK(std::abs(z[i] - expected[i]) < 1e-5);
  }
}

TEST_CASE("Coarse grids keep the equation") {
  Stencil a = poisson({9, 3});
  a.centre += 0.5;  // a reaction, which does not depend on the distance
  const Stencil coarse = coarsened(a);
  CHECK(coarse.grid == sk::Shape{4, 3});
  CHECK(coarse.along[0] == Approx(-0.25));
  CHECK(coarse.along[1] == -1.0);
  CHECK(coarse.centre == Approx(0.5 + 2 * 0.25 + 2));
  sk::Device device = sk::Device::native();
  a.centre = 0.0;
  CHECK_THROWS_WITH(makeMultigrid(device, a, {}, {}), Catch::Contains("centre, which is 0"));
  CHECK_THROWS_WITH(makeMultigrid(device, poisson({40000, 2}), {}, {}), Catch::Contains("not 40000"));
}

}  // namespace
}  // namespace linear
