// SPDX-License-Identifier: MIT
//
// Hits against loops in double precision, and rays at edges and vertices, where a ray could slip through.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bvh.hpp"
#include "scenes_test.hpp"
#include "shapes.hpp"
#include "study.hpp"
#include "support/testing.hpp"

namespace rays {
namespace {

std::vector<Ray> randomRays(std::size_t count, std::mt19937& random) {
  std::normal_distribution<float> normal;
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector direction = normalized(Vector{normal(random), normal(random), normal(random)});
    rays.push_back(
        {.origin = {normal(random), normal(random), normal(random)}, .direction = toFloat3(direction)});
    if (i % 4 == 1) rays.back().most = 0.7f;
    if (i % 4 == 2) rays.back().least = 0.4f;
  }
  return rays;
}

std::size_t differences(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  std::size_t differ = 0;
  for (std::size_t i = 0; i < a.size(); ++i) differ += a[i] != b[i];
  return differ;
}

std::size_t leaks(Engine& engine, const Model& model, const std::vector<Ray>& rays) {
  return misses(traceRays(engine, model, rays));
}

/// The hits of an engine, which the tests for shadows must agree with.
std::vector<Hit> checkedHits(Engine& engine, const std::vector<Ray>& rays) {
  const std::vector<Hit> hits = hitsOf(engine, rays);
  const std::vector<std::uint8_t> blocked = shadowsOf(engine, rays);
  std::size_t differ = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) differ += (blocked[i] != 0) != (hits[i].id >= 0);
  CHECK(differ == 0);
  return hits;
}

TEST_CASE("hits are those of loops in double precision, on every device and by every way through the boxes") {
  std::mt19937 random(5);
  const Model model = modelOf(torus(24, 12, 0.2));
  const std::vector<Ray> rays = randomRays(3000, random);
  sk::Device device = sk::Device::native();
  std::vector<Hit> native;
  // A way is one body in GLSL and takes a second to compile, so that each is on one profile; the default way is on all of them, in
  // the tests below. Drawn and dispatched programs, and those of OpenGL ES, have ways of both kinds of nodes, or of the deepest loops.
  struct Way {
    const char *profile, *settings;
  };
  for (const Way& way : {Way{"glsl330", "traversal = \"leaves\"\n"},
                         {"essl300", "nodes = 8\ntraversal = \"leaves\"\nleaf = 1\n"},
                         {"glsl330", "nodes = 8\ntraversal = \"stack\"\n"},
                         {"glsl430", "traversal = \"stack\"\n"},
                         {"essl300", "traversal = \"skip\"\nleaf = 1\n"}}) {
    INFO(way.profile << ": " << way.settings);
    const std::vector<Hit> hits = checkedHits(*engineOf(device, model, way.settings), rays);
    CHECK(largestError(model, rays, hits) < 0x1p-20);
    if (native.empty()) native = hits;
    CHECK(differences(hits, native) == 0);
    sk::Device gl = examples::deviceNamed(way.profile);
    CHECK(differences(checkedHits(*engineOf(gl, model, way.settings), rays), native) == 0);
  }
  CHECK(largestError(model, rays, hitsOf(*engineOf(device, model, "intersection = \"moller\"\n"), rays)) <
        0x1p-20);
}

