// SPDX-License-Identifier: MIT
//
// Flows whose end is known, and surfaces with faults.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>
#include <sk/sk.hpp>

#include "equations.hpp"
#include "flow.hpp"
#include "support/testing.hpp"

namespace smooth {
namespace {

/// The relative error of the mean radius of a unit sphere after the time 0.1, for which the exact radius is sqrt(0.6).
double radiusError(sk::Device& device, int level, int steps) {
  Flow flow(device, sphere(level, 1.0), {.timeStep = 0.1 / steps, .layout = "buckets"});
  for (int i = 0; i < steps; ++i) flow.step();
  double sum = 0.0;
  for (const Vector& p : flow.surface().points) sum += length(p);
  return std::abs(sum / static_cast<double>(flow.surface().points.size()) / std::sqrt(0.6) - 1.0);
}

TEST_CASE("A sphere shrinks as sqrt(r^2 - 4 t), the closer the finer it is") {
  sk::Device device = sk::Device::native();
  // The error is of the first order in the time step and of the second in the edges, so that both fall by four.
  const double coarse = radiusError(device, 1, 4), fine = radiusError(device, 2, 16);
  CAPTURE(coarse, fine);
  CHECK(fine < 0.012);
  CHECK(coarse / fine > 3.0);
  CHECK(coarse / fine < 5.5);
}

TEST_CASE("Noise goes, and volume stays where it is kept") {
  sk::Device device = sk::Device::native();
  Surface noisy = sphere(2, 1.0);
  addNoise(noisy, 0.08, 7);
  const double volume = volumeOf(noisy);
  CHECK(areaOf(noisy) > 1.04 * std::cbrt(36.0 * M_PI * volume * volume));
  Flow flow(device, noisy, {.timeStep = 0.01, .keepsVolume = true, .layout = "buckets"});
  StepReport report;
  for (int i = 0; i < 3; ++i) report = flow.step();
  CHECK(report.residual <= 1e-8);
  CHECK(std::abs(report.volume / volume - 1.0) < 1e-12);
  // A sphere has the least area for its volume; flat faces have up to 2 % more at this level.
  CHECK(report.area < 1.03 * std::cbrt(36.0 * M_PI * volume * volume));
}

TEST_CASE("A torus has its area and volume, and both shrink") {
  sk::Device device = sk::Device::native();
  const Surface ring = torus(48, 24, 1.0, 0.4);
  CHECK(volumeOf(ring) == Approx(2.0 * M_PI * M_PI * 0.16).epsilon(0.02));
  CHECK(areaOf(ring) == Approx(4.0 * M_PI * M_PI * 0.4).epsilon(0.01));
  Flow flow(device, ring, {.timeStep = 0.001, .layout = "buckets"});
  const StepReport report = flow.step();
  // dV/dt is the integral of minus twice the mean curvature, which is 4 pi^2 R for a torus.
  // 24 edges across make an error of 2 %, the time step one of 1 %.
  CHECK((report.volume - volumeOf(ring)) / 0.001 == Approx(-4.0 * M_PI * M_PI).epsilon(0.03));
}

TEST_CASE("Devices agree") {
  Surface noisy = sphere(1, 1.0);
  addNoise(noisy, 0.1, 3);
  sk::Device native = sk::Device::native();
  Flow expected(native, noisy, {.timeStep = 0.02, .layout = "buckets"});
  expected.step();
  for (const char* profile : {"glsl330", "glsl430"}) {
    CAPTURE(profile);
    sk::Device device({.device = "software", .profile = profile});
    Flow flow(device, noisy, {.timeStep = 0.02, .layout = "buckets"});
    flow.step();
    // Both solve to 1e-8 of changes that are below 0.2.
    for (std::size_t i = 0; i < noisy.points.size(); ++i)
      CHECK(length(flow.surface().points[i] - expected.surface().points[i]) < 1e-7);
  }
}

TEST_CASE("A step writes the values of its own positions to the streams of the first") {
  sk::Device device = sk::Device::native();
  Surface noisy = sphere(1, 1.0);
  addNoise(noisy, 0.1, 3);
  // Values on the device differ by more than the tolerance in steps of this length.
  const FlowSettings settings{.timeStep = 0.05, .layout = "buckets"};
  Flow flow(device, noisy, settings);
  flow.step();
  Flow anew(device, flow.surface(), settings);
  const StepReport second = flow.step(), expected = anew.step();
  CHECK(flow.surface().points == anew.surface().points);
  CHECK(second.iterations == expected.iterations);
  CHECK(second.residual == expected.residual);
}

TEST_CASE("The matrix is symmetric, its Laplacian does not see constants, and M adds up to the area") {
  Surface noisy = sphere(1, 1.0);
  addNoise(noisy, 0.1, 3);
  noisy.faces.push_back({0, 0, 1});  // degenerate
  Equations equations(noisy);
  for (const double timeStep : {1.0, 0.05}) {
    equations.update(noisy, inspect(noisy), timeStep, false);
    CHECK(linear::asymmetry(equations.matrix()).empty());
    const std::vector<double> ones(noisy.points.size(), 1.0);
    for (const double v : linear::multiply(equations.laplacian(), ones)) CHECK(std::abs(v) < 1e-14);
    double sum = 0.0;
    for (const double v : linear::multiply(equations.matrix(), ones)) sum += v;
    CHECK(sum == Approx(areaOf(noisy)).epsilon(1e-12));
    // x . L x is twice the area on any triangulation.
    double energy = 0.0;
    for (double Vector::* const component : {&Vector::x, &Vector::y, &Vector::z}) {
      std::vector<double> x;
      for (const Vector& p : noisy.points) x.push_back(p.*component);
      const std::vector<double> lx = linear::multiply(equations.laplacian(), x);
      for (std::size_t i = 0; i < x.size(); ++i) energy += x[i] * lx[i];
    }
    CHECK(energy == Approx(2.0 * timeStep * areaOf(noisy)).epsilon(1e-12));
  }
}

/// A sphere of which some vertices almost lie on an edge beside them: its triangles are then `thin` times as high as they are wide.
Surface spoiled(double thin) {
  Surface s = sphere(2, 1.0);
  std::vector<bool> isMoved(s.points.size(), false);
  for (std::size_t f = 0; f < s.faces.size(); f += 17) {
    const auto& [i, j, k] = s.faces[f];
    const auto at = [](std::int32_t p) { return static_cast<std::size_t>(p); };
    if (isMoved[at(i)] || isMoved[at(j)] || isMoved[at(k)]) continue;
    const Vector middle = 0.5 * (s.points[at(j)] + s.points[at(k)]);
    s.points[at(i)] = middle + thin * (s.points[at(i)] - middle);
    for (const std::int32_t p : {i, j, k}) isMoved[at(p)] = true;
  }
  return s;
}

TEST_CASE("Meshes with slivers flow in the precision that their matrix needs") {
  for (const bool hasDoubles : {true, false}) {
    sk::Device device = examples::deviceNamed(hasDoubles ? "native" : "essl300");
    CAPTURE(hasDoubles);
    Flow flow(device, spoiled(1e-7), {.timeStep = 0.01, .layout = "rows"});
    const double before = areaOf(flow.surface());
    for (int i = 0; i < (hasDoubles ? 5 : 1); ++i) CHECK(flow.step().residual <= 1e-8);
    CHECK(flow.precision() == (hasDoubles ? "double" : "extended"));
    CHECK(areaOf(flow.surface()) < before);
  }
  sk::Device device = sk::Device::native();
  Flow round(device, sphere(2, 1.0), {.timeStep = 0.01, .layout = "rows"});
  round.step();
  CHECK(round.precision() == "single");
  CHECK_THROWS_WITH(Flow(device, sphere(1, 1.0), {.precision = "half"}),
                    "no precision is called 'half'; there are auto, single, extended, double");
}

TEST_CASE("A step is solved to the tolerance, or as exactly as doubles can") {
  sk::Device device = sk::Device::native();
  Surface noisy = sphere(2, 1.0);
  addNoise(noisy, 0.05, 7);
  Flow flow(device, noisy, {.timeStep = 0.01, .layout = "rows", .tolerance = 1e-18});
  const StepReport exact = flow.step();
  CHECK(exact.residual > 1e-18);
  CHECK(exact.residual < 1e-12);
  CHECK(exact.backwardError > 0.0);
  CHECK(exact.backwardError <= mostBackwardError);
  Flow usual(device, noisy, {.timeStep = 0.01, .layout = "rows"});
  CHECK(usual.step().backwardError == 0.0);
}

TEST_CASE("Steps that Jacobi's preconditioner does not solve take one that is made for their matrix") {
  sk::Device device = sk::Device::native();
  Surface noisy = sphere(3, 1.0);
  addNoise(noisy, 0.05, 7);
  Flow usual(device, noisy, {.timeStep = 1.0, .layout = "rows"});
  Flow hurried(device, noisy, {.timeStep = 1.0, .layout = "rows", .jacobiIterations = 60});
  CHECK(usual.preconditioner().empty());
  for (int i = 0; i < 2; ++i) {
    const StepReport expected = usual.step(), report = hurried.step();
    CHECK(report.residual <= 1e-8);
    CHECK(report.area == Approx(expected.area).epsilon(1e-6));
    CHECK(report.iterations < expected.iterations);
  }
  CHECK(usual.preconditioner() == "jacobi");
  CHECK(hurried.preconditioner() == "aggregation");
}

TEST_CASE("Surfaces of needles flow, also where they are thinner than doubles resolve") {
  sk::Device device = sk::Device::native();
  for (const double height : {1e-6, 1e-8, 1e-9}) {
    Surface needles = sphere(3, 1.0);
    for (Vector& p : needles.points) p = {p.x, height * p.y, height * p.z};
    Flow flow(device, needles, {.timeStep = 0.01, .layout = "rows"});
    CAPTURE(1.0 / height);
    for (int i = 0; i < 3; ++i) CHECK(flow.step().area < areaOf(needles));
  }
}

/// Steps while they succeed, at most 20; the area shrinks in each. Returns why there is no further step.
std::string endOf(Flow& flow) {
  double area = areaOf(flow.surface());
  try {
    for (int i = 0; i < 20; ++i) {
      const double next = flow.step().area;
      CHECK(next < area);
      area = next;
    }
  } catch (const std::runtime_error& error) {
    CHECK(area < 1e-3);
    return error.what();
  }
  return "";
}

TEST_CASE("Surfaces flow until they are curves or points, and the message says so") {
  sk::Device device = sk::Device::native();
  Flow ball(device, sphere(1, 1.0), {.timeStep = 0.2, .layout = "rows"});
  CHECK_THAT(endOf(ball),
             Catch::Contains("the surface has almost shrunk to curves or points; take fewer steps"));
  // A thin ring becomes a circle, on which triangles have an area and no height that doubles resolve beside their length.
  Flow ring(device, torus(48, 16, 1.0, 0.1), {.layout = "rows"});
  CHECK_THAT(endOf(ring),
             Catch::Contains("the surface has almost shrunk to curves or points; take fewer steps"));
}

TEST_CASE("The bound of the least eigenvalue holds") {
  for (const double thin : {1.0, 1e-2, 1e-4}) {
    const Surface s = spoiled(thin);
    Equations equations(s);
    equations.update(s, inspect(s), 0.01, false);
    // Rayleigh's quotients of the matrix scaled by its diagonal, for many vectors, among them peaks at each point.
    const linear::SparseMatrix& a = equations.matrix();
    const std::vector<double> d = linear::diagonal(a);
    double least = 1.0;
    std::minstd_rand random(3);
    for (std::size_t k = 0; k < 2 * s.points.size(); ++k) {
      std::vector<double> x(s.points.size(), k < s.points.size() ? 0.0 : 1.0);
      if (k < x.size()) x[k] = 1.0;
      if (k > x.size())
        for (double& v : x) v = static_cast<double>(random() % 1000) - 500.0;
      const std::vector<double> ax = linear::multiply(a, x);
      double above = 0.0, below = 0.0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        above += x[i] * ax[i];
        below += x[i] * d[i] * x[i];
      }
      least = std::min(least, above / below);
    }
    CHECK(equations.leastEigenvalue() <= least);
    CHECK(equations.leastEigenvalue() > 0.0);
  }
}

TEST_CASE("A step of any length ends at the centre of each part") {
  sk::Device device = sk::Device::native();
  Surface two = sphere(1, 1.0);
  const auto first = static_cast<std::int32_t>(two.points.size());
  const Surface other = torus(12, 8, 1.0, 0.4);
  for (const Vector& p : other.points) two.points.push_back(p + Vector{5.0, 1.0, 0.0});
  for (const Triangle& f : other.faces) two.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
  Flow flow(device, two, {.timeStep = 1e12, .layout = "rows"});
  CHECK(flow.step().residual <= 1e-8);
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(two.points.size()); ++i) {
    const Vector centre = i < first ? Vector{0.0, 0.0, 0.0} : Vector{5.0, 1.0, 0.0};
    CHECK(length(flow.surface().points[static_cast<std::size_t>(i)] - centre) < 1e-5);
  }
}

