// SPDX-License-Identifier: MIT
//
// Shapes in halves against the same shapes, rounded, in floats and in loops in double precision.
#include "vertex_storage.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "scenes_test.hpp"
#include "support/testing.hpp"

namespace rays {
namespace {

TEST_CASE("hits of shapes in halves are those of the rounded shapes, on every device") {
  Model model = soup({});
  for (std::size_t i = 0; i < model.triangles.size(); ++i)
    model.triangles[i].id = static_cast<std::int32_t>(i);  // the loops look for ids in order
  const std::vector<Ray> rays = raysAtRandom(1000);
  for (const char* name : {"native", "glsl330", "essl300", "glsl430"}) {
    INFO(name);
    const bool isNative = name == std::string("native");
    sk::Device device = examples::deviceNamed(name);
    const std::unique_ptr<Engine> engine = engineOf(device, model, "storage = \"half\"\n");
    const Model& rounded = engine->model();
    const std::vector<Hit> expected = hitsOf(*engineOf(device, rounded, ""), rays);
    const bool isSame = hitsOf(*engine, rays) == expected;
    CHECK(isSame);
    if (isNative) {
      CHECK(&rounded != &model);
      CHECK(expected != hitsOf(*engineOf(device, model, ""), rays));
      for (std::size_t i = 0; i < rays.size(); ++i) CHECK(errorOf(rounded, rays[i], expected[i]) < 0x1p-20);
      CHECK(hitsOf(*engineOf(device, model, "storage = \"half\"\nnodes = 2\n"), rays) == expected);
      CHECK(hitsOf(*engineOf(device, model, "storage = \"half\"\nprecision = \"double\"\n"), rays) ==
            hitsOf(*engineOf(device, rounded, "precision = \"double\"\n"), rays));
    }
  }
}

TEST_CASE("pictures of shapes in halves are those of the rounded shapes") {
  Model model = soup({});
  model.environment.colour = {1, 1, 1};
  model.camera.from = {0, 0, 3};
  // Numbers of materials take two digits.
  model.materials.resize(2 * 2048 + 3, {.name = "grey"});
  model.materials.back() = {.name = "red", .colour = {0.8f, 0, 0}};
  model.materials[5] = {.name = "lamp", .emission = {3, 2, 1}};
  for (Triangle& t : model.triangles) t.material = t.id % 3 == 0 ? 2 * 2048 + 2 : t.id % 3 == 1 ? 5 : 1;
  for (Sphere& s : model.spheres) s.material = 2 * 2048 + 2;
  sk::Device device = sk::Device::native();
  for (const std::string settings : {"", "machine = \"wavefront\"\n"}) {
    const std::unique_ptr<Engine> engine = engineOf(device, model, settings + "storage = \"half\"\n");
    const std::unique_ptr<Engine> plain = engineOf(device, engine->model(), settings);
    const Picture picture{.width = 24, .height = 16, .depth = 3};
    CHECK(imageOf(*engine, picture, 1) == imageOf(*plain, picture, 1));
  }
}

TEST_CASE("rounding to halves tells the largest move and the triangles that it collapses") {
  Model model;
  model.unit = 0.25;
  model.triangles.push_back({{1, 0, 0}, {0, 1.5f, 0}, {0, 0, 0x1p-29f}, 0, 0});
  model.triangles.push_back({{1, 1, 1}, {1 + 0x1p-12f, 1, 1}, {1, 1 + 0x1p-11f, 1}, 1, 0});
  model.triangles.push_back({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, 2, 0});
  model.spheres = {{{0.5f, 0, 0}, 0x1p-40f, 0}};
  const Rounding rounding = roundToHalves(model);
  CHECK(rounding.collapsed == 1);
  CHECK(rounding.farthest == 4 * 0x1p-11);
  CHECK(model.triangles[0].b.y == 1.5f);
  CHECK(model.triangles[0].c.z == 0.0f);
  CHECK(model.triangles[1].b.x == 1.0f);
  CHECK(model.spheres[0].radius == 0x1p-28f);
  CHECK(roundToHalves(model).farthest == 0.0);
  model.triangles[0].a.x = -4.0f;
  CHECK_THROWS_WITH(roundToHalves(model), Catch::Contains("too large for halves"));
  model.triangles[0].a.x = 1.0f + 0x1p-12f;
  sk::Device device = sk::Device::native();
  CHECK(engineOf(device, model, "storage = \"single\"\n")->warnings().empty());
  model.triangles[1].b.x = 1 + 0x1p-12f;
  model.triangles[1].c.y = 1 + 0x1p-10f;
  const std::unique_ptr<Engine> engine = engineOf(device, model, "storage = \"half\"\n");
  REQUIRE(engine->warnings().size() == 1);
  CHECK_THAT(engine->warnings()[0], Catch::Contains("1 of 3 triangles without an area"));
  CHECK_THAT(engine->account().back(), Catch::Contains("32 bytes each in place of 48"));
}

TEST_CASE("storages that there are not are errors that name those that there are") {
  using Catch::Contains;
  CHECK_THROWS_WITH(sceneFrom("[bvh]\nstorage = \"haf\"\n"),
                    Contains(":2:") && Contains("did you mean 'half'"));
  CHECK_THROWS_WITH(sceneFrom("[bvh]\nstorage = \"double\"\n"),
                    Contains("storage") && Contains("single") && Contains("half"));
  CHECK_THROWS_WITH(sceneFrom("[bvh]\nprecision = \"half\"\n"),
                    Contains("precision") && Contains("single") && Contains("double"));
}

}  // namespace
}  // namespace rays
