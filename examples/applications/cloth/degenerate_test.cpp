// SPDX-License-Identifier: MIT
//
// Where formulas have no value: each case has a result that is written down, the same on every device.
#include <limits>

#include <catch2/catch.hpp>
#include <sk/sk.hpp>

#include "model.hpp"
#include "simulation.hpp"

using namespace examples;

namespace {

constexpr double notANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

sk::Device anyDevice() {
  const auto [device, profile] = GENERATE(
      table<const char*, const char*>({{"native", ""}, {"software", "glsl330"}, {"software", "glsl430"}}));
  return sk::Device({.device = device, .profile = profile});
}

/// A row of points with links of 0.25 m at rest.
Scene chain(int points) {
  Scene s;
  s.cloth.columns = points;
  s.cloth.rows = 1;
  s.cloth.width = 0.25 * (points - 1);
  s.links.structural = 1.0;
  return s;
}

Scene onePoint(const Body& body) {
  Scene s = chain(1);
  s.bodies = {body};
  return s;
}

/// Positions after one step from these and from rest.
std::vector<double> after(sk::Device& device, const Scene& scene, const std::vector<Vector>& at) {
  Simulation simulation(device, scene, Features::of(scene), sk::Precision::Single);
  State state{0, {}, {}, false, {}};
  for (const Vector& v : at) {
    state.positions.insert(state.positions.end(), {v.x, v.y, v.z, 1.0});
    state.displacements.insert(state.displacements.end(), {0.0, 0.0, 0.0});
  }
  simulation.restore(state);
  simulation.advance(1);
  return simulation.positions();
}

}  // namespace

TEST_CASE("points that coincide go apart along the cloth's axes", "[degenerate]") {
  sk::Device device = anyDevice();
  const std::vector<double> p = after(device, chain(2), {{1, 2, 3}, {1, 2, 3}});
  CHECK(p[0] == Approx(0.875));
  CHECK(p[4] == Approx(1.125));
  CHECK(p[1] == 2);
  CHECK(p[6] == 3);
  // So near that their square is no float.
  const std::vector<double> near = after(device, chain(2), {{0, 0, 0}, {1e-30, 0, 0}});
  CHECK(near[4] - near[0] == Approx(0.25));
}

TEST_CASE("a link without length at rest pulls its ends together, and is content with them there",
          "[degenerate]") {
  sk::Device device = anyDevice();
  Scene s = chain(2);
  s.cloth.rest = 0;
  s.links.law = GENERATE(Law::Exact, Law::Jakobsen);
  const std::vector<double> apart = after(device, s, {{0, 0, 0}, {1, 0, 0}});
  CHECK(apart[0] == Approx(0.5));
  CHECK(apart[4] == Approx(0.5));
  const std::vector<double> together = after(device, s, {{1, 1, 1}, {1, 1, 1}});
  CHECK(together[0] == 1);
  CHECK(together[4] == 1);
}

TEST_CASE("what is too far, infinite or NaN pulls at nobody", "[degenerate]") {
  sk::Device device = anyDevice();
  for (const double far : {1e20, -3e38, infinity, notANumber}) {
    INFO(far);
    const std::vector<double> p = after(device, chain(3), {{0, 0, 0}, {0.25, 0, 0}, {far, 0, 0}});
    CHECK(p[0] == Approx(0).margin(1e-7));
    CHECK(p[4] == Approx(0.25));
    CHECK(p[5] == 0);
  }
}

TEST_CASE("a census finds the one broken point", "[degenerate]") {
  sk::Device device = anyDevice();
  const Scene s = chain(7);
  Simulation simulation(device, s, Features::of(s), sk::Precision::Single);
  State state = simulation.state();
  CHECK(simulation.census().broken == 0);
  state.positions[4 * 5 + 1] = GENERATE(notANumber, infinity);
  simulation.restore(state);
  simulation.advance(3);
  const Census census = simulation.census();
  CHECK(census.broken == 1);
  CHECK(simulation.state().firstBroken(Verlet::Displacements) == 5);
}

TEST_CASE("the middle of a body is left upwards, or by the nearest face", "[degenerate]") {
  sk::Device device = anyDevice();
  Body body;
  body.at = {1, 2, 3};
  body.size = {0.5, 0, 0};
  SECTION("sphere") { CHECK(after(device, onePoint(body), {{1, 2, 3}})[1] == Approx(2.5)); }
  SECTION("capsule") {
    body.kind = Kind::Capsule;
    body.along = {2, 0, 0};
    CHECK(after(device, onePoint(body), {{2, 2, 3}})[1] == Approx(2.5));
  }
  SECTION("capsule without length") {
    body.kind = Kind::Capsule;
    CHECK(after(device, onePoint(body), {{1, 2, 3}})[1] == Approx(2.5));
  }
  SECTION("box") {
    body.kind = Kind::Box;
    body.size = {0.5, 0.25, 0.5};
    CHECK(after(device, onePoint(body), {{1, 2, 3}})[1] == Approx(2.25));
    CHECK(after(device, onePoint(body), {{1.45, 2, 3}})[0] == Approx(1.5));
  }
  SECTION("on the surface nothing happens") { CHECK(after(device, onePoint(body), {{1.5, 2, 3}})[0] == 1.5); }
}

TEST_CASE("however deep a point is, it lands on the plane and stays", "[degenerate]") {
  sk::Device device = anyDevice();
  Body floor;
  floor.kind = Kind::Plane;
  floor.along = {0, 1, 0};
  const Scene s = onePoint(floor);
  const double depth = GENERATE(0.0, 1e-3, 1.0, 1e30);
  Simulation simulation(device, s, Features::of(s), sk::Precision::Single);
  State state{0, {0, -depth, 0, 1}, {0, 0, 0}, false, {}};
  simulation.restore(state);
  simulation.advance(50);
  const std::vector<double> p = simulation.positions();
  CHECK(p[1] == Approx(0).margin(1e-6));
}

TEST_CASE("NaN touches nothing", "[degenerate]") {
  sk::Device device = anyDevice();
  Body ball;
  ball.size = {1, 0, 0};
  Scene s = chain(2);
  s.bodies = {ball};
  const std::vector<double> p = after(device, s, {{notANumber, 0, 0}, {5, 0, 0}});
  CHECK(p[4] == 5);
}

TEST_CASE("links that cannot have their length share what is too much, and stay", "[degenerate]") {
  sk::Device device = anyDevice();
  Scene s = chain(5);
  s.cloth.rest = GENERATE(0.5, 2.0);
  s.links.relaxation = 1.2;
  s.damping = 50;
  s.pins.push_back({{0, 4}, {}, 0, 0});
  Simulation simulation(device, s, Features::of(s), sk::Precision::Single);
  simulation.advance(1000);
  const std::vector<double> p = simulation.positions();
  // Where one end is pinned, the other takes the whole correction and not half of it, so that half the excess is left there.
  const double excess = 0.25 - 0.25 * s.cloth.rest;
  CHECK(p[4] == Approx(0.25 * s.cloth.rest + excess * 2 / 3).epsilon(1e-4));
  CHECK(p[8] == Approx(0.5).epsilon(1e-4));
  CHECK(p[12] == Approx(1 - p[4]).epsilon(1e-4));
  CHECK(simulation.observe().strain == Approx(s.cloth.rest < 1 ? 1.0 : 0.5).epsilon(1e-4));
}
