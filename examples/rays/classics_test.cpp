// SPDX-License-Identifier: MIT
//
// The classic engines against the hierarchy of boxes.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "scene.hpp"
#include "soup_test.hpp"
#include "support/written_file.hpp"

namespace rays {
namespace {

sk::Device deviceOf(const std::string& name) {
  if (name == "native") return sk::Device::native();
  return sk::Device(sk::DeviceOptions{.device = "software", .profile = name});
}

std::unique_ptr<Engine> engineOf(sk::Device& device, const Model& model, const std::string& name, const std::string& settings) {
  const examples::WrittenFile file(fmt::format("[{}]\n{}", name, settings), "written_classic.toml");
  return readScene(file.path(), {}).engines.at(name)(device, model);
}

std::vector<Hit> hitsOf(Engine& engine, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size());
  engine.closest(rays, hits);
  return hits;
}

std::vector<std::uint8_t> shadowsOf(Engine& engine, const std::vector<Ray>& rays) {
  std::vector<std::uint8_t> blocked(rays.size());
  engine.occluded(rays, blocked);
  return blocked;
}

/// Where an engine finds another id, it must be at the same distance: programs may round t differently by some units in the last place,
/// 2^-20 of it at most.
void compareHits(const std::vector<Hit>& got, const std::vector<Hit>& expected) {
  REQUIRE(got.size() == expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    INFO("ray " << i);
    if (expected[i].id < 0) {
      CHECK(got[i].id < 0);
      continue;
    }
    CHECK(std::abs(got[i].t - expected[i].t) <= 0x1p-20f * expected[i].t);
    if (got[i].id != expected[i].id) continue;
    CHECK(std::abs(got[i].u - expected[i].u) <= 1e-4f);
    CHECK(std::abs(got[i].v - expected[i].v) <= 1e-4f);
  }
}

/// Every way of an engine against the hierarchy of boxes.
void compareEngines(sk::Device& device, const Model& model, const std::vector<Ray>& rays, const std::string& intersection) {
  const std::string test = fmt::format("intersection = '{}'\n", intersection);
  const std::unique_ptr<Engine> bvh = engineOf(device, model, "bvh", test);
  const std::vector<Hit> hits = hitsOf(*bvh, rays);
  const std::vector<std::uint8_t> shadows = shadowsOf(*bvh, rays);
  for (const char* machine : {"branching", "multipass"}) {
    INFO(machine);
    const auto streaming = engineOf(device, model, "streaming", fmt::format("machine = '{}'\n{}", machine, test));
    compareHits(hitsOf(*streaming, rays), hits);
    CHECK(shadowsOf(*streaming, rays) == shadows);
  }
}

TEST_CASE("all engines find the same hits and shadows, on every device") {
  const Model model = soup({});
  const std::vector<Ray> rays = raysAtRandom(1500);
  for (const char* name : {"native", "glsl330", "glsl430", "essl300"}) {
    INFO(name);
    sk::Device device = deviceOf(name);
    compareEngines(device, model, rays, "moller");
  }
}

TEST_CASE("engines agree on scenes with one kind of shape, or none, or a single cell") {
  sk::Device device = sk::Device::native();
  const std::vector<Ray> rays = raysAtRandom(300);
  for (const SoupSize& size : {SoupSize{100, 0, 0}, SoupSize{0, 30, 0}, SoupSize{0, 0, 2}, SoupSize{0, 0, 0}, SoupSize{1, 0, 0}}) {
    INFO(size.triangles << " triangles, " << size.spheres << " spheres, " << size.planes << " planes");
    const Model model = soup(size);
    compareEngines(device, model, rays, "watertight");
    compareEngines(device, model, {}, "watertight");
  }
}

TEST_CASE("the multipass machine finds the same however it is set") {
  sk::Device device = sk::Device::native();
  const Model model = soup({});
  const std::vector<Ray> rays = raysAtRandom(300);
  const std::vector<Hit> hits = hitsOf(*engineOf(device, model, "streaming", ""), rays);
  for (const int tests : {1, 16}) {
    for (const double compact : {0.0, 1.0}) {
      const std::string settings = fmt::format("machine = 'multipass'\ntests = {}\nrounds = 3\ncompact = {:.1f}", tests, compact);
      compareHits(hitsOf(*engineOf(device, model, "streaming", settings), rays), hits);
    }
  }
}

TEST_CASE("rays that are not finite end, and hit nothing that matters") {
  sk::Device device = sk::Device::native();
  const Model model = soup({});
  const float nan = std::nanf(""), infinity = HUGE_VALF;
  std::vector<Ray> rays;
  for (const float bad : {nan, infinity, -infinity}) {
    for (int i = 0; i < 6; ++i) {
      Ray r{.origin = {0.1f, 0.2f, 0.3f}, .direction = {0.3f, 0.5f, 1.0f}};
      float* components[] = {&r.origin.x, &r.origin.y, &r.origin.z, &r.direction.x, &r.direction.y, &r.direction.z};
      *components[i] = bad;
      rays.push_back(r);
    }
  }
  for (const char* machine : {"branching", "multipass"}) {
    const auto engine = engineOf(device, model, "streaming", fmt::format("machine = '{}'", machine));
    CHECK(hitsOf(*engine, rays).size() == rays.size());
  }
}

}  // namespace
}  // namespace rays
