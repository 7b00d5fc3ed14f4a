// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "camera.hpp"
#include "hits_file.hpp"
#include "layers.hpp"
#include "light_table.hpp"
#include "scenes_test.hpp"
#include "support/testing.hpp"

namespace rays {
namespace {

TEST_CASE("ids count triangles over all meshes and instances, then spheres and planes") {
  const Scene scene = sceneFrom(
      "[[mesh]]\nname = \"a\"\nshape = \"box\"\n[[instance]]\nof = \"a\"\ntranslate = [4, 0, 0]\n"
      "[[mesh]]\nshape = \"quad\"\n[[sphere]]\nradius = 2\n[[plane]]\n");
  const Model& model = scene.model;
  REQUIRE(model.triangles.size() == 26);
  CHECK(model.triangles[25].id == 25);
  CHECK(model.sphereId(0) == 26);
  CHECK(model.planeId(0) == 27);
  CHECK(model.unit == 0.25);
  CHECK(model.spheres[0].radius == 0.5f);
  CHECK(model.triangles[12].a.y == 0.0f);  // the quad's: meshes come before instances
  CHECK(model.triangles[14].a.x >= 3.5f / 4);
}

TEST_CASE("a quarter turn is exact, and scales come first") {
  const Scene scene = sceneFrom(
      "[[mesh]]\nshape = \"quad\"\nscale = [2, 1, 4]\nrotate = [0, 0, 1, 90]\ntranslate = [0, 0, 0]\n");
  for (const Triangle& t : scene.model.triangles)
    for (const sk::float3* p : {&t.a, &t.b, &t.c}) {
      CHECK(p->x == 0.0f);
      CHECK(std::abs(p->y) == 0.5f);
      CHECK(std::abs(p->z) == 1.0f);
    }
}

TEST_CASE("vertices that are not finite are named and left out, or an error") {
  const examples::WrittenFile mesh("v 0 0 0\nv 1 0 0\nv nan 1 0\nv 1 1 0\nf 1 2 3\nf 1 2 4\n",
                                   "written_rays.obj");
  const std::string text = "[[mesh]]\nfile = \"written_rays.obj\"\n";
  const Scene scene = sceneFrom(text);
  REQUIRE(scene.model.triangles.size() == 1);
  CHECK(scene.model.triangles[0].id == 1);
  CHECK(scene.model.leftOut == 1);
  REQUIRE(scene.warnings.size() == 1);
  CHECK_THAT(scene.warnings[0], Catch::Contains("a vertex is not finite (2, counted from 0)"));
  CHECK_THROWS_WITH(sceneFrom(text, {.strict = true}), Catch::Contains("a vertex is not finite"));
}

TEST_CASE("a camera inside of a wall sees backs alone") {
  sk::Device device = sk::Device::native();
  const auto sees = [&](const std::string& text) {
    const Scene scene = sceneFrom(text + "[[mesh]]\nshape = \"box\"\nmaterial = \"m\"\n");
    return seesBacksAlone(*scene.engines.at("bvh")(device, scene.model), scene.model);
  };
  const std::string inside = "[camera]\nfrom = [0.1, 0, 0]\nto = [0, 0, 1]\n",
                    beside = "[camera]\nfrom = [0, 0, 3]\n";
  const std::string wall = "[[material]]\nname = \"m\"\n", glass = wall + "type = \"glass\"\n";
  CHECK(sees(inside + wall));
  CHECK_FALSE(sees(inside + glass));
  CHECK_FALSE(sees(beside + wall));
}

TEST_CASE("a camera is carried about what it looks at") {
  Camera camera;
  camera.from = {0, 0, 5};
  camera.focus = 5;
  const Camera right = turned(camera, std::numbers::pi / 2, 0);
  CHECK(length(right.from - Vector{5, 0, 0}) < 1e-12);
  CHECK(length(turned(camera, 0, std::numbers::pi / 6).from - Vector{0, 2.5, 5 * std::sqrt(0.75)}) < 1e-12);
  // Never over the top, where it would look along `up`.
  const Camera top = turned(camera, 0, 9);
  CHECK(top.from.y < 5);
  CHECK(length(top.from) == Approx(5));
  CHECK_NOTHROW(viewOf(top, 4, 3));
  CHECK(approached(camera, 0.5).from.z == 2.5);
  CHECK(approached(camera, 0.5).focus == 2.5);
}

TEST_CASE("an empty mesh is reported") {
  const examples::WrittenFile mesh("# nothing\n", "written_rays.obj");
  const Scene scene = sceneFrom("[[mesh]]\nfile = \"written_rays.obj\"\n");
  CHECK(scene.model.triangles.empty());
  REQUIRE(scene.warnings.size() == 1);
  CHECK_THAT(scene.warnings[0], Catch::Contains("the mesh has no faces"));
}

TEST_CASE("a scene is known to have no light only if no light, sky or surface emits") {
  CHECK_FALSE(hasLight(sceneFrom("").model));
  CHECK_FALSE(hasLight(sceneFrom("[[sphere]]\n[[material]]\nname = \"white\"\n").model));
  CHECK(hasLight(sceneFrom("[environment]\ncolour = [0, 0, 1]\n").model));
  CHECK(hasLight(sceneFrom("[[light]]\ntype = \"sun\"\n").model));
  CHECK(hasLight(sceneFrom("[[light]]\nintensity = [1, 0, 0]\n").model));
  const char* lamp = "[[material]]\nname = \"lamp\"\nemission = [1, 1, 1]\n";
  CHECK_FALSE(hasLight(sceneFrom(lamp).model));
  CHECK(hasLight(sceneFrom(std::string(lamp) + "[[sphere]]\nmaterial = \"lamp\"\n").model));
}

TEST_CASE("errors in scenes name the line and the column") {
  const std::pair<const char*, const char*> cases[] = {
      {"[camera]\nfiled_of_view = 3\n", ":2:1: "},
      {"[camera]\nfiled_of_view = 3\n", "did you mean 'field_of_view'"},
      {"engine = \"bvhh\"\n", "did you mean 'bvh'"},
      {"[bvh]\nlaef = 3\n", "did you mean 'leaf'"},
      {"[bvh]\nnodes = 4\n", ":2:9: 'nodes' have 2 or 8 children"},
      {"[bvh]\ntraversal = \"skip\"\nnodes = 8\n", "links past what is missed are for 'nodes' of 2"},
      {"[ray_engine]\nbucket = 100\n", ":2:10: 'bucket' is a multiple of 64"},
      {"[bvh]\nprecision = \"half\"\n", "precision"},
      {"[picture]\nstrategy = \"light\"\n", "did you mean 'lights'"},
      {"[[mesh]]\nshape = \"cube\"\n", "there is no shape 'cube'"},
      {"[[mesh]]\n", "'file' is missing"},
      {"[[mesh]]\nfile = \"none.obj\"\n", ":2:8: 'file' 'none.obj' does not exist"},
      {"[[sphere]]\nmaterial = \"gold\"\n[[material]]\nname = \"cold\"\n", "did you mean 'cold'"},
      {"[[sphere]]\nmaterial = \"gold\"\n", "material 'gold'"},
      {"[[sphere]]\nradius = -1\n", "'radius' is -1"},
      {"[[instance]]\nof = \"b\"\n", "names no mesh: 'b'"},
      {"[[material]]\nname = \"a\"\ncolour = [2, 0, 0]\n", "from 0 to 1"},
      {"[camera]\nto = [0, 0, 5]\n", "the camera looks nowhere"},
      {"[camera]\nup = [0, 0, 2]\n", "direction in which the camera looks"},
      {"[[plane]]\nnormal = [0, 0, 0]\n", "must not be zero"},
      {"[environment]\nimage = \"none.pfm\"\n", "none.pfm"}};
  for (const auto& [text, message] : cases) CHECK_THROWS_WITH(sceneFrom(text), Catch::Contains(message));
}

TEST_CASE("rays are lines of six or eight numbers") {
  const examples::WrittenFile file("# two rays\n0 0 1 0 0 -1\n\n 1 2 3 4e-40 -0 6 0.5 inf \r\n",
                                   "written_rays.txt");
  const std::vector<Ray> rays = loadRays(file.path());
  REQUIRE(rays.size() == 2);
  CHECK(rays[0].direction.z == -1.0f);
  CHECK(rays[0].most == HUGE_VALF);
  CHECK(rays[1].least == 0.5f);
  CHECK(std::signbit(rays[1].direction.y));
  CHECK(rays[1].direction.x == 4e-40f);
  const std::pair<const char*, const char*> wrong[] = {
      {"0 0 0 0 0 0\n", "written_rays.txt:1:11: a direction must not be zero"},
      {"\n0 0 a 0 0 1\n", ":2:5: 'a' is no number"},
      {"0 0 0 0 1\n", "dz is missing"},
      {"0 0 0 0 0 1 2\n", "tmax is missing"},
      {"0 0 0 0 0 1 2 3 4\n", ":1:17: '4' is too much; a ray is ox oy oz"},
      {"nan 0 0 0 0 1\n", "must be finite"}};
  for (const auto& [text, message] : wrong) {
    const examples::WrittenFile broken(text, "written_rays.txt");
    CHECK_THROWS_WITH(loadRays(broken.path()), Catch::Contains(message));
  }
}

}  // namespace
}  // namespace rays
