// SPDX-License-Identifier: MIT
//
// Rays and triangles that break tests which are nearly right: grazing rays, slivers, copies, meshes far away, directions with zeros.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "bvh_engine.hpp"
#include "scene_shapes.hpp"
#include "scenes_test.hpp"
#include "shapes.hpp"
#include "study.hpp"
#include "support/testing.hpp"

namespace rays {
namespace {

using examples::vecOf;

constexpr std::array ways = {HowToTraverse::Stack, HowToTraverse::Leaves, HowToTraverse::Skip};

std::vector<Hit> hitsOf(sk::Device& device, const Model& model, const std::vector<Ray>& rays,
                        HowToTraverse way = HowToTraverse::Stack) {
  return traceRays(*makeBvhEngine(device, model, {.traversal = way}), model, rays);
}

/// The model of a mesh whose points are changed first.
template <class Change>
Model modelOf(Mesh mesh, const Change& change) {
  for (Vector& p : mesh.points) p = change(p);
  Model model = rays::modelOf(mesh);
  return model;
}

/// In the engine's lengths, as scenes have it.
Model inUnits(Model model) {
  chooseUnit(model);
  return model;
}

/// Needles that meet in two points; the edge between them rises and falls by `wave`.
Mesh bipyramid(std::uint32_t sides, double wave) {
  Mesh mesh;
  mesh.points = {{0.01, 0.5, 0.003}, {-0.02, -0.5, 0.01}};
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    mesh.points.push_back({0.5 * std::cos(angle), wave * std::sin(3 * angle), 0.5 * std::sin(angle)});
    const std::uint32_t next = 2 + (i + 1) % sides;
    mesh.faces.push_back({.points = {0, 2 + i, next}});
    mesh.faces.push_back({.points = {1, next, 2 + i}});
  }
  return mesh;
}

using Quad = __float128;

/// The distance of the nearest triangle that the ray meets, edges and vertices included, by exact signs: products of three floats, of exponents that
/// are not far apart, fit in 113 bits. Infinite where there is none.
double exactDistance(const Model& model, const Ray& ray) {
  const auto exact = [](const sk::float3& v) { return examples::Vec<Quad>{v.x, v.y, v.z}; };
  const auto o = exact(ray.origin), d = exact(ray.direction);
  double nearest = HUGE_VAL;
  for (const Triangle& t : model.triangles) {
    const auto a = exact(t.a) - o, b = exact(t.b) - o, c = exact(t.c) - o;
    const Quad u = dot(d, cross(c, b)), v = dot(d, cross(a, c)), w = dot(d, cross(b, a));
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) continue;
    const auto n = cross(b - a, c - a);
    const Quad across = dot(n, d);
    if (across == 0) continue;
    const Quad distance = dot(n, a) / across;
    if (distance >= 0) nearest = std::min(nearest, static_cast<double>(distance));
  }
  return nearest;
}

TEST_CASE("rays at edges and vertices hit where loops with exact signs do") {
  sk::Device device = sk::Device::native();
  for (const Mesh& mesh : {icosphere(1, false), box()}) {
    for (const Vector& moved : {Vector{0, 0, 0}, Vector{1024, -512, 256}}) {
      const Model model = rays::modelOf(mesh, moved);
      const std::vector<Ray> rays = raysToEdges(model, moved, 2000, 23);
      const std::vector<Hit> hits = hitsOf(device, inUnits(model), rays);
      double worst = 0.0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const double expected = exactDistance(model, rays[i]);
        if (hits[i].id < 0 && std::isfinite(expected)) worst = HUGE_VAL;
        if (std::isfinite(expected))
          worst = std::max(worst, std::abs(hits[i].t - expected) / (1 + length(moved)));
      }
      CHECK(worst < 0x1p-20);
    }
  }
}

TEST_CASE("grazing rays, to a millionth of a radian, stay on their side of a wall and find it") {
  sk::Device device = sk::Device::native();
  std::mt19937 random(29);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Model model = rays::modelOf(box());
  // Inside the box, beside its top: a ray that rises meets the top or, before, a wall; no ray leaves.
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    const double angle = std::pow(10.0, -1 - 5 * (i % 100) / 99.0) * (i % 2 == 0 ? 1 : -1);
    const double around = std::numbers::pi * uniform(random), beside = std::ldexp(0.25, -(i % 23));
    Vector from = {0.4 * uniform(random), 0.5 - beside, 0.4 * uniform(random)};
    Vector along = {std::cos(around), std::sin(angle), std::sin(around)};
    for (int turn = i % 3; turn > 0; --turn) {
      from = {from.z, from.x, from.y};
      along = {along.z, along.x, along.y};
    }
    rays.push_back({.origin = toFloat3(from), .direction = toFloat3(along)});
  }
  const std::vector<Hit> hits = hitsOf(device, model, rays);
  CHECK(misses(hits) == 0);
  CHECK(largestError(model, rays, hits) < 0x1p-20);
  for (const HowToTraverse way : ways) CHECK(hitsOf(device, model, rays, way) == hits);
}

