// SPDX-License-Identifier: MIT
//
// Nodes of eight children, rays that are sorted, and paths by queues: all of them change the time alone.
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "bvh.hpp"
#include "bvh_engine.hpp"
#include "scenes_test.hpp"
#include "shapes.hpp"
#include "study.hpp"

namespace rays {
namespace {

std::vector<Hit> closestBy(sk::Device& device, const Model& model, const std::vector<Ray>& rays,
                           const DeviceSettings& settings) {
  return hitsOf(*makeBvhEngine(device, model, settings), rays);
}

std::vector<std::uint8_t> occludedBy(sk::Device& device, const Model& model, const std::vector<Ray>& rays,
                                     const DeviceSettings& settings) {
  return shadowsOf(*makeBvhEngine(device, model, settings), rays);
}

float floatOf(std::int32_t bits) { return std::bit_cast<float>(bits); }

/// A child's box as kernels decode it, exactly.
struct DecodedBox {
  double low[3], high[3];
};

DecodedBox boxOf(const WideBvh& wide, std::size_t node, std::size_t slot) {
  const sk::int4* n = &wide.nodes[4 * node];
  const std::int32_t rows[6][2] = {{n[1].x, n[1].y}, {n[1].z, n[1].w}, {n[2].x, n[2].y},
                                   {n[2].z, n[2].w}, {n[3].x, n[3].y}, {n[3].z, n[3].w}};
  const float origin[3] = {floatOf(n[0].x), floatOf(n[0].y), floatOf(n[0].z)};
  DecodedBox box{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double step = std::ldexp(1.0, (n[0].w >> (8 * axis) & 255) - 127);
    const auto at = [&](std::size_t row) {
      return origin[axis] + step * (rows[row][slot / 4] >> (8 * (slot % 4)) & 255);
    };
    box.low[axis] = at(axis);
    box.high[axis] = at(axis + 3);
  }
  return box;
}

TEST_CASE("nodes of eight hold every shape once, in boxes that leave room for roundings") {
  for (const int leaf : {1, 4}) {
    for (const float aside : {0.0f, 4194304.0f}) {
      Model model = soup({.triangles = 700, .spheres = 40});
      for (Triangle& t : model.triangles)
        for (sk::float3* p : {&t.a, &t.b, &t.c}) p->x += aside;
      const Bvh bvh = buildBvh(model.triangles, model.spheres, {.leaf = leaf});
      const WideBvh wide = widen(bvh);
      REQUIRE(wide.children.size() == wideChildren * wide.size());
      std::vector<int> seen(bvh.order.size()), entered(wide.size());
      std::size_t outside = 0;
      for (std::size_t node = 0; node < wide.size(); ++node) {
        for (std::size_t slot = 0; slot < wideChildren; ++slot) {
          const std::int32_t child = wide.children[wideChildren * node + slot];
          const DecodedBox box = boxOf(wide, node, slot);
          if (child >= 0) {
            ++entered[static_cast<std::size_t>(child)];
            for (std::size_t below = 0; below < wideChildren; ++below) {
              if (wide.children[wideChildren * static_cast<std::size_t>(child) + below] == -8) continue;
              const DecodedBox inner = boxOf(wide, static_cast<std::size_t>(child), below);
              // Boxes of bytes may reach out of their parent's, but not by more than a few of its own steps.
              for (std::size_t axis = 0; axis < 3; ++axis)
                outside += inner.high[axis] < box.low[axis] || inner.low[axis] > box.high[axis];
            }
          }
          const std::int32_t leafOf = child < 0 ? -child : 0;
          for (std::int32_t i = leafOf >> 3; i < (leafOf >> 3) + (leafOf & 7); ++i) {
            const std::uint32_t shape = bvh.order[static_cast<std::size_t>(i)];
            ++seen[static_cast<std::size_t>(i)];
            const Bounds b = shape < model.triangles.size()
                                 ? boundsOf(model.triangles[shape])
                                 : boundsOf(model.spheres[shape - model.triangles.size()]);
            const float low[3] = {b.least.x, b.least.y, b.least.z}, high[3] = {b.most.x, b.most.y, b.most.z};
            for (std::size_t axis = 0; axis < 3; ++axis) {
              const double room =
                  255 * 0x1p-21 * std::ldexp(1.0, (wide.nodes[4 * node].w >> (8 * axis) & 255) - 127);
              outside += box.low[axis] > low[axis] - room || box.high[axis] < high[axis] + room;
            }
          }
        }
      }
      CHECK(outside == 0);
      CHECK(seen == std::vector<int>(seen.size(), 1));
      std::vector<int> once(wide.size(), 1);
      once[0] = 0;
      CHECK(entered == once);
    }
  }
}

TEST_CASE("nodes of eight and sorted rays change no bit of a hit") {
  const std::vector<Ray> rays = raysAtRandom(1500);
  sk::Device native = sk::Device::native();
  const DeviceSettings pairs{.traversal = HowToTraverse::Stack, .nodes = 2};
  for (const SoupSize& size : {SoupSize{}, SoupSize{1, 0, 0}, SoupSize{0, 3, 2}}) {
    const Model model = soup(size);
    const std::vector<Hit> expected = closestBy(native, model, rays, pairs);
    const std::vector<std::uint8_t> shadows = occludedBy(native, model, rays, pairs);
    for (const HowToTraverse way : {HowToTraverse::Stack, HowToTraverse::Leaves}) {
      CHECK(closestBy(native, model, rays, {.traversal = way, .nodes = 8}) == expected);
      CHECK(occludedBy(native, model, rays, {.traversal = way, .nodes = 8}) == shadows);
    }
    CHECK(closestBy(native, model, rays, {.sort = RaySort::Origin}) == expected);
    CHECK(closestBy(native, model, rays, {.sort = RaySort::Direction}) == expected);
  }
  sk::Device gl = examples::deviceNamed("glsl430");
  const Model model = soup({});
  const std::vector<Hit> expected = closestBy(gl, model, rays, {.nodes = 2});
  CHECK(closestBy(gl, model, rays, {.nodes = 8, .sort = RaySort::Direction}) == expected);
}

TEST_CASE("rays from far away find through nodes of eight what they find through pairs") {
  sk::Device device = sk::Device::native();
  const Model model = modelOf(icosphere(3, false));
  std::vector<Ray> rays;
  for (int i = 0; i < 2000; ++i) {
    const float far = std::ldexp(1.0f, i % 50), angle = 0.01f * float(i);
    rays.push_back({.origin = {far * std::cos(angle), 0.01f * float(i % 40), far * std::sin(angle)},
                    .direction = {-std::cos(angle), 0, -std::sin(angle)}});
  }
  CHECK(closestBy(device, model, rays, {.nodes = 8}) == closestBy(device, model, rays, {.nodes = 2}));
}

TEST_CASE(
    "paths by queues make the picture of paths by one kernel, to the bit where no product is contracted") {
  const std::string scene = R"(
[picture]
size = [24, 16]
samples = 2
[camera]
from = [0, 1, 3]
to = [0, 0, 0]
[environment]
colour = [1, 0.5, 0.25]
[[light]]
position = [1, 3, 2]
intensity = [9, 9, 9]
[[material]]
name = "grey"
[[material]]
name = "glass"
type = "glass"
[[material]]
name = "metal"
type = "metal"
[[mesh]]
shape = "torus"
material = "metal"
[[sphere]]
radius = 0.3
material = "glass"
[[plane]]
through = [0, -0.3, 0]
material = "grey"
)";
  const auto imageBy = [](sk::Device& device, const std::string& of, const std::string& settings) {
    return pictureBy(device, of + "[bvh]\n" + settings, "bvh", 2);
  };
  sk::Device native = sk::Device::native();
  const std::vector<float> expected = imageBy(native, scene, "machine = \"megakernel\"\n");
  CHECK(imageBy(native, scene, "machine = \"wavefront\"\n") == expected);
  CHECK(imageBy(native, scene, "machine = \"wavefront\"\nsort = \"direction\"\nnodes = 2\n") == expected);
  // Queues do not know materials, which take seconds to compile there.
  std::string grey = scene;
  for (const std::string type : {"type = \"glass\"\n", "type = \"metal\"\n"})
    grey.erase(grey.find(type), type.size());
  const std::vector<float> greyByOne = imageBy(native, grey, "machine = \"megakernel\"\n");
  sk::Device gl = examples::deviceNamed("glsl430");
  const std::vector<float> greyByQueues = imageBy(gl, grey, "machine = \"wavefront\"\n");
  double sum = 0.0, difference = 0.0;
  for (std::size_t i = 0; i < greyByOne.size(); ++i) {
    sum += double(greyByOne[i]);
    difference += double(greyByQueues[i]) - double(greyByOne[i]);
  }
  // Roundings send a few of the 768 paths another way.
  CHECK(std::abs(difference) < 0.01 * sum);
}

}  // namespace
}  // namespace rays
