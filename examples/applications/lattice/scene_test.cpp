// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include <sk/npy.hpp>

#include "support/testing.hpp"

namespace examples {
namespace {

Scene read(const std::string& text, const Overrides& overrides = {}) {
  return readScene(WrittenFile(text, "written_scene.toml").path(), overrides);
}

const std::string plane = "[grid]\nsize = [32, 16]\n[run]\nsteps = 5\n";

TEST_CASE("a table switches its operator on, and nothing else is there") {
  const Scene scene = read(plane + "[reaction]\nclass = \"theta\"\n");
  CHECK(scene.model.reaction->feed == 0.03);
  CHECK_FALSE(scene.model.hasTemperature());
  CHECK(scene.view.shown == Shown::V);
  CHECK(fieldsOf(scene.model) == std::vector<Field>{Field::U, Field::V});
  CHECK(scene.steps == 5);
  CHECK(scene.record.output == "written_scene.png");
}

TEST_CASE("fields begin with files") {
  std::vector<double> values(16 * 32);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i) / 512;
  sk::writeNpy("written_field.npy", std::vector<std::int64_t>{16, 32}, values);
  const std::string heat = plane + "[diffusion]\nepsilon = 0.5\n[initial]\n";
  const Scene scene =
      read(heat + "temperature_file = \"written_field.npy\"\ntemperature_file_range = [1, 3]\n");
  CHECK(scene.initial.temperatureField[256] == 2.0);
  CHECK_THROWS_WITH(read(heat + "u_file = \"written_field.npy\"\n"),
                    Catch::Contains("'u_file' is for a scene with a [reaction]"));
  CHECK_THROWS_WITH(
      read(heat + "temperature_file = \"none.npy\"\n"),
      Catch::Contains("'temperature_file' cannot be used: 'none.npy': the file does not exist"));
  CHECK_THROWS_WITH(read(heat + "temperature_file_range = [1, 3]\n"),
                    Catch::Contains("belongs to temperature_file, which is missing"));
  std::filesystem::remove("written_field.npy");
}

TEST_CASE("the command line goes before the file") {
  const Scene scene = read(plane + "[diffusion]\nepsilon = 0.5\n",
                           {{.size = {8, 4}, .steps = 2, .precision = sk::Precision::Double}, 0.5});
  CHECK(scene.model.grid.width == 8);
  CHECK(scene.model.grid.height == 4);
  CHECK(scene.steps == 2);
  CHECK(scene.settling->tolerance == 0.5);
  CHECK(scene.model.precision == sk::Precision::Double);
  CHECK(scene.model.diffusion->rate == 0.125);
}

TEST_CASE("a flow has its numbers from Rayleigh's and Prandtl's, and a step that is stable") {
  const std::string walls =
      "[boundary]\nbottom = \"wall\"\nbottom_temperature = 1\ntop = \"wall\"\ntop_temperature = 0\n";
  const Scene scene = read(plane + walls + "[flow]\nrayleigh = 1e4\nprandtl = 1.0\n");
  CHECK(scene.model.flow->viscosity == Approx(0.01));
  CHECK(scene.model.diffusion->rate == Approx(0.01));
  CHECK(scene.model.grid.spacing == 1.0 / 16);
  CHECK_THROWS_WITH(read(plane + "[flow]\nrayleigh = 1e4\n"),
                    Catch::Contains("'rayleigh' needs two walls that face each other"));
  CHECK_THROWS_WITH(read(plane + walls + "[flow]\nrayleigh = 1e4\n[diffusion]\nrate = 1\n"),
                    Catch::Contains("'diffusion' follows from the numbers of the flow"));
}

TEST_CASE("what is wrong with a scene is told at its place") {
  const std::string diffusion = plane + "[diffusion]\nrate = 0.1\n";
  const std::pair<std::string, const char*> cases[] = {
      {"", "'grid' is missing"},
      {"[grid]\nsize = [4, 4]\n", "'run' is missing"},
      {plane, "has no operator to step it; add [diffusion]"},
      {"[grid]\nsize = [4, 0]\n[run]\n", "written_scene.toml:2:8: 'size' takes whole numbers"},
      {"[grid]\nsize = [4, 4, 4, 4]\n[run]\n", "'size' is width, height"},
      {plane + "[difusion]\nrate = 1\n[reaction]\nclass = \"mu\"\n",
       "nobody knows 'difusion' here; did you mean 'diffusion'?"},
      {plane + "[diffusion]\nrate = \"fast\"\n", "'rate' is a text here, but must be a number"},
      {plane + "[diffusion]\nrate = nan\n", "must be finite"},
      {plane + "[diffusion]\nrate = 1.0\n", "not stable: diffusion allows 0.25 (h^2 / 4D)"},
      {plane + "[reaction]\nclass = \"omega\"\n", "no pattern is called 'omega'; there are alpha"},
      {plane + "[reaction]\nclass = \"mu\"\nfeed = 0.1\n", "'class' sets feed and kill"},
      {diffusion + "[boundary]\nbottom = \"wall\"\n", "give bottom_temperature"},
      {diffusion + "[boundary]\nbottom = \"insulated\"\n", "'bottom' is closed, but top wraps"},
      {diffusion + "[view]\nfield = \"speed\"\n", "'speed' is not in this scene"},
      {diffusion + "[view]\nlow = 2\nhigh = 1\n", "'high' is not above low"}};
  for (const auto& [text, message] : cases) CHECK_THROWS_WITH(read(text), Catch::Contains(message));
}

}  // namespace
}  // namespace examples
