// SPDX-License-Identifier: MIT
//
// Promises: every scene of the example cloth moves on any number of ranks as on one device, to the bit: points, displacements, the
// links that hold, what a census finds. A cloth whose parts are thinner than its links are long is refused.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

#include <catch2/catch.hpp>

#include "ranks.hpp"
#include "run.hpp"
#include "scene.hpp"
#include "simulation.hpp"
#include "support/ranks.hpp"

namespace {

namespace fs = std::filesystem;
using examples::Scene;
using examples::Simulation;
using examples::State;

examples::Features featuresOf(const Scene& scene) { return examples::Features::of(scene); }

/// A scene of the example with few points: no number of ranks divides both of their numbers.
Scene smallScene(const std::string& name) {
  const fs::path file = fs::path(SK_CLOTH_SCENES) / (name + ".toml");
  if (name == "chain") return examples::readScene(file);  // a single row
  return examples::readScene(file, examples::Points{13, 17});
}

/// Both cloths for some steps, compared on the rank that has all points.
void compare(const Scene& scene, std::int64_t steps, sk::Precision precision) {
  INFO(scene.title);
  const auto grid = examples::divideGrid("", examples::shapeOf(scene), examples::Ends::Open);
  Simulation divided(examples::Space(*grid), scene, featuresOf(scene), precision);
  const std::int64_t linksBefore = divided.links();
  divided.advance(steps);
  const State ranks = divided.state();
  const examples::Census census = divided.census();
  const std::int64_t links = divided.links();
  if (featuresOf(scene).tearing) CHECK(links < linksBefore);
  if (rankOfWorld() != 0) {
    CHECK(ranks.positions.empty());
    return;
  }
  sk::Device device;
  Simulation plain(device, scene, featuresOf(scene), precision);
  const State before = plain.state();
  plain.advance(steps);
  const State expected = plain.state();
  CHECK(ranks.positions == expected.positions);
  CHECK(ranks.displacements == expected.displacements);
  CHECK(ranks.alive == expected.alive);
  CHECK(ranks.positions != before.positions);
  CHECK(census.broken == plain.census().broken);
  CHECK(census.fastest == plain.census().fastest);
  CHECK(links == plain.links());
}

TEST_CASE("scenes move as on one device") {
  for (const char* name : {"chain", "drape", "flag", "table"})
    compare(smallScene(name), 25, sk::Precision::Single);
}

TEST_CASE("a sheet tears as on one device") {
  Scene scene = smallScene("torn");
  scene.tear = 0.002;  // at once
  compare(scene, 25, sk::Precision::Single);
}

TEST_CASE("a cloth in doubles moves as on one device") {
  compare(smallScene("drape"), 5, sk::Precision::Double);
}

TEST_CASE("a state goes on, whoever has it") {
  const Scene scene = smallScene("torn");
  const auto grid = examples::divideGrid("", examples::shapeOf(scene), examples::Ends::Open);
  Simulation first(examples::Space(*grid), scene, featuresOf(scene), sk::Precision::Single);
  first.advance(4);
  const State middle = first.state();
  first.advance(4);
  Simulation second(examples::Space(*grid), scene, featuresOf(scene), sk::Precision::Single);
  second.restore(middle);
  second.advance(4);
  CHECK(second.step() == 8);
  CHECK(second.state().positions == first.state().positions);
  CHECK(second.state().alive == first.state().alive);
}

TEST_CASE("a point that flies off ends the run on every rank") {
  Scene scene = smallScene("drape");
  scene.run.steps = 6;
  const auto grid = examples::divideGrid("", examples::shapeOf(scene), examples::Ends::Open);
  Simulation cloth(examples::Space(*grid), scene, featuresOf(scene), sk::Precision::Single);
  State state = cloth.state();
  if (rankOfWorld() == 0) state.positions[4 * 40] = 1e19;
  cloth.restore(state);
  const char* const where =
      rankOfWorld() == 0 ? "step 0: the point in column 1, row 3 has flown off" : "step 0: ";
  CHECK_THROWS_WITH(examples::run(cloth, scene, [](int) {}), Catch::Contains(where));
}

TEST_CASE("parts that are thinner than links are long are refused") {
  if (ranksOfWorld() < 6) return;
  const Scene scene = examples::readScene(fs::path(SK_CLOTH_SCENES) / "drape.toml", examples::Points{3, 3});
  REQUIRE(scene.links.bend);
  const auto grid = examples::divideGrid("", examples::shapeOf(scene), examples::Ends::Open);
  Simulation cloth(examples::Space(*grid), scene, featuresOf(scene), sk::Precision::Single);
  CHECK_THROWS_WITH(cloth.advance(1), Catch::Contains("'net.p' needs a halo of 2 element(s)"));
}

}  // namespace