TEST_CASE("nothing passes between slivers") {
  sk::Device device = sk::Device::native();
  // A ball that is a millionth as thick as it is wide, and a cone of 1,024 needles that meet in two points.
  constexpr float thin = 0x1p-20f;
  const Model ball = rays::modelOf(icosphere(3, false));
  Model flat = ball;
  for (Triangle& t : flat.triangles)
    for (sk::float3* p : {&t.a, &t.b, &t.c}) p->y *= thin;
  std::vector<Ray> rays = raysToEdges(ball, {}, 50'000, 31);
  for (Ray& ray : rays) {
    ray.origin.y *= thin;
    ray.direction.y *= thin;
  }
  for (const HowToTraverse way : ways) CHECK(misses(hitsOf(device, flat, rays, way)) == 0);

  const Model model = rays::modelOf(bipyramid(1024, 0.01));
  for (const HowToTraverse way : ways)
    CHECK(misses(hitsOf(device, model, raysToEdges(model, {}, 10'000, 37), way)) == 0);
}

TEST_CASE("hits of needles keep the bound that grows with their aspect ratio") {
  for (const char* name : {"native", "essl300"}) {
    const bool isNative = name == std::string("native");
    sk::Device device = examples::deviceNamed(name);
    for (const sk::Precision precision : {sk::Precision::Single, sk::Precision::Double}) {
      // The study of needles checks pairs of floats.
      if (!isNative && precision != sk::Precision::Single) continue;
      double plain = 0.0;
      for (const double aspect : {1e1, 1e3, 1e5, 1e7}) {
        CAPTURE(name, static_cast<int>(precision), aspect);
        const Model model = needles(aspect, 50, 5);
        const std::unique_ptr<Engine> engine = makeBvhEngine(device, model, {.precision = precision});
        const TriangleTest test = engine->triangleTest();
        CHECK(test.roundoff <= 0x1p-24);
        const std::vector<Ray> rays = raysToTriangles(model, isNative ? 500 : 200, 61);
        const std::vector<Hit> hits = traceRays(*engine, model, rays);
        double worst = 0.0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
          worst = std::max(worst, errorOf(model, rays[i], hits[i], test));
          plain = std::max(plain, errorOf(model, rays[i], hits[i], {.roundoff = 0.0}));
        }
        CHECK(worst <= 0x1p-20);
      }
      // What all other triangles keep would not do for floats.
      CHECK((plain <= 0x1p-20) == (precision != sk::Precision::Single));
    }
  }
}

TEST_CASE("a scene of needles passes its verification") {
  Model model = inUnits(rays::modelOf(bipyramid(4096, 0.0)));
  model.camera.from = {0.3, 0.4, 2.0};
  sk::Device device = sk::Device::native();
  const std::unique_ptr<Engine> engine = makeBvhEngine(device, model, {});
  CHECK(checkEngine(*engine, engine->model(), 12, 12).passed());
}

TEST_CASE("copies and triangles without an area change no hit") {
  sk::Device device = sk::Device::native();
  const Model model = rays::modelOf(icosphere(3, false));
  Model crowded = model;
  for (std::size_t i = model.triangles.size(); i-- > 0;) {
    Triangle copy = model.triangles[i];
    copy.id = crowded.triangleCount++;
    crowded.triangles.push_back(copy);
    // Along an edge, and a point.
    crowded.triangles.push_back({copy.a, copy.b, copy.b, crowded.triangleCount++, 0});
    crowded.triangles.push_back({copy.c, copy.c, copy.c, crowded.triangleCount++, 0});
  }
  const std::vector<Ray> rays = raysToEdges(model, {}, 20'000, 41);
  const std::vector<Hit> hits = hitsOf(device, model, rays);
  CHECK(misses(hits) == 0);
  for (const HowToTraverse way : ways) CHECK(hitsOf(device, crowded, rays, way) == hits);
}

TEST_CASE("of triangles that overlap in one plane, each may be hit, at one distance") {
  std::mt19937 random(43);
  std::uniform_real_distribution<float> uniform(-1, 1);
  Model model;
  model.materials.push_back({.name = "grey"});
  for (int i = 0; i < 60; ++i) {
    const auto corner = [&] { return sk::float3{uniform(random), 0.25f, uniform(random)}; };
    model.triangles.push_back({corner(), corner(), corner(), model.triangleCount++, 0});
  }
  std::vector<Ray> rays;
  for (int i = 0; i < 3000; ++i) {
    const sk::float3 to = {0.5f * uniform(random), 0.25f, 0.5f * uniform(random)};
    const sk::float3 from = {uniform(random), 1 + uniform(random) / 2, uniform(random)};
    rays.push_back({.origin = from, .direction = {to.x - from.x, to.y - from.y, to.z - from.z}});
  }
  sk::Device native = sk::Device::native();
  const std::vector<Hit> hits = hitsOf(native, model, rays);
  CHECK(rays.size() - misses(hits) > 2500);
  CHECK(largestError(model, rays, hits) < 0x1p-20);
  for (const HowToTraverse way : ways) CHECK(hitsOf(native, model, rays, way) == hits);
}

TEST_CASE("closed meshes stay closed where they are moved far away") {
  sk::Device device = sk::Device::native();
  for (const int power : {10, 16, 22}) {
    INFO("moved by 2^" << power);
    const double by = std::ldexp(1.0, power);
    // So large that a float's last bit there is a small part of it.
    const double size = std::max(1.0, std::ldexp(1.0, power - 14));
    const Vector moved = {by, -by, by};
    const Model model = modelOf(icosphere(3, false), [&](const Vector& p) { return size * p + moved; });
    const std::vector<Ray> rays = raysToEdges(model, moved, 50'000, 47);
    for (const HowToTraverse way : ways) CHECK(misses(hitsOf(device, inUnits(model), rays, way)) == 0);
  }
}

TEST_CASE("directions with zeros of either sign, of any length and of denormal components find the wall") {
  const std::vector<float> components = {0.0f, -0.0f, 1.0f, -1.0f, 1e-40f, -1e-45f, 0x1p-90f, 0.3f};
  std::vector<Ray> rays, positive;
  for (const float x : components) {
    for (const float y : components) {
      for (const float z : components) {
        if (x == 0 && y == 0 && z == 0) continue;
        for (const double longer : {1.0, 0x1p+60, 0x1p-60}) {
          const auto by = [&](float c) { return static_cast<float>(c * longer); };
          if (by(x) == 0 && by(y) == 0 && by(z) == 0) continue;
          for (const sk::float3& from :
               {sk::float3{0, 0, 0}, sk::float3{0.25f, -0.0f, 0.125f}, sk::float3{0.5f, 0, 0.125f}}) {
            // Outwards from the wall, at a distance that may round to less than 0, there may be nothing.
            if (from.x == 0.5f && x > 0) continue;
            rays.push_back({.origin = from, .direction = {by(x), by(y), by(z)}});
            positive.push_back({.origin = from, .direction = {by(x) + 0.0f, by(y) + 0.0f, by(z) + 0.0f}});
          }
        }
      }
    }
  }
  const Model model = rays::modelOf(box());
  for (const char* name : {"native", "glsl330"}) {
    INFO(name);
    sk::Device device = examples::deviceNamed(name);
    const std::vector<Hit> hits = hitsOf(device, model, rays);
    CHECK(misses(hits) == 0);
    CHECK(hitsOf(device, model, positive) == hits);
    // The end of the ray is on the wall.
    double worst = 0.0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      // The distance in units of a denormal direction may exceed every float.
      if (std::isinf(hits[i].t) && length(vecOf<double>(rays[i].direction)) < 0x1p-126) continue;
      const auto p = vecOf<double>(rays[i].origin) + double(hits[i].t) * vecOf<double>(rays[i].direction);
      worst = std::max(worst, std::abs(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) - 0.5));
    }
    CHECK(worst < 0x1p-20);
  }
}

TEST_CASE("distances in doubles are right to the last bit of a float") {
  const Model model = rays::modelOf(icosphere(2, false));
  const std::vector<Ray> rays = raysToEdges(model, {}, 2000, 59);
  for (const char* name : {"native", "glsl330"}) {
    sk::Device device = examples::deviceNamed(name);
    const std::vector<Hit> hits =
        traceRays(*makeBvhEngine(device, model, {.precision = sk::Precision::Double}), model, rays);
    double worst = 0.0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      REQUIRE(hits[i].id >= 0);
      const double t = meet(model.triangles[static_cast<std::size_t>(hits[i].id)], rays[i]).t;
      worst = std::max(worst, std::abs(hits[i].t - t) / t);
    }
    CHECK(worst < 0x1.01p-24);
  }
}

TEST_CASE("rays from points of surfaces leave on the side to which they go") {
  // From hits on a ball, a thousandth of its radius beside them at most: outwards nothing is met, inwards the other side.
  sk::Device device = sk::Device::native();
  const Model model = rays::modelOf(icosphere(4, false));
  std::vector<Ray> rays = raysToEdges(model, {}, 20'000, 53);
  const std::vector<Hit> hits = hitsOf(device, model, rays);
  std::vector<Ray> outwards, inwards;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Triangle& t = model.triangles[static_cast<std::size_t>(hits[i].id)];
    const double u = hits[i].u, v = hits[i].v;
    const Vector a = vecOf<double>(t.a), b = vecOf<double>(t.b), c = vecOf<double>(t.c);
    const Vector n = normalized(cross(b - a, c - a));
    // As leaving() of lights.sk has it.
    const Vector point = (1 - u - v) * a + u * b + v * c;
    const auto from = [&](double side) { return toFloat3(point + side * 0x1p-20 * 0.5 * n); };
    const Vector aside = normalized(cross(n, Vector{0.3, 0.5, -0.7}));
    for (const double rise : {1.0, 1e-2, 1e-4}) {
      outwards.push_back({.origin = from(1), .direction = toFloat3(normalized(aside + rise * n))});
      inwards.push_back({.origin = from(-1), .direction = toFloat3(normalized(aside - rise * n))});
    }
  }
  CHECK(misses(hitsOf(device, model, outwards)) == outwards.size());
  CHECK(misses(hitsOf(device, model, inwards)) == 0);
}

}  // namespace
}  // namespace rays