TEST_CASE("Boundaries stay or flow, and faults are named and harmless") {
  sk::Device device = sk::Device::native();
  // A fan of four triangles with its middle raised, a degenerate triangle, an edge of three triangles, and a vertex alone.
  Surface s;
  s.points = {{0, 0, 0.5}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {9, 9, 9}, {1, 1, 1}, {1, 1, -1}};
  s.faces = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {1, 1, 2}, {2, 1, 6}, {2, 1, 7}};
  const Faults faults = inspect(s);
  CHECK(faults.degenerate == std::vector<std::int64_t>{4});
  CHECK(faults.isolated == std::vector<std::int32_t>{5});
  CHECK(faults.nonManifold == std::vector<std::pair<std::int32_t, std::int32_t>>{{1, 2}});
  CHECK_FALSE(faults.isClosed);
  CHECK_FALSE(faults.boundary[0]);
  CHECK_THAT(textOf(faults), Catch::Contains("1 degenerate triangles have no weight: 5\n"));
  CHECK_THAT(textOf(faults), Catch::Contains(": 2-3\n"));
  CHECK_THAT(textOf(faults), Catch::Contains(": 6\n"));

  Flow fixed(device, s, {.timeStep = 0.1});
  fixed.step();
  for (const std::size_t i : {1u, 2u, 3u, 4u, 5u, 6u, 7u}) CHECK(fixed.surface().points[i] == s.points[i]);
  CHECK_FALSE(fixed.surface().points[0] == s.points[0]);
  Flow free(device, s, {.timeStep = 0.1, .fixesBoundary = false});
  free.step();
  CHECK(length(free.surface().points[3]) < 1.0);
  CHECK(free.surface().points[5] == s.points[5]);
  CHECK_THROWS_WITH(Flow(device, s, {.keepsVolume = true}), Catch::Contains("keep_volume"));
  s.faces = {{1, 1, 2}};
  CHECK_THROWS_WITH(Flow(device, s, {}), Catch::Contains("no triangle with an area"));
}

TEST_CASE("OBJ files come back to the bit, and wrong ones name line and column") {
  Surface noisy = sphere(1, 1.0);
  addNoise(noisy, 0.1, 5);
  saveObj("smooth_test.obj", noisy);
  const Surface read = loadObj("smooth_test.obj");
  CHECK(read.points == noisy.points);
  CHECK(read.faces == noisy.faces);
  std::filesystem::remove("smooth_test.obj");
  const auto failure = [](const std::string& text) {
    const examples::WrittenFile file(text, "wrong.obj");
    CHECK_THROWS_WITH(loadObj(file.path()), Catch::Contains("wrong.obj:2:"));
  };
  failure("v 0 0 0\nv 1 x 0\n");
  failure("v 0 0 0\nv 1 nan 0\n");
  failure("v 0 0 0\nf 1 2 3\n");
  failure("v 0 0 0\nf 1 1\n");
}

}  // namespace
}  // namespace smooth
