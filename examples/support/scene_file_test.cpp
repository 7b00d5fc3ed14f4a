// SPDX-License-Identifier: MIT
//
// Scenes as people write them, right and wrong.
#include "support/scene_file.hpp"

#include <array>

#include <catch2/catch.hpp>

#include "support/testing.hpp"

namespace {

using namespace examples;

}  // namespace

TEST_CASE("a scene gives what it has") {
  const WrittenFile file(
      "title = \"hot\"\nsteps = 12\n[grid]\nsize = [4, 8]\nspacing = 0.5\nwrap = true\n"
      "[[sphere]]\nradius = 1\n[[sphere]]\nradius = 2.5\n");
  const SceneTable scene = loadScene(file.path());
  CHECK(scene.text("title") == "hot");
  CHECK(scene.integer("steps") == 12);
  CHECK(scene.number("steps") == 12.0);
  CHECK_FALSE(scene.number("pace"));
  CHECK_FALSE(scene.table("view"));
  const SceneTable grid = *scene.table("grid");
  CHECK(grid.numbers("size", 2) == std::vector<double>{4, 8});
  CHECK(grid.number("spacing") == 0.5);
  CHECK(grid.flag("wrap") == true);
  const auto spheres = scene.tables("sphere");
  REQUIRE(spheres.size() == 2);
  CHECK(spheres[1].number("radius") == 2.5);
  CHECK(spheres[0].has("radius"));
  scene.finish();
}

TEST_CASE("what is wrong with a scene is told at its place") {
  const WrittenFile file(
      "steps = 1.5\nspacing = nan\nname = 7\n[grid]\nsise = [4, 8]\nkind = \"wrapp\"\ncells = [1, "
      "\"x\"]\n[[ball]]\nr = -1\n");
  const SceneTable scene = loadScene(file.path());
  const SceneTable grid = *scene.table("grid");
  constexpr std::array<std::string_view, 2> kinds{"wrap", "wall"};
  CHECK_THROWS_WITH(scene.integer("steps"),
                    "written.toml:1:9: 'steps' is a number here, but must be an integer");
  CHECK_THROWS_WITH(scene.number("spacing"), "written.toml:2:11: 'spacing' is nan, but must be finite");
  CHECK_THROWS_WITH(scene.text("name"),
                    "written.toml:3:8: 'name' is an integer here, but must be a text, \"in quotes\"");
  CHECK_THROWS_WITH(grid.choice("kind", kinds),
                    "written.toml:6:8: there is no kind 'wrapp'; did you mean 'wrap'?");
  CHECK_THROWS_WITH(grid.numbers("cells", 3),
                    "written.toml:7:9: 'cells' has 2 elements, but must be an array of 3 numbers");
  CHECK_THROWS_WITH(grid.numbers("cells", 2),
                    "written.toml:7:13: 'cells' is a text here, but must be a number");
  CHECK_THROWS_WITH(scene.tables("grid"),
                    "written.toml:4:1: 'grid' is a table here, but must be a list of tables, each [[grid]]");
  CHECK_THROWS_WITH(scene.tables("ball")[0].number("r", {.least = 0}),
                    "written.toml:9:5: 'r' is -1, but must be 0 at least");
  CHECK_THROWS_WITH(scene.tables("ball")[0].number("r", {0, 1}),
                    "written.toml:9:5: 'r' is -1, but must be from 0 to 1");
  CHECK_THROWS_WITH(grid.fail("depth", "a depth is missing"), "written.toml:4:1: a depth is missing");
}

TEST_CASE("keys that nobody has asked for are told, with what is like them") {
  const WrittenFile file("steps = 1\n[grid]\nsise = 4\n[[ball]]\ncolour = 3\n");
  const SceneTable scene = loadScene(file.path());
  scene.integer("steps");
  CHECK_THROWS_WITH(scene.finish(), "written.toml:4:3: nobody knows 'ball' here; there are steps");
  const auto balls = scene.tables("ball");
  const SceneTable grid = *scene.table("grid");
  grid.number("size");
  CHECK_THROWS_WITH(scene.finish(), "written.toml:5:1: nobody knows 'colour' here; nothing may stand here");
  balls[0].number("colour");
  CHECK_THROWS_WITH(scene.finish(), "written.toml:3:1: nobody knows 'sise' here; did you mean 'size'?");
}

TEST_CASE("what is no scene is told") {
  CHECK_THROWS_WITH(loadScene("missing.toml"), "the scene 'missing.toml' does not exist");
  CHECK_THROWS_WITH(loadScene("."), "the scene '.' cannot be read; name a TOML file");
  const WrittenFile broken("steps = = 3\n");
  CHECK_THROWS_WITH(loadScene(broken.path()), Catch::StartsWith("written.toml:1:9: "));
}
