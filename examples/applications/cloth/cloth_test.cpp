// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <catch2/catch.hpp>
#include <sk/sk.hpp>

#include "body_mesh.hpp"
#include "host_cloth.hpp"
#include "model.hpp"
#include "obj.hpp"
#include "run.hpp"
#include "scene.hpp"
#include "simulation.hpp"
#include "support/testing.hpp"

using namespace examples;

namespace {

Scene parsed(const std::string& text) { return readScene(WrittenFile(text, "written_scene.toml").path()); }

Scene sheet(int columns, int rows) {
  Scene s;
  s.cloth.columns = columns;
  s.cloth.rows = rows;
  s.cloth.shake = 0.01;
  s.links.structural = 1.0;
  s.links.shear = 0.5;
  s.links.bend = 0.25;
  s.run.dt = 0.001;
  return s;
}

}  // namespace

TEST_CASE("a scene has what its file names and nothing else", "[cloth]") {
  const Scene s = parsed(R"(
[cloth]
points = [5, 3]
size = [2, 1]
[springs]
structural = 30
[[pin]]
edge = "top"
every = 2
[[pin]]
point = [4, 2]
[[box]]
centre = [0, 0, 0]
size = [2, 4, 6]
turned = 180
)");
  CHECK(s.points() == 15);
  CHECK(s.links.springs);
  CHECK_FALSE(s.links.shear);
  CHECK_FALSE(s.wind);
  CHECK_FALSE(s.tear);
  CHECK(s.gravity == Vector{});
  CHECK(s.pins[0].points == std::vector<std::int64_t>{0, 2, 4});
  CHECK(s.pins[1].points == std::vector<std::int64_t>{14});
  CHECK(s.bodies[0].size == Vector{1, 2, 3});
  CHECK(s.bodies[0].axis.y == Approx(1.0));
  const Features f = Features::of(s);
  CHECK(f.springs.structural);
  CHECK_FALSE(f.relaxed.any());
  CHECK(f.boxes);
  CHECK_FALSE(f.spheres);
}

TEST_CASE("what is wrong with a scene is told at its place", "[cloth]") {
  using Catch::Contains;
  CHECK_THROWS_WITH(parsed(""), Contains("a scene needs a table [cloth]"));
  CHECK_THROWS_WITH(parsed("[cloth]\npoints = [3]\n"), Contains(":2:"));
  CHECK_THROWS_WITH(parsed("[cloth]\npoints = [2.5, 2]\n"), Contains("whole numbers"));
  CHECK_THROWS_WITH(parsed("[cloth]\npoints = [32768, 32768]\n"), Contains("2^26"));
  CHECK_THROWS_WITH(parsed("[cloth]\nright = [0, 0, 0]\n"), Contains("cannot be zero"));
  CHECK_THROWS_WITH(parsed("[cloth]\nmass = nan\n"), Contains(":2:"));
  CHECK_THROWS_WITH(parsed("[cloth]\n[constraints]\n[springs]\n"), Contains("not both"));
  CHECK_THROWS_WITH(parsed("[cloth]\n[tear]\n"), Contains("at which strain"));
  CHECK_THROWS_WITH(parsed("[cloth]\n[[pin]]\n"), Contains("a pin holds"));
  CHECK_THROWS_WITH(parsed("[cloth]\n[[pin]]\npoint = [65, 0]\n"), Contains("65 columns"));
  CHECK_THROWS_WITH(parsed("[cloth]\n[[pin]]\ncorner = \"top-left\"\ncarry = [1, 0, 0]\n"),
                    Contains("during"));
  CHECK_THROWS_WITH(parsed("[cloth]\n[[sphere]]\nradius = 1\n"), Contains("'centre' is missing"));
  CHECK_THROWS_WITH(parsed("[cloth]\n[[sphere]]\ncentre = [0, 0, 0]\n"), Contains("'radius' is missing"));
  CHECK_THROWS_WITH(parsed("[cloth]\n[[plane]]\nthrough = [0, 0, 0]\n[run]\nverlet = \"positions\"\n"),
                    Contains("displacements"));
  CHECK_THROWS_WITH(parsed("[cloth]\n[run]\nstep = 3\n"), Contains("steps"));
  CHECK_THROWS_WITH(parsed("[cloth\n"), Contains(":1:"));
}