TEST_CASE("no ray passes between triangles that share an edge or a vertex") {
  sk::Device device = sk::Device::native();
  for (const Mesh& mesh : {icosphere(4, false), box()}) {
    const Model model = modelOf(mesh);
    const std::unique_ptr<Engine> engine = engineOf(device, model);
    CHECK(leaks(*engine, model, raysToEdges(model, {}, 500'000, 11)) == 0);
  }
  for (const char* name : {"glsl330", "essl300", "glsl430"}) {
    INFO(name);
    sk::Device gl = examples::deviceNamed(name);
    const Model model = modelOf(icosphere(2, false));
    CHECK(leaks(*engineOf(gl, model), model, raysToEdges(model, {}, 20'000, 11)) == 0);
  }
}

TEST_CASE("the test of 1997 leaks, so that the rays above are the right ones") {
  sk::Device device = sk::Device::native();
  const Model model = modelOf(icosphere(4, false));
  CHECK(leaks(*engineOf(device, model, "intersection = \"moller\"\n"), model,
              raysToEdges(model, {}, 100'000, 11)) > 0);
}

TEST_CASE("scenes of any size have the same hits, and directions of any length") {
  sk::Device device = sk::Device::native();
  const std::string mesh = "[[mesh]]\nshape = \"torus\"\naround = 12\nacross = 8\nscale = [";
  std::mt19937 random(3);
  const std::vector<Ray> rays = randomRays(2000, random);
  std::vector<Hit> expected;
  for (const int exponent : {0, -50, 50}) {
    const double size = std::ldexp(1.0, exponent);
    const Scene scene = sceneFrom(fmt::format("{}{:.20g}]\n", mesh, size));
    std::vector<Ray> scaled = rays;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto by = [](sk::float3 v, double s) {
        return sk::float3{float(v.x * s), float(v.y * s), float(v.z * s)};
      };
      const double longer = i % 3 == 0 ? 0x1p+40 : i % 3 == 1 ? 0x1p-60 : 1.0;
      scaled[i] = {by(rays[i].origin, size), float(rays[i].least * size / longer),
                   by(rays[i].direction, longer), float(rays[i].most * size / longer)};
    }
    std::vector<Hit> hits = traceRays(*engineOf(device, scene.model), scene.model, scaled);
    for (std::size_t i = 0; i < hits.size(); ++i)
      hits[i].t = static_cast<float>(double(hits[i].t) / size *
                                     (i % 3 == 0   ? 0x1p+40
                                      : i % 3 == 1 ? 0x1p-60
                                                   : 1.0));
    if (expected.empty()) expected = hits;
    CHECK(differences(hits, expected) == 0);
  }
}

TEST_CASE("rays in the planes of faces, along edges and with zeros of both signs end as they must") {
  sk::Device device = sk::Device::native();
  const Model model = modelOf(box());
  const std::unique_ptr<Engine> engine = engineOf(device, model);
  const std::vector<Ray> rays = {{.origin = {0, 0, 2}, .direction = {0, 0, -1}},
                                 {.origin = {0, 0, 2}, .direction = {-0.0f, -0.0f, -1}},
                                 {.origin = {0.5f, 0.5f, 2}, .direction = {0, 0, -1}},
                                 {.origin = {0.5f, 0, 2}, .direction = {0, -0.0f, -1}},
                                 {.origin = {0.5000001f, 0, 2}, .direction = {0, 0, -1}},
                                 {.origin = {0, 0, 0.5f}, .direction = {0, 0, 1}},
                                 {.origin = {0, 0, 0.5000001f}, .direction = {0, 0, 1}},
                                 {.origin = {0, 0, 4194304}, .direction = {1e-9f, 0, -1}}};
  const std::vector<Hit> hits = hitsOf(*engine, rays);
  CHECK(hits[0].t == 1.5f);
  CHECK(hits[1] == hits[0]);
  CHECK(hits[2].t == 1.5f);
  CHECK(hits[3].t == 1.5f);
  CHECK(hits[4].id == -1);
  CHECK(hits[5].t == 0.0f);
  CHECK(hits[6].id == -1);
  CHECK(hits[7].t == 4194303.5f);
}

TEST_CASE("of hits at one distance the least id is taken, and triangles without an area are never hit") {
  Model model;
  const Triangle triangle{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, 0, 0};
  for (const std::int32_t id : {5, 2, 9}) {
    model.triangles.push_back(triangle);
    model.triangles.back().id = id;
  }
  model.triangles.push_back({{-1, 0, 0.5f}, {1, 0, 0.5f}, {0.5f, 0, 0.5f}, 10, 0});
  model.triangles.push_back({{0, 0, 0.5f}, {0, 0, 0.5f}, {0, 0, 0.5f}, 11, 0});
  model.triangleCount = 12;
  sk::Device device = sk::Device::native();
  for (const char* settings : {"", "leaf = 1\ntraversal = \"skip\"\n"}) {
    std::vector<Hit> hits(1);
    engineOf(device, model, settings)
        ->closest(std::vector{Ray{.origin = {0, 0, 1}, .direction = {0, 0, -1}}}, hits);
    CHECK(hits[0].id == 2);
    CHECK(hits[0].t == 1.0f);
  }
}

TEST_CASE("spheres and planes are hit where they are") {
  Model model;
  model.spheres = {{{0, 0, 0}, 0.5f, 0}, {{0, 0, -1000}, 1.0f, 0}};
  model.planes = {{{0, 1, 0}, -0.5f, 0}};
  sk::Device device = sk::Device::native();
  const std::unique_ptr<Engine> engine = engineOf(device, model);
  const std::vector<Ray> rays = {{.origin = {0, 0, 2}, .direction = {0, 0, -1}},
                                 {.origin = {0, 0, 0}, .direction = {1, 0, 0}},
                                 {.origin = {3, 0, 0}, .direction = {0, -1, 0}},
                                 {.origin = {0.9999f, 0, 1000}, .direction = {0, 0, -1}},
                                 {.origin = {0, 2, 0}, .direction = {1, 0, 0}}};
  const std::vector<Hit> hits = hitsOf(*engine, rays);
  CHECK(hits[0] == Hit{0, 1.5f, 0.75f, 0.5f});
  CHECK(hits[1].t == 0.5f);
  CHECK(hits[2] == Hit{2, 0.5f, 0, 0});
  CHECK(hits[3].id == 1);
  CHECK(hits[3].t == Approx(2000.0 - std::sqrt(1 - 0.9999 * 0.9999)).epsilon(1e-7));
  CHECK(hits[4].id == -1);
}

TEST_CASE("a scene with nothing in it has no hits") {
  Model model;
  sk::Device device = sk::Device::native();
  const std::unique_ptr<Engine> engine = engineOf(device, model);
  std::vector<Hit> hits(3);
  engine->closest(std::vector<Ray>(3, {.direction = {0, 0, 1}}), hits);
  CHECK(hits == std::vector<Hit>(3));
  engine->closest({}, {});
}

TEST_CASE("the tree holds every shape once, and is never deeper than the stack") {
  Model model;
  // Each box holds all that follow: the worst case for splits by surface.
  for (int i = 0; i < 3000; ++i) {
    const float s = std::ldexp(1.0f, -i / 30);
    model.triangles.push_back({{0, 0, 0}, {s, 0, 0}, {0, s, s}, i, 0});
  }
  for (const int leaf : {1, 4}) {
    const Bvh bvh = buildBvh(model.triangles, model.spheres, {.leaf = leaf});
    CHECK(bvh.depth <= deepestBvh);
    std::vector<int> seen(model.triangles.size());
    for (const BvhNode& node : bvh.nodes) {
      CHECK(node.count <= static_cast<std::uint32_t>(leaf));
      for (std::uint32_t i = node.first; node.count > 0 && i < node.first + node.count; ++i)
        ++seen[bvh.order[i]];
    }
    CHECK(seen == std::vector<int>(seen.size(), 1));
    CHECK(skipLayout(bvh).size() == 16 * bvh.nodes.size());
  }
}

}  // namespace
}  // namespace rays
