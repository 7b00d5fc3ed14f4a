// SPDX-License-Identifier: MIT
//
// Promises: every scene of the example lattice makes the same numbers and pictures on any number of ranks as on one device, to the
// bit: fields, rows of numbers, the step at which it settles.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "lattice.hpp"
#include "ranks.hpp"
#include "reference.hpp"
#include "run.hpp"
#include "scene.hpp"
#include "support/ranks.hpp"

namespace {

namespace fs = std::filesystem;
using examples::Field;
using examples::Lattice;

std::vector<fs::path> scenes() {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(SK_LATTICE_SCENES)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// The extents of a scene's lattice, as small as six ranks allow, and of which no number of ranks divides all.
std::vector<std::int64_t> smallSize(const fs::path& file) {
  const bool isSpace = examples::readScene(file, {}).model.grid.isSpace();
  return isSpace ? std::vector<std::int64_t>{9, 7, 5} : std::vector<std::int64_t>{23, 17};
}

examples::Scene small(const fs::path& file) {
  examples::Overrides overrides;
  overrides.size = smallSize(file);
  overrides.steps = 9;
  examples::Scene scene = examples::readScene(file, overrides);
  scene.initial.seeds = 2;
  scene.initial.seedSide = 5;
  scene.view.zoom = 1;
  scene.csvInterval = 4;
  if (scene.settling) scene.settling = {.tolerance = 1e6, .every = 5};  // at once
  return scene;
}

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What a run of a scene leaves, in files of these names.
struct Result {
  examples::Outcome outcome;
  double nusselt = 0.0, energy = 0.0;
  std::string picture, numbers;
};

Result run(examples::Scene scene, const std::string& name, const examples::Space& space) {
  // A picture of a lattice in space takes longer than all else.
  scene.record.output = scene.model.grid.isSpace() ? "" : fmt::format("mpi_lattice_{}.png", name);
  scene.record.csv = fmt::format("mpi_lattice_{}.csv", name);
  Lattice lattice(space, scene.model);
  examples::writeInitial(scene.model, scene.initial, lattice);
  Result result;
  result.outcome = examples::runScene(scene, lattice);
  if (scene.model.flow) {
    result.nusselt = lattice.nusselt();
    result.energy = lattice.kineticEnergy();
  }
  if (!space.isFirst()) return result;
  result.picture = contentOf(scene.record.output);
  result.numbers = contentOf(scene.record.csv);
  fs::remove(scene.record.csv);
  if (!scene.record.output.empty()) fs::remove(scene.record.output);
  return result;
}

/// The rank that has all results compares them with those of one device.
void compare(const examples::Scene& scene) {
  INFO(scene.name);
  const std::string name = fmt::format("{}_of_{}", scene.name, ranksOfWorld());
  const auto grid = examples::divideGrid("", examples::shapeOf(scene.model.grid), examples::Ends::Joined);
  const Result ranks = run(scene, name, examples::Space(*grid));
  if (rankOfWorld() != 0) {
    CHECK(ranks.outcome.last.at(examples::fieldsOf(scene.model).front()).empty());
    return;
  }
  sk::Device device;
  const Result plain =
      run(scene, name + "_plain", examples::Space(device, examples::shapeOf(scene.model.grid)));
  CHECK(ranks.outcome.steps == plain.outcome.steps);
  CHECK(ranks.outcome.settled == plain.outcome.settled);
  CHECK(ranks.outcome.change == plain.outcome.change);
  CHECK(ranks.outcome.beforeLast == plain.outcome.beforeLast);
  CHECK(ranks.outcome.last == plain.outcome.last);
  CHECK(ranks.outcome.last != ranks.outcome.beforeLast);
  CHECK(ranks.picture == plain.picture);
  CHECK(ranks.picture.empty() == scene.model.grid.isSpace());
  if (scene.model.precision == sk::Precision::Double) return;  // sums in doubles are not exact
  CHECK(ranks.nusselt == plain.nusselt);
  CHECK(ranks.energy == plain.energy);
  CHECK(ranks.numbers == plain.numbers);
  CHECK(std::ranges::count(ranks.numbers, '\n') >= 3);
}

TEST_CASE("scenes have the bits of one device") {
  const std::vector<fs::path> files = scenes();
  REQUIRE(files.size() >= 8);
  for (const fs::path& file : files) compare(small(file));
}

TEST_CASE("scenes in other precisions have the bits of one device") {
  for (const sk::Precision precision : {sk::Precision::Half, sk::Precision::Double}) {
    examples::Scene scene = small(fs::path(SK_LATTICE_SCENES) / "convection.toml");
    scene.model.precision = precision;
    scene.view.shown = examples::Shown::Speed;
    scene.view.low.reset();
    scene.view.high.reset();
    compare(scene);
  }
}

TEST_CASE("what is not finite is found on every rank, and its cell on the first") {
  examples::Scene scene = small(fs::path(SK_LATTICE_SCENES) / "spots.toml");
  const auto grid = examples::divideGrid("", examples::shapeOf(scene.model.grid), examples::Ends::Joined);
  Lattice lattice(examples::Space(*grid), scene.model);
  std::vector<double> values;
  if (rankOfWorld() == 0) {
    values.resize(23 * 17, 0.5);
    values[200] = values[390] = HUGE_VAL;
  }
  lattice.write(Field::V, values);
  CHECK(lattice.observe(Field::V).broken == 2);
  CHECK(lattice.firstBroken(Field::V) == (rankOfWorld() == 0 ? 200 : -1));
  CHECK_THROWS_WITH(examples::requireFinite(lattice, 3), Catch::Contains("step 3: v is not finite"));
}

}  // namespace
