// SPDX-License-Identifier: MIT
//
// Every scene of the folder by every mode, natively, and some of them drawn and dispatched.
#include "alike.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "support/testing.hpp"

namespace rays {
namespace {

void checkLikeness(const Likeness& likeness) {
  CHECK(likeness.mean < 4.0);
  CHECK(likeness.differing < 0.05);
}

TEST_CASE("scenes look alike by every mode, natively") {
  sk::Device native = sk::Device::native();
  for (const std::filesystem::path& file : sceneFiles(SK_RAYS_SCENES)) {
    const Scene scene = readScene(file, {.width = 24, .height = 16, .samples = 2, .mostLevel = 1});
    const Result expected = resultOf(native, scene, allModes()[0]);
    for (const Mode& mode : allModes()) {
      INFO(scene.name << " by " << mode.name);
      checkLikeness(likenessOf(resultOf(native, scene, mode), expected));
    }
  }
}

TEST_CASE("scenes look alike drawn and dispatched") {
  sk::Device native = sk::Device::native();
  const std::vector<Mode> all = allModes();
  // Each takes a second or two to compile: the kernels of both engines, whose GLSL is the same for every scene. What other scenes, profiles
  // and modes compile is left to the study, and to smaller scenes of other tests.
  struct Case {
    const char *scene, *mode, *profile;
  };
  for (const auto& [name, mode, profile] :
       {Case{"caustics", "bvh", "glsl330"}, {"terrain", "streaming, branching", "glsl430"}}) {
    INFO(name << " by " << mode << " on " << profile);
    sk::Device device = examples::deviceNamed(profile);
    const Scene scene = readScene(std::string(SK_RAYS_SCENES) + "/" + name + ".toml",
                                  {.width = 8, .height = 6, .samples = 2, .mostLevel = 1});
    const Result got = resultOf(device, scene, *std::ranges::find(all, std::string(mode), &Mode::name));
    checkLikeness(likenessOf(got, resultOf(native, scene, all[0])));
  }
}

TEST_CASE("pictures of other light are told apart") {
  sk::Device native = sk::Device::native();
  Scene scene = readScene(sceneFiles(SK_RAYS_SCENES).front(),
                          {.width = 16, .height = 12, .samples = 2, .mostLevel = 2});
  const Result expected = resultOf(native, scene, allModes()[0]);
  for (Material& m : scene.model.materials) m.colour.y *= 0.98f;
  CHECK(likenessOf(resultOf(native, scene, allModes()[0]), expected).mean > 4.0);
}

}  // namespace
}  // namespace rays
