// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "camera.hpp"
#include "hits_file.hpp"
#include "layers.hpp"
#include "light_table.hpp"
#include "support/testing.hpp"

namespace rays {
namespace {

Scene read(const std::string& text, const Overrides& overrides = {}) {
  return readScene(examples::WrittenFile(text, "written_rays.toml").path(), overrides);
}

std::string messageOf(const std::string& text, const Overrides& overrides = {}) {
  try {
    read(text, overrides);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

std::string raysMessage(const std::string& text) {
  try {
    loadRays(examples::WrittenFile(text, "written_rays.txt").path());
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

TEST_CASE("ids count triangles over all meshes and instances, then spheres and planes") {
  const Scene scene = read(
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
  const Scene scene =
      read("[[mesh]]\nshape = \"quad\"\nscale = [2, 1, 4]\nrotate = [0, 0, 1, 90]\ntranslate = [0, 0, 0]\n");
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
  const Scene scene = read(text);
  REQUIRE(scene.model.triangles.size() == 1);
  CHECK(scene.model.triangles[0].id == 1);
  CHECK(scene.model.leftOut == 1);
  REQUIRE(scene.warnings.size() == 1);
  CHECK_THAT(scene.warnings[0], Catch::Contains("a vertex is not finite (2, counted from 0)"));
  Overrides strict;
  strict.strict = true;
  CHECK_THAT(messageOf(text, strict), Catch::Contains("a vertex is not finite"));
}

TEST_CASE("a camera inside of a wall sees backs alone") {
  sk::Device device = sk::Device::native();
  const auto sees = [&](const std::string& text) {
    const Scene scene = read(text + "[[mesh]]\nshape = \"box\"\nmaterial = \"m\"\n");
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
  const Scene scene = read("[[mesh]]\nfile = \"written_rays.obj\"\n");
  CHECK(scene.model.triangles.empty());
  REQUIRE(scene.warnings.size() == 1);
  CHECK_THAT(scene.warnings[0], Catch::Contains("the mesh has no faces"));
}

TEST_CASE("a scene is known to have no light only if no light, sky or surface emits") {
  CHECK_FALSE(hasLight(read("").model));
  CHECK_FALSE(hasLight(read("[[sphere]]\n[[material]]\nname = \"white\"\n").model));
  CHECK(hasLight(read("[environment]\ncolour = [0, 0, 1]\n").model));
  CHECK(hasLight(read("[[light]]\ntype = \"sun\"\n").model));
  CHECK(hasLight(read("[[light]]\nintensity = [1, 0, 0]\n").model));
  const char* lamp = "[[material]]\nname = \"lamp\"\nemission = [1, 1, 1]\n";
  CHECK_FALSE(hasLight(read(lamp).model));
  CHECK(hasLight(read(std::string(lamp) + "[[sphere]]\nmaterial = \"lamp\"\n").model));
}

TEST_CASE("errors in scenes name the line and the column") {
  CHECK_THAT(messageOf("[camera]\nfiled_of_view = 3\n"),
             Catch::Contains(":2:1: ") && Catch::Contains("did you mean 'field_of_view'"));
  CHECK_THAT(messageOf("engine = \"bvhh\"\n"), Catch::Contains("did you mean 'bvh'"));
  CHECK_THAT(messageOf("[bvh]\nlaef = 3\n"), Catch::Contains("did you mean 'leaf'"));
  CHECK_THAT(messageOf("[bvh]\nprecision = \"half\"\n"), Catch::Contains("precision"));
  CHECK_THAT(messageOf("[picture]\nstrategy = \"light\"\n"), Catch::Contains("did you mean 'lights'"));
  CHECK_THAT(messageOf("[[mesh]]\nshape = \"cube\"\n"), Catch::Contains("there is no shape 'cube'"));
  CHECK_THAT(messageOf("[[mesh]]\n"), Catch::Contains("'file' is missing"));
  CHECK_THAT(messageOf("[[mesh]]\nfile = \"none.obj\"\n"),
             Catch::Contains(":2:8: 'file' 'none.obj' does not exist"));
  CHECK_THAT(messageOf("[[sphere]]\nmaterial = \"gold\"\n[[material]]\nname = \"cold\"\n"),
             Catch::Contains("did you mean 'cold'"));
  CHECK_THAT(messageOf("[[sphere]]\nmaterial = \"gold\"\n"), Catch::Contains("material 'gold'"));
  CHECK_THAT(messageOf("[[sphere]]\nradius = -1\n"), Catch::Contains("'radius' is -1"));
  CHECK_THAT(messageOf("[[instance]]\nof = \"b\"\n"), Catch::Contains("names no mesh: 'b'"));
  CHECK_THAT(messageOf("[[material]]\nname = \"a\"\ncolour = [2, 0, 0]\n"), Catch::Contains("from 0 to 1"));
  CHECK_THAT(messageOf("[camera]\nto = [0, 0, 5]\n"), Catch::Contains("the camera looks nowhere"));
  CHECK_THAT(messageOf("[camera]\nup = [0, 0, 2]\n"), Catch::Contains("direction in which the camera looks"));
  CHECK_THAT(messageOf("[[plane]]\nnormal = [0, 0, 0]\n"), Catch::Contains("must not be zero"));
  CHECK_THAT(messageOf("[environment]\nimage = \"none.pfm\"\n"), Catch::Contains("none.pfm"));
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
  CHECK(raysMessage("0 0 0 0 0 0\n") == "written_rays.txt:1:11: a direction must not be zero");
  CHECK_THAT(raysMessage("\n0 0 a 0 0 1\n"), Catch::Contains(":2:5: 'a' is no number"));
  CHECK_THAT(raysMessage("0 0 0 0 1\n"), Catch::Contains("dz is missing"));
  CHECK_THAT(raysMessage("0 0 0 0 0 1 2\n"), Catch::Contains("tmax is missing"));
  CHECK_THAT(raysMessage("0 0 0 0 0 1 2 3 4\n"),
             Catch::Contains(":1:17: '4' is too much; a ray is ox oy oz"));
  CHECK_THAT(raysMessage("nan 0 0 0 0 1\n"), Catch::Contains("must be finite"));
}

}  // namespace
}  // namespace rays
