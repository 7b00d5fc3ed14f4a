// SPDX-License-Identifier: MIT
#include "flow.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include <sk/npy.hpp>

#include "scene.hpp"
#include "support/testing.hpp"
#include "vortices.hpp"

namespace fluid {
namespace {

/// Everything at once, in a channel with a ball in it.
Model everything(bool isSpace) {
  Model m;
  m.cells = {isSpace ? 11 : 13, 10, isSpace ? 6 : 1};
  m.spacing = 0.1;
  m.sides = {Side::Inflow, Side::Outflow, Side::Wall, Side::Slip, Side::Periodic, Side::Periodic};
  m.sideVelocity[0] = {1.0, 0.0, 0.0};
  m.sideVelocity[2] = {0.3, 0.0, 0.0};
  m.obstacles.push_back({Sphere{{0.6, 0.5, 0.4}, 0.2}, {}});
  m.sources.push_back({Shape{Sphere{{0.25, 0.3, 0.4}, 0.15}, {}}, 1.0, 2.0});
  m.viscosity = Viscosity{0.01};
  m.buoyancy = Buoyancy{1.0, 0.0, 0.5};
  m.hasSmoke = m.hasHeat = true;
  m.timeStep = 0.06;
  m.tolerance = 2e-6;
  return m;
}

struct Fields {
  std::vector<double> velocity, smoke, heat;
};

Fields stepped(sk::Device& device, const Model& model, int steps) {
  Flow flow(device, model, {1.0, 0.0, 0.0});
  for (int i = 0; i < steps; ++i) flow.step();
  Fields f;
  for (int axis = 0; axis < model.rank(); ++axis)
    std::ranges::copy(flow.velocity(axis), std::back_inserter(f.velocity));
  if (model.hasSmoke) f.smoke = flow.values(Scalar::Smoke);
  if (model.hasHeat) f.heat = flow.values(Scalar::Heat);
  return f;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// Two steps, each of whose projections stops at the tolerance: its error is at most tolerance * n / pi root mean square (run.cpp), and no element's is more
/// than the root of the number of cells times that.
double bound(const Model& m) {
  const auto cells = static_cast<double>(m.shape().size());
  return 2.0 * m.tolerance * 13.0 / 3.14 * std::sqrt(cells);
}

TEST_CASE("all parts at once do the same natively and in double precision") {
  for (const bool isSpace : {false, true}) {
    Model model = everything(isSpace);
    sk::Device reference = sk::Device::reference(), native = sk::Device::native();
    const Fields expected = stepped(reference, model, 2);
    const auto compare = [&](sk::Device& device) {
      const Fields found = stepped(device, model, 2);
      CHECK(distance(found.velocity, expected.velocity) <= bound(model));
      CHECK(distance(found.smoke, expected.smoke) <= bound(model));
      CHECK(distance(found.heat, expected.heat) <= 2.0 * bound(model));
    };
    compare(native);
  }
}

TEST_CASE("a flow does the same drawn, dispatched and in double precision") {
  // Each program takes llvmpipe a tenth of a second to compile: a flow is drawn in a plane, and dispatched in space with fewer parts. The example on a
  // device with GL has viscosity and central differences.
  for (const bool isSpace : {false, true}) {
    Model model = everything(isSpace);
    model.viscosity.reset();
    model.buoyancy.reset();
    model.hasHeat = false;
    if (isSpace) {
      model.scheme = Scheme::SemiLagrangian;
      model.sources.clear();
      model.hasSmoke = false;
    }
    sk::Device reference = sk::Device::reference();
    const Fields expected = stepped(reference, model, 2);
    sk::Device gl = examples::deviceNamed(isSpace ? "glsl430" : "glsl330");
    const Fields found = stepped(gl, model, 2);
    CHECK(distance(found.velocity, expected.velocity) <= bound(model));
    CHECK(distance(found.smoke, expected.smoke) <= bound(model));
  }
}

TEST_CASE("a projection by multigrid is that by Chebyshev's iteration, in fewer iterations") {
  sk::Device device = sk::Device::native();
  constexpr std::array<std::array<Side, 4>, 4> planes = {
      {{Side::Inflow, Side::Outflow, Side::Wall, Side::Slip},
       {Side::Wall, Side::Wall, Side::Wall, Side::Wall},
       {Side::Periodic, Side::Periodic, Side::Wall, Side::Wall},
       {Side::Periodic, Side::Periodic, Side::Periodic, Side::Periodic}}};
  for (const bool isSpace : {false, true})
    for (const auto& sides : planes) {
      Model m;
      m.cells = {isSpace ? 13 : 45, isSpace ? 12 : 40, isSpace ? 10 : 1};
      m.spacing = 1.0 / static_cast<double>(m.cells[0]);
      std::ranges::copy(sides, m.sides.begin());
      m.sides[4] = m.sides[5] = isSpace ? Side::Wall : Side::Periodic;
      if (sides[0] == Side::Inflow) m.sideVelocity[0] = {1.0, 0.0, 0.0};
      m.obstacles.push_back({Sphere{{0.4, 0.5, 0.4}, 0.17}, {}});
      m.obstacles.push_back({{}, Brick{{0.7, 0.1, 0.0}, {0.74, 0.6, 1.0}}});  // a thin wall
      m.precision = sk::Precision::Double;
      m.tolerance = 1e-10;
      CAPTURE(isSpace, static_cast<int>(sides[0]), static_cast<int>(sides[2]));
      std::vector<std::vector<double>> found;
      std::vector<std::int64_t> iterations;
      for (const Projector projector : {Projector::Chebyshev, Projector::Multigrid}) {
        m.projector = projector;
        Flow flow(device, m, {1.0, 0.3, 0.2});
        const Projection p = flow.project();
        CHECK(p.reached);
        iterations.push_back(p.iterations);
        found.emplace_back();
        for (int axis = 0; axis < m.rank(); ++axis)
          std::ranges::copy(flow.velocity(axis), std::back_inserter(found.back()));
      }
      CHECK(iterations[1] <= 30);
      if (!isSpace) CHECK(2 * iterations[1] <= iterations[0]);
      // Each error is at most tolerance * n / pi root mean square, and no element's is more than the root of the number of cells times that.
      CHECK(distance(found[0], found[1]) <=
            2.0 * m.tolerance * 45.0 / 3.14 * std::sqrt(static_cast<double>(m.shape().size())));
    }
}

TEST_CASE("the energy is that of the fluid, also beside walls that move") {
  sk::Device device = sk::Device::native();
  for (const bool hasCells : {false, true}) {
    for (const std::int64_t n : {16, 64}) {
      Model m;  // Couette's flow between a wall at rest and one that moves with 1
      m.cells = {4, n, 1};
      m.spacing = 1.0 / static_cast<double>(n);
      m.sides = {Side::Periodic, Side::Periodic, Side::Wall, Side::Wall, Side::Periodic, Side::Periodic};
      m.sideVelocity[3] = {1.0, 0.0, 0.0};
      if (hasCells) m.obstacles.push_back({Sphere{{-5.0, 0.0, 0.0}, 0.1}, {}});
      Flow flow(device, m);
      std::vector<double> u = flow.velocity(0);
      const auto row = u.size() / static_cast<std::size_t>(n + 2);
      for (std::size_t i = row; i < u.size() - row; ++i)
        u[i] = (static_cast<double>(i / row) - 0.5) * m.spacing;
      flow.writeVelocity(0, u);
      // The midpoint rule for the integral of u^2 / 2 from 0 to 1, which is 1/6, times the width.
      const double width = 4.0 * m.spacing;
      CHECK(std::abs(flow.kineticEnergy() / width - 1.0 / 6.0) <= 1.01 * m.spacing * m.spacing / 24.0 + 1e-6);
    }
  }
  Model inflow = everything(false);
  inflow.obstacles.clear();
  Flow flow(device, inflow, {1.0, 0.0, 0.0});
  const double area = 13.0 * 10.0 * 0.01;
  CHECK(flow.kineticEnergy() == Approx(0.5 * area).epsilon(1e-6));
}

TEST_CASE("sides that follow from an index are those that a stream of cells has") {
  sk::Device device = sk::Device::native();
  for (const bool isSpace : {false, true}) {
    Model around = everything(isSpace);
    around.obstacles.clear();
    Model anywhere = around;
    anywhere.obstacles.push_back({Sphere{{-5.0, 0.0, 0.0}, 0.1}, {}});
    REQUIRE(around.bounds() == Around);
    REQUIRE(anywhere.bounds() == Anywhere);
    for (const Scheme scheme : {Scheme::SemiLagrangian, Scheme::Bfecc, Scheme::Central}) {
      around.scheme = anywhere.scheme = scheme;
      const Fields a = stepped(device, around, 2), b = stepped(device, anywhere, 2);
      CHECK(a.velocity == b.velocity);
      CHECK(a.smoke == b.smoke);
    }
  }
}

TEST_CASE("the matrix of pressures is that of the host, symmetric and not negative") {
  sk::Device device = sk::Device::native();
  for (const bool isSpace : {false, true}) {
    const Model model = everything(isSpace);
    const std::vector<std::int8_t> cells = cellsOf(model);
    const linear::Operator o = pressureOperator(model, cells);
    const GridArguments grid(linear::Space(device, model.shape()), model);
    const auto matrix = makePressureMatrix(grid, {});
    std::mt19937 random(3);
    const auto vector = [&] {
      std::vector<double> v;
      for (const std::int8_t cell : cells) v.push_back(cell == Fluid ? random() % 9 - 4.0 : 0.0);
      return v;
    };
    const std::vector<double> x = vector(), z = vector();
    linear::Vector sx = device.stream<float>(model.shape()), sy = device.stream<float>(model.shape());
    linear::Vector xy = device.stream<float>({1});
    sx.writeReals(x);
    matrix->multiply(sx, sy, xy);
    const std::vector<double> y = o.multiply(x), az = o.multiply(z);
    CHECK(sy.readReals() == y);  // small integers are exact
    double xAx = 0.0, zAx = 0.0, xAz = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      xAx += x[i] * y[i];
      zAx += z[i] * y[i];
      xAz += x[i] * az[i];
    }
    CHECK(xy.readReals()[0] == xAx);
    CHECK(xAx > 0.0);
    CHECK(zAx == xAz);
  }
}

TEST_CASE("a projection takes the divergence away, and tells both residuals") {
  sk::Device device = sk::Device::native();
  const Model model = everything(true);
  Flow flow(device, model, {1.0, 0.4, 0.2});
  const double before = flow.divergence();
  const Projection p = flow.project();
  CHECK(p.reached);
  CHECK(p.before == Approx(before).epsilon(1e-5));
  CHECK(p.after == Approx(flow.divergence()).margin(1e-5));
  CHECK(p.after < 1e-4 * before);
  CHECK(p.residual <= model.tolerance);
  CHECK(p.recurred == Approx(p.residual).epsilon(0.5));
  // Nothing is left to do.
  CHECK(flow.project().iterations == 0);
}

TEST_CASE("a flow that does not change along z is that of a plane") {
  sk::Device device = sk::Device::native();
  const Vortices vortices;
  for (const Scheme scheme : {Scheme::MacCormack, Scheme::Central}) {
    const auto error = [&](std::int64_t depth) {
      Model model = vortexModel(vortices, 12, scheme, sk::Precision::Double, depth);
      model.timeStep = 0.1;
      Flow flow = vortexFlow(device, vortices, model);
      for (int i = 0; i < 3; ++i) flow.step();
      return errorOf(vortices, flow);
    };
    CHECK(error(4) == Approx(error(1)).epsilon(1e-6));
  }
}

TEST_CASE("implicit viscosity is explicit viscosity in short steps") {
  sk::Device device = sk::Device::native();
  Model model = everything(false);
  model.sources.clear();
  model.buoyancy.reset();
  model.hasSmoke = model.hasHeat = false;
  model.precision = sk::Precision::Double;
  model.tolerance = 1e-9;
  const auto difference = [&](double dt) {
    model.timeStep = dt;
    model.viscosity = Viscosity{0.05, false};
    const Fields explicitly = stepped(device, model, 1);
    model.viscosity->isImplicit = true;
    return distance(stepped(device, model, 1).velocity, explicitly.velocity);
  };
  // Both are of first order: what they differ by in one step goes with the square of its length.
  const double longer = difference(2e-3), shorter = difference(1e-3);
  CHECK(longer > 0.0);
  CHECK(std::log2(longer / shorter) == Approx(2.0).margin(0.1));
}

TEST_CASE("what a scene does without has no streams") {
  sk::Device device = sk::Device::native();
  Model model = vortexModel(Vortices{.viscosity = 0.0}, 8, Scheme::SemiLagrangian, sk::Precision::Single);
  CHECK(Flow(device, model).streams() == 6);  // two components twice, the divergence, the pressure
  CHECK_THROWS_WITH(Flow(device, model).stream(Scalar::Smoke), "the scene has no smoke");
  CHECK(operatorsOf(model) == "projection, convection by semi-Lagrangian");
  model.scheme = Scheme::MacCormack;
  CHECK(Flow(device, model).streams() == 8);
  // What is expected before a flow is made, for the memory that it takes.
  for (const bool isSpace : {false, true})
    for (const Scheme scheme : {Scheme::SemiLagrangian, Scheme::Bfecc, Scheme::Central}) {
      Model all = everything(isSpace);
      all.scheme = scheme;
      all.viscosity->isImplicit = scheme == Scheme::Bfecc;
      for (const Model& m : {model, all}) CHECK(Flow::streamsOf(m) == Flow(device, m).streams());
    }
}

TEST_CASE("walls without friction do not brake a stream along them") {
  sk::Device device = sk::Device::native();
  for (const Scheme scheme : {Scheme::SemiLagrangian, Scheme::MacCormack, Scheme::Central}) {
    Model model;
    model.cells = {8, 6, 1};
    model.spacing = 0.1;
    model.scheme = scheme;
    model.sides = {Side::Inflow, Side::Outflow, Side::Slip, Side::Slip, Side::Periodic, Side::Periodic};
    model.sideVelocity[0] = {1.0, 0.0, 0.0};
    model.viscosity = Viscosity{0.01};
    model.timeStep = 0.05;
    Flow flow(device, model, {1.0, 0.0, 0.0});
    flow.project();
    for (int i = 0; i < 5; ++i) flow.step();
    const std::vector<double> u = flow.velocity(0);
    // The layer behind the walls has the stream's velocity, too: paths that end near a wall read it.
    for (std::int64_t y = 0; y <= 7; ++y)
      for (std::int64_t x = 1; x <= 9; ++x)
        CHECK(u[static_cast<std::size_t>(model.index({x, y, 0}))] == Approx(1.0).margin(1e-5));
  }
}

TEST_CASE("a number that is not finite is named with its step and cell") {
  sk::Device device = sk::Device::native();
  const Model model = everything(false);
  Flow flow(device, model);
  flow.step();
  std::vector<double> v = flow.velocity(1);
  v[static_cast<std::size_t>(model.index({7, 8, 0}))] = std::numeric_limits<double>::quiet_NaN();
  flow.writeVelocity(1, v);
  CHECK_THROWS_WITH(flow.step(), Catch::Contains("step 1: v is not finite in cell (7, 8)"));
}

void read(const std::string& text) { readScene(examples::WrittenFile(text, "written_flow.toml").path(), {}); }

TEST_CASE("obstacles come from masks, and smoke from files") {
  std::vector<double> values(16 * 16, 0.0);
  values[3 * 16 + 5] = 1.0;
  sk::writeNpy("written_mask.npy", std::vector<std::int64_t>{16, 16}, values);
  const examples::WrittenFile file(
      "[grid]\nsize = [16, 16]\n[[obstacle]]\nmask = \"written_mask.npy\"\n"
      "[initial]\nsmoke_file = \"written_mask.npy\"\n",
      "written_flow.toml");
  const Scene scene = readScene(file.path(), {});
  const std::vector<std::int8_t> cells = cellsOf(scene.model);
  CHECK(cells[static_cast<std::size_t>(scene.model.index({6, 4, 0}))] == Solid);
  CHECK(fluidCells(cells) == 16 * 16 - 1);
  CHECK(scene.model.hasSmoke);
  CHECK(scene.initial.smoke[3 * 16 + 5] == 1.0);
  std::filesystem::remove("written_mask.npy");
}

TEST_CASE("the command line has precedence over a scene, also over what it leaves out") {
  for (const std::string run : {"", "[run]\nsteps = 3\nprecision = \"single\"\n"}) {
    const examples::WrittenFile file("[grid]\nsize = [16, 16]\n" + run, "written_flow.toml");
    Overrides overrides;
    overrides.steps = 7;
    overrides.precision = sk::Precision::Double;
    const Scene scene = readScene(file.path(), overrides);
    CHECK(scene.steps == 7);
    CHECK(scene.model.precision == sk::Precision::Double);
  }
}

TEST_CASE("what is wrong with a scene is said with its place and a way out") {
  const std::string grid = "[grid]\nsize = [16, 16]\n";
  CHECK_NOTHROW(read(grid));
  const std::pair<std::string, const char*> cases[] = {
      {"", "'grid' is missing"},
      {"[grid]\nsise = [16, 16]\n", "size"},
      {grid + "spacng = 1.0\n", ":3:1:"},
      {grid + "spacng = 1.0\n", "did you mean 'spacing'?"},
      {"[grid]\nsize = [0, 16]\n", "whole numbers from 2 to 16384"},
      {"[grid]\nsize = [16384, 16384]\n", "more than 2^26 cells"},
      {"[grid]\nsize = [16, nan]\n", "nan"},
      {grid + "[viscosity]\nvalue = -0.1\n", "value"},
      {grid + "[viscosity]\nvalue = 1.0\n[run]\ntime_step = 0.1\n", "is not stable"},
      {grid + "[[obstacle]]\ncentre = [0.5, 0.5]\nradius = 9.0\n", "leave no fluid"},
      {grid + "[boundary]\nleft = \"inflow\"\nleft_velocity = [1.0, 0.0]\n",
       "incompatible: more flows in through 'left'"},
      {grid + "[boundary]\nleft = \"inflow\"\nleft_velocity = [1.0, 0.0]\n", "\"outflow\""},
      {grid + "[boundary]\nleft = \"inflow\"\nleft_velocity = [-1.0, 0.0]\n", "does not point into the grid"},
      {grid + "[boundary]\ntop_velocity = [1.0, 0.5]\n", "goes through a wall"},
      {grid + "[boundary]\nleft = \"periodic\"\n", "'right' is not periodic, but left is"},
      {grid + "[view]\nfield = \"smoke\"\n", "no source has any"},
      {grid + "[boundary]\nleft = \"inflow\"\nleft_velocity = [1.0, 0.0]\nright = \"outflow\"\n"
              "[[obstacle]]\nlow = [0.4, -1.0]\nhigh = [0.6, 2.0]\n",
       "incompatible"}};
  for (const auto& [text, message] : cases) CHECK_THROWS_WITH(read(text), Catch::Contains(message));
}

}  // namespace
}  // namespace fluid
