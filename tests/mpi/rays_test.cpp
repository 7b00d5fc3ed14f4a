// SPDX-License-Identifier: MIT
//
// Promises: pictures of the example rays have the same bits on any number of ranks as on one device; engines that keep lists of all
// rays refuse.
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "engine.hpp"
#include "exposure.hpp"
#include "ranks.hpp"
#include "render.hpp"
#include "scene.hpp"
#include "support/ranks.hpp"

namespace {

namespace fs = std::filesystem;

rays::Scene small(const std::string& name, const std::string& engine) {
  rays::Overrides overrides;
  overrides.width = 23;
  overrides.height = 17;
  overrides.samples = 3;
  overrides.engine = engine;
  overrides.error = 0.0;
  return rays::readScene(fs::path(SK_RAYS_SCENES) / (name + ".toml"), overrides);
}

struct Result {
  std::vector<sk::float3> radiance, variance;
};

Result render(const rays::Scene& scene, sk::Device& device) {
  const std::unique_ptr<rays::Engine> engine = scene.engines.at(scene.engine)(device, scene.model);
  const std::unique_ptr<rays::Renderer> renderer = engine->renderer(scene.picture);
  Result result;
  result.radiance = rays::render(*renderer, scene).radiance;
  result.variance = renderer->variance();
  return result;
}

bool areSame(const std::vector<sk::float3>& a, const std::vector<sk::float3>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(sk::float3)) == 0;
}

TEST_CASE("pictures have the bits of one device") {
  for (const char* name : {"cornell", "rings"}) {
    INFO(name);
    rays::Scene scene = small(name, "bvh");
    const auto grid = examples::divideGrid("", {17, 23}, examples::Ends::Open);
    scene.picture.grid = grid.get();
    const Result ranks = render(scene, grid->device());
    CHECK(ranks.radiance.empty() == (rankOfWorld() != 0));
    if (rankOfWorld() != 0) continue;
    scene.picture.grid = nullptr;
    sk::Device device;
    const Result plain = render(scene, device);
    CHECK(areSame(ranks.radiance, plain.radiance));
    CHECK(areSame(ranks.variance, plain.variance));
    CHECK(plain.variance.size() == 23 * 17);
  }
}

TEST_CASE("an engine that keeps lists of all rays refuses pixels that are divided") {
  rays::Scene scene = small("cornell", "ray_engine");
  const auto grid = examples::divideGrid("", {17, 23}, examples::Ends::Open);
  scene.picture.grid = grid.get();
  CHECK_THROWS_WITH(render(scene, grid->device()), Catch::Contains("keeps lists of all rays on one device"));
}

}  // namespace