TEST_CASE("stiffness around a point is that of its links", "[cloth]") {
  Scene s = sheet(9, 9);
  CHECK(stiffnessAround(s) == Approx(4 + 2 + 1));
  s.links.shear.reset();
  s.links.bend.reset();
  CHECK(stiffnessAround(s) == Approx(4));
  s.cloth.rows = 1;
  CHECK(stiffnessAround(s) == Approx(2));
  s.cloth.columns = 2;
  CHECK(stiffnessAround(s) == Approx(1));
  s.cloth.columns = 1;
  CHECK(stiffnessAround(s) == Approx(1));
}

TEST_CASE("sheets of every shape follow the loops", "[cloth]") {
  const auto [columns, rows] =
      GENERATE(table<int, int>({{1, 1}, {1, 7}, {7, 1}, {2, 2}, {3, 2}, {13, 11}, {37, 3}}));
  const auto [device, profile] = GENERATE(
      table<const char*, const char*>({{"native", ""}, {"software", "glsl330"}, {"software", "glsl430"}}));
  INFO(columns << " x " << rows << " on " << device << " " << profile);
  sk::Device d({.device = device, .profile = profile});
  Scene s = sheet(columns, rows);
  s.gravity = {0.3, -9.81, 0.1};
  s.wind = WindSettings{};
  s.wind->velocity = {3, 0, 1};
  s.wind->gust = s.wind->swirl = 0.3;
  s.links.law = rows == 2 ? Law::Jakobsen : Law::Exact;
  s.run.verlet = rows == 3 ? Verlet::Positions : Verlet::Displacements;
  s.tear = 0.05;
  Simulation simulation(d, s, Features::of(s), sk::Precision::Single);
  HostCloth<double> host(s, constantsOf(s));
  simulation.advance(20);
  host.advance(20);
  const std::vector<double> p = simulation.positions();
  for (std::size_t i = 0; i < host.positions().size(); ++i) {
    CHECK(p[4 * i] == Approx(host.positions()[i].x).margin(2e-5));
    CHECK(p[4 * i + 1] == Approx(host.positions()[i].y).margin(2e-5));
    CHECK(p[4 * i + 2] == Approx(host.positions()[i].z).margin(2e-5));
  }
}

TEST_CASE("bodies of every kind are touched as in the loops, also when they move", "[cloth]") {
  const auto [device, profile] = GENERATE(
      table<const char*, const char*>({{"native", ""}, {"software", "glsl330"}, {"software", "glsl430"}}));
  INFO(device << " " << profile);
  sk::Device d({.device = device, .profile = profile});
  Scene s = sheet(15, 13);
  s.cloth.origin = {-0.5, 0.31, -0.5};
  s.gravity = {0, -9.81, 0};
  s.thickness = 0.01;
  Body ball;
  ball.at = {-0.25, 0, 0};
  ball.size = {0.3, 0, 0};
  ball.swing = {0, 0.1, 0.2};
  Body floor;
  floor.kind = Kind::Plane;
  floor.along = {0, 1, 0};
  floor.at = {0, 0.1, 0};
  Body capsule;
  capsule.kind = Kind::Capsule;
  capsule.at = {0, 0.2, -0.4};
  capsule.along = {0.4, 0, 0.2};
  capsule.size = {0.1, 0, 0};
  Body box;
  box.kind = Kind::Box;
  box.at = {0.3, 0.2, 0.3};
  box.size = {0.2, 0.1, 0.15};
  box.axis = {0.36, 0.48, 0};
  box.turn = 0.8;
  box.friction = 0.6;
  s.bodies = {box, ball, floor, capsule};
  Simulation simulation(d, s, Features::of(s), sk::Precision::Single);
  HostCloth<double> host(s, constantsOf(s));
  simulation.advance(120);
  host.advance(120);
  const std::vector<double> p = simulation.positions();
  double largest = 0;
  bool fell = false;
  for (std::size_t i = 0; i < host.positions().size(); ++i) {
    const Vector q = host.positions()[i];
    largest = std::max(largest, length(Vector{p[4 * i], p[4 * i + 1], p[4 * i + 2]} - q));
    fell = fell || q.y < 0.25;
    CHECK(q.y > 0.1);
  }
  CHECK(fell);
  CHECK(largest < 1e-4);
}

