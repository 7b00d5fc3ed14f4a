// SPDX-License-Identifier: MIT
//
// Every scene of the folder by every mode, natively, and drawn and dispatched by some mode each.
#include "alike.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

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
  std::array devices = {sk::Device(sk::DeviceOptions{.device = "software", .profile = "glsl330"}),
                        sk::Device(sk::DeviceOptions{.device = "software", .profile = "glsl430"})};
  const std::vector<Mode> all = allModes();
  // Each takes a second to compile, so that each scene has one of them, in turn. What the others compile takes longer: the study has them.
  std::vector<Mode> modes;
  for (const char* name : {"bvh", "streaming, branching"})
    modes.push_back(*std::ranges::find(all, name, &Mode::name));
  std::size_t i = 0;
  for (const std::filesystem::path& file : sceneFiles(SK_RAYS_SCENES)) {
    const Scene scene = readScene(file, {.width = 8, .height = 6, .samples = 2, .mostLevel = 1});
    const Mode& mode = modes[i % modes.size()];
    sk::Device& device = devices[(i + i / modes.size()) % 2];
    ++i;
    INFO(scene.name << " by " << mode.name);
    checkLikeness(likenessOf(resultOf(device, scene, mode), resultOf(native, scene, all[0])));
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
