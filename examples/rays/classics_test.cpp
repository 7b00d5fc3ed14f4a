// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "bvh_engine.hpp"
#include "soup_test.hpp"
#include "streaming_engine.hpp"

namespace rays {
namespace {

struct DeviceChoice {
  const char* device;
  const char* profile;
};
constexpr DeviceChoice devices[] = {{"native", ""}, {"software", "glsl330"}, {"software", "glsl430"}, {"software", "essl300"}};

sk::Device deviceOf(const DeviceChoice& choice) {
  return *choice.profile == 0 ? sk::Device(choice.device) : sk::Device({.device = choice.device, .profile = choice.profile});
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
void compareEngines(sk::Device& device, const Model& model, const std::vector<Ray>& rays, HowToIntersect intersection) {
  const std::unique_ptr<Engine> bvh = makeBvhEngine(device, model, {.intersection = intersection});
  const std::vector<Hit> hits = hitsOf(*bvh, rays);
  const std::vector<std::uint8_t> shadows = shadowsOf(*bvh, rays);
  for (const Machine machine : {Machine::Branching, Machine::Multipass}) {
    INFO((machine == Machine::Branching ? "branching" : "multipass"));
    const auto streaming = makeStreamingEngine(device, model, {.machine = machine, .intersection = intersection});
    compareHits(hitsOf(*streaming, rays), hits);
    CHECK(shadowsOf(*streaming, rays) == shadows);
  }
}

TEST_CASE("all engines find the same hits and shadows, on every device") {
  const Model model = soup({});
  const std::vector<Ray> rays = raysAtRandom(1500);
  for (const DeviceChoice& choice : devices) {
    INFO(choice.device << " " << choice.profile);
    sk::Device device = deviceOf(choice);
    compareEngines(device, model, rays, HowToIntersect::Moller);
  }
}

TEST_CASE("engines agree on scenes with one kind of shape, or none, or a single cell") {
  sk::Device device = sk::Device::native();
  const std::vector<Ray> rays = raysAtRandom(300);
  for (const SoupSize& size : {SoupSize{100, 0, 0}, SoupSize{0, 30, 0}, SoupSize{0, 0, 2}, SoupSize{0, 0, 0}, SoupSize{1, 0, 0}}) {
    INFO(size.triangles << " triangles, " << size.spheres << " spheres, " << size.planes << " planes");
    const Model model = soup(size);
    compareEngines(device, model, rays, HowToIntersect::Watertight);
    compareEngines(device, model, {}, HowToIntersect::Watertight);
  }
}

TEST_CASE("the multipass machine finds the same however it is set") {
  sk::Device device = sk::Device::native();
  const Model model = soup({});
  const std::vector<Ray> rays = raysAtRandom(300);
  const std::vector<Hit> hits = hitsOf(*makeStreamingEngine(device, model, {}), rays);
  for (const int tests : {1, 16}) {
    for (const double compact : {0.0, 1.0}) {
      const StreamingSettings settings{.machine = Machine::Multipass, .tests = tests, .rounds = 3, .compact = compact};
      compareHits(hitsOf(*makeStreamingEngine(device, model, settings), rays), hits);
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
  for (const Machine machine : {Machine::Branching, Machine::Multipass}) {
    const std::vector<Hit> hits = hitsOf(*makeStreamingEngine(device, model, {.machine = machine}), rays);
    CHECK(hits.size() == rays.size());
  }
}

}  // namespace
}  // namespace rays