TEST_CASE("both ends of a link tear together, and only links that are too long", "[cloth]") {
  Scene s = sheet(12, 9);
  s.cloth.shake = 0.05;
  s.tear = 0.3;
  sk::Device device = sk::Device::native();
  Simulation simulation(device, s, Features::of(s), sk::Precision::Single);
  const std::int64_t before = simulation.links();
  simulation.advance(5);
  CHECK(simulation.links() < before);
  CHECK(simulation.links() > before / 4);
  const std::vector<std::int32_t> alive = simulation.state().alive;
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 12; ++x) {
      for (int link = 0; link < 12; ++link) {
        const int nx = x + linkDirections[link].x, ny = y + linkDirections[link].y;
        if (nx < 0 || nx >= 12 || ny < 0 || ny >= 9) continue;
        const auto here = alive[static_cast<std::size_t>(y * 12 + x)],
                   there = alive[static_cast<std::size_t>(ny * 12 + nx)];
        CHECK(((here >> link) & 1) == ((there >> (link ^ 1)) & 1));
      }
    }
  }
}

TEST_CASE("the full model with nothing to do is the scene's model to the bit", "[cloth]") {
  Scene s = sheet(17, 13);
  s.gravity = {0, -9.81, 0};
  s.pins.push_back({{0, 16}, {}, 0, 0});
  sk::Device device = sk::Device::native();
  Simulation required(device, s, Features::of(s), sk::Precision::Single);
  Simulation full(device, s, Features::full(s), sk::Precision::Single);
  CHECK(required.streams() == 2);
  CHECK(full.streams() == 9);
  required.advance(30);
  full.advance(30);
  CHECK(required.positions() == full.positions());
}

TEST_CASE("a state goes on as if it had never been put away", "[cloth]") {
  Scene s = sheet(11, 7);
  s.gravity = {0, -9.81, 0};
  s.tear = 0.02;
  sk::Device device = sk::Device::native();
  Simulation straight(device, s, Features::of(s), sk::Precision::Double);
  Simulation other(device, s, Features::of(s), sk::Precision::Double);
  straight.advance(10);
  const State kept = straight.state();
  straight.advance(15);
  other.restore(kept);
  other.advance(15);
  CHECK(other.step() == 25);
  CHECK(other.positions() == straight.positions());
}

TEST_CASE("what nobody pushes stays where it is as a whole", "[cloth]") {
  sk::Device device = sk::Device::native();
  const Scene s = sheet(15, 15);
  Simulation simulation(device, s, Features::of(s), sk::Precision::Single);
  const Vector before = simulation.observe().centre;
  simulation.advance(5000);
  CHECK(length(simulation.observe().centre - before) < 1e-5);
}

TEST_CASE("pins are carried as far as they should be", "[cloth]") {
  sk::Device device = sk::Device::native();
  Scene s = sheet(5, 5);
  s.pins.push_back({{0}, {0.5, 0.25, 0}, 0.0, 0.1});
  Simulation simulation(device, s, Features::of(s), sk::Precision::Single);
  const std::vector<double> before = simulation.positions();
  simulation.advance(200);
  const std::vector<double> after = simulation.positions();
  CHECK(after[0] - before[0] == Approx(0.5).margin(1e-6));
  CHECK(after[1] - before[1] == Approx(0.25).margin(1e-6));
}

