// SPDX-License-Identifier: MIT
#include "lattice.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <tuple>

#include "reference.hpp"

namespace examples {
namespace {

/// Fields at random, such that no operator finds them at rest. The temperature lies about the boiling point of 0.
State disturbed(const Model& model) {
  std::mt19937 random(7);
  State state;
  for (const Field field : fieldsOf(model)) {
    std::vector<double> values;
    for (std::int64_t i = 0; i < model.grid.cells(); ++i)
      values.push_back(static_cast<float>(random() / 2147483648.0 - 1.0));
    state[field] = values;
  }
  // What lies on a closed side is a wall's velocity, which is none.
  for (std::int64_t y = 0; y < model.grid.height; ++y) {
    for (std::int64_t x = 0; x < model.grid.width; ++x) {
      const auto i = static_cast<std::size_t>(y * model.grid.width + x);
      if (model.flow && model.boundary.closedX() && x == 0) state[Field::VelocityX][i] = 0.0;
      if (model.flow && model.boundary.closedY() && y == 0) state[Field::VelocityY][i] = 0.0;
    }
  }
  return state;
}

Model everything(Grid grid, Boundary boundary) {
  Model m;
  m.grid = grid;
  m.boundary = boundary;
  m.timeStep = 0.01;
  m.diffusion = Diffusion{0.7};
  m.buoyancy = Buoyancy{0.1, 3.0};
  m.latentHeat = LatentHeat{0.05};
  if (grid.isSpace()) return m;
  m.reaction = Reaction{0.03, 0.06};
  m.reaction->stirring = 2.0;
  m.flow = Flow{.viscosity = 0.3, .lift = 1.5, .sound = 2.0, .damping = 0.1};
  return m;
}

Boundary boundary(Edge left, Edge right, Edge bottom, Edge top) {
  return {{left, right, bottom, top}, {0.25, -0.5, 0.75, -1.0}, left != Edge::Wrap};
}

void stepAndCompare(sk::Device& device, const Model& model) {
  Lattice lattice(device, model);
  const State before = disturbed(model);
  for (const auto& [field, values] : before) lattice.write(field, values);
  lattice.advance(1);
  const Verification in = checkStep(model, before, readState(lattice), 0.0);
  INFO(in.text());
  CHECK(in.passed());
}

TEST_CASE("all operators at once, at every kind of edge, do what plain loops do") {
  using enum Edge;
  for (const char* name : {"native", "software"}) {
    sk::Device device(name);
    INFO(name);
    for (const Boundary& edges :
         {boundary(Wrap, Wrap, Wrap, Wrap), boundary(Insulated, Wall, Wall, Insulated),
          boundary(Wrap, Wrap, Wall, Wall), boundary(Wall, Wall, Insulated, Insulated)}) {
      stepAndCompare(device, everything({13, 7}, edges));
      stepAndCompare(device, everything({16, 12}, edges));
    }
    stepAndCompare(device, everything({1, 9}, boundary(Wrap, Wrap, Wall, Wall)));
    stepAndCompare(device, everything({7, 6, 5}, boundary(Insulated, Insulated, Wall, Insulated)));
    stepAndCompare(device, everything({7, 6, 5}, boundary(Wrap, Wrap, Wrap, Wrap)));
  }
}

TEST_CASE("each operator alone needs no streams but its own") {
  sk::Device device = sk::Device::native();
  const Model all = everything({12, 10}, boundary(Edge::Wrap, Edge::Wrap, Edge::Wall, Edge::Wall));
  Model m = all;
  m.flow.reset();
  m.reaction.reset();
  m.latentHeat.reset();
  stepAndCompare(device, m);
  CHECK(Lattice(device, m).streams() == 1);
  CHECK(Lattice::streamsOf(m) == 1);
  m.diffusion.reset();
  stepAndCompare(device, m);
  m.buoyancy.reset();
  m.latentHeat = all.latentHeat;
  stepAndCompare(device, m);
  CHECK(Lattice(device, m).streams() == 2);
  CHECK(Lattice::streamsOf(m) == 2);
  m = all;
  m.diffusion.reset();
  m.buoyancy.reset();
  m.latentHeat.reset();
  m.flow.reset();
  stepAndCompare(device, m);
  CHECK(Lattice(device, m).streams() == 2);
  CHECK(Lattice::streamsOf(m) == 2);
  CHECK_THROWS_WITH(Lattice(device, m).stream(Field::Pressure), Catch::Contains("no field 'pressure'"));
}

TEST_CASE("a measured step is a step, and tells the largest change") {
  sk::Device device = sk::Device::native();
  const Model model = everything({12, 10}, boundary(Edge::Wrap, Edge::Wrap, Edge::Wall, Edge::Wall));
  Lattice plain(device, model), measured(device, model);
  const State before = disturbed(model);
  for (const auto& [field, values] : before) {
    plain.write(field, values);
    measured.write(field, values);
  }
  plain.advance(3);
  measured.advance(1);
  measured.advanceAndMeasure();
  const State middle = readState(measured);
  const double change = measured.advanceAndMeasure();
  const State a = readState(plain), b = readState(measured);
  CHECK(a == b);
  double largest = 0.0;
  for (const auto& [field, values] : b) {
    if (field == Field::Pressure) continue;
    for (std::size_t i = 0; i < values.size(); ++i)
      largest = std::max(largest, std::abs(values[i] - middle.at(field)[i]));
  }
  CHECK(change == Approx(largest));
}

TEST_CASE("what is not finite is found where it is first") {
  sk::Device device = sk::Device::native();
  Model m;
  m.grid = {5, 4};
  m.diffusion = Diffusion{0.1};
  Lattice lattice(device, m);
  std::vector<double> values(20, 1.0);
  values[7] = 3.0;
  lattice.write(Field::Temperature, values);
  const Observation whole = lattice.observe(Field::Temperature);
  CHECK(whole.broken == 0);
  CHECK(lattice.firstBroken(Field::Temperature) == -1);
  CHECK(whole.least == 1.0);
  CHECK(whole.most == 3.0);
  CHECK(whole.mean == Approx(1.1));
  values[11] = std::nan("");
  values[17] = HUGE_VAL;
  lattice.write(Field::Temperature, values);
  CHECK(lattice.observe(Field::Temperature).broken == 2);
  CHECK(lattice.firstBroken(Field::Temperature) == 11);
}

TEST_CASE("a scene makes the passes of its operators, and a full model all of them") {
  for (const char* name : {"native", "software"}) {
    sk::Device device(name);
    Model m;
    m.grid = {16, 16};
    m.reaction = Reaction{0.03, 0.06};
    for (const auto& [model, streams, passes] : {std::tuple{m, 2, 1}, std::tuple{fullModel(m), 7, 5}}) {
      Lattice lattice(device, model);
      lattice.advance(1);
      device.countPasses(true);
      lattice.advance(1);
      CHECK(device.passCount().passes == passes);
      device.countPasses(false);
      CHECK(lattice.streams() == streams);
    }
  }
}

TEST_CASE("neutral operators are those of the full model") {
  Model m;
  m.diffusion = Diffusion{0.1};
  CHECK(operatorsOf(m) == std::vector<std::string>{"diffusion"});
  CHECK(operatorsOf(fullModel(m)).size() == 5);
  m.grid.depth = 8;
  CHECK(operatorsOf(fullModel(m)).size() == 3);
}

TEST_CASE("conduction has a Nusselt number of 1") {
  sk::Device device = sk::Device::native();
  Model m;
  m.grid = {8, 16};
  m.boundary = boundary(Edge::Wrap, Edge::Wrap, Edge::Wall, Edge::Wall);
  m.diffusion = Diffusion{0.2};
  Lattice lattice(device, m);
  std::vector<double> values;
  for (int i = 0; i < 8 * 16; ++i) values.push_back(0.75 - 1.75 * (i / 8 + 0.5) / 16);
  lattice.write(Field::Temperature, values);
  CHECK(lattice.nusselt() == Approx(1.0).epsilon(1e-5));
}

}  // namespace
}  // namespace examples