TEST_CASE("a run that breaks names the step and the point", "[cloth]") {
  sk::Device device = sk::Device::native();
  Scene s = sheet(9, 1);
  s.links.relaxation = 16;
  s.run.steps = 100000;
  s.record.frames = 50;
  Simulation simulation(device, s, Features::of(s), sk::Precision::Single);
  int shown = 0;
  CHECK_THROWS_WITH(run(simulation, s,
                        [&](int) {
                          for (const double x : simulation.positions()) REQUIRE(std::isfinite(x));
                          ++shown;
                        }),
                    Catch::Matches("step [0-9]+: the point in column [0-9]+, row 0 has flown off.*"));
  CHECK(shown >= 1);
}

TEST_CASE("a run has as many frames as its scene asks for, the first state and the end among them",
          "[cloth]") {
  sk::Device device = sk::Device::native();
  Scene s = sheet(5, 5);
  s.run.steps = 103;
  for (const int frames : {2, 12, 104}) {
    s.record.frames = frames;
    Simulation simulation(device, s, Features::of(s), sk::Precision::Single);
    std::vector<std::int64_t> steps;
    run(simulation, s, [&](int) { steps.push_back(simulation.step()); });
    CHECK(steps.size() == static_cast<std::size_t>(frames));
    CHECK(steps.front() == 0);
    CHECK(steps.back() == 103);
  }
}

TEST_CASE("a run ends when the cloth has come to rest", "[cloth]") {
  sk::Device device = sk::Device::native();
  Scene s = sheet(5, 5);
  s.cloth.shake = 0;
  s.run.steps = 5000;
  s.run.checkEvery = 10;
  s.run.untilSettled = 1e-3;
  Simulation simulation(device, s, Features::of(s), sk::Precision::Single);
  const Outcome outcome = run(simulation, s, [](int) {});
  CHECK(outcome.settled);
  CHECK(outcome.steps == 10);
}

TEST_CASE("an OBJ file has the same floats and no torn faces", "[cloth]") {
  const std::vector<sk::float4> positions = {
      {0.1f, 1e-30f, 3.4028235e38f, 1}, {1, 0, 0, 1}, {0, 1.0f / 3, 0, 1}, {1, 1, -0.7f, 1}};
  const std::vector<sk::float4> normals = {{0, 0, 1, 1}, {0, 0, 1, 0}, {0, 0, 1, 0}, {0.6f, 0, 0.8f, 0}};
  const auto file = std::filesystem::temp_directory_path() / "sk_cloth_test.obj";
  saveMesh(file, 2, 2, positions, normals);
  std::ifstream in(file);
  std::vector<sk::float3> read;
  int faces = 0, textures = 0, directions = 0;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind, x, y, z;
    words >> kind >> x >> y >> z;
    if (kind == "v") read.push_back({std::stof(x), std::stof(y), std::stof(z)});
    textures += kind == "vt";
    directions += kind == "vn";
    if (kind == "f") {
      ++faces;
      CHECK(line == "f 1/1/1 3/3/3 2/2/2");
    }
  }
  std::filesystem::remove(file);
  CHECK(faces == 1);
  CHECK(textures == 4);
  CHECK(directions == 4);
  REQUIRE(read.size() == 4);
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(read[i] == sk::float3{positions[i].x, positions[i].y, positions[i].z});
}

TEST_CASE("meshes of bodies are closed, and look outwards", "[cloth]") {
  Body capsule;
  capsule.kind = Kind::Capsule;
  capsule.along = GENERATE(Vector{1, 2, 3}, Vector{0, -2, 0}, Vector{0, 0, 0});
  capsule.size = {0.5, 0, 0};
  const Mesh mesh = meshOf(capsule);
  double volume = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const auto at = [&](std::size_t k) { return vecOf<double>(mesh.positions[mesh.triangles[t + k]]); };
    volume += dot(at(0), cross(at(1), at(2))) / 6;
  }
  const double pi = 3.14159265358979;
  CHECK(volume == Approx(pi * 0.25 * length(capsule.along) + 4.0 / 3 * pi * 0.125).epsilon(0.01));
}
