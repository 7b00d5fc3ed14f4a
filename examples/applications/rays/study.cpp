// SPDX-License-Identifier: MIT
#include "study.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include "mesh.hpp"
#include "shapes.hpp"

namespace rays {
namespace {

using examples::vecOf;

void add(Model& model, const Mesh& mesh, const Vector& scale, const Vector& at) {
  for (const Face& face : mesh.faces) {
    const auto point = [&](std::size_t i) {
      const Vector p = mesh.points[face.points[i]];
      return toFloat3(Vector{scale.x * p.x, scale.y * p.y, scale.z * p.z} + at);
    };
    model.triangles.push_back({point(0), point(1), point(2), model.triangleCount++, 0});
  }
}

/// A sum of waves that go in different directions, from -1 to 1.
double waves(const Vector& p, double frequency) {
  return (std::sin(frequency * p.x + 1.3 * std::sin(frequency * p.y)) +
          std::sin(frequency * p.y + 0.7 * frequency * p.z) +
          std::sin(1.1 * frequency * p.z - 0.4 * frequency * p.x)) /
         3;
}

/// Moves each point away from the middle, or back.
Mesh withBumps(Mesh mesh, double height, double frequency) {
  for (Vector& p : mesh.points)
    p = (1 + height * waves(p, frequency) + 0.3 * height * waves(p, 4.3 * frequency)) * p;
  return mesh;
}

}  // namespace

Model modelOf(const Mesh& mesh, Vector moved) {
  Model model;
  for (const Face& face : mesh.faces) {
    const auto point = [&](std::size_t i) { return toFloat3(mesh.points[face.points[i]] + moved); };
    model.triangles.push_back({point(0), point(1), point(2), model.triangleCount++, 0});
  }
  model.materials.push_back({.name = "grey"});
  return model;
}

Model needles(double aspect, std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return normalized(Vector{normal(random), normal(random), normal(random)}); };
  Mesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector from = 0.4 * direction(), along = direction();
    const Vector across = normalized(cross(along, direction()));
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.push_back(from);
    mesh.points.push_back(from + along);
    mesh.points.push_back(from + (i % 3 == 0 ? 1.0 : 0.4) * along + (1.0 / aspect) * across);
    mesh.faces.push_back({.points = {first, first + 1, first + 2}});
  }
  return modelOf(mesh);
}

std::vector<Ray> raysToTriangles(const Model& model, std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle& t = model.triangles[random() % model.triangles.size()];
    double u = uniform(random), v = uniform(random);
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    const Vector at = (1.0 - u - v) * examples::vecOf<double>(t.a) + u * examples::vecOf<double>(t.b) +
                      v * examples::vecOf<double>(t.c);
    const Vector from =
        (i % 2 == 0 ? 2.0 : 0.1) * normalized(Vector{normal(random), normal(random), normal(random)});
    rays.push_back({.origin = toFloat3(from), .direction = toFloat3(normalized(at - from))});
  }
  return rays;
}

std::vector<Ray> raysToEdges(const Model& model, Vector moved, std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Ray> rays;
  rays.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle& t = model.triangles[random() % model.triangles.size()];
    const std::array<sk::float3, 3> corners = {t.a, t.b, t.c};
    const auto a = examples::vecOf<double>(corners[i % 3]), b = examples::vecOf<double>(corners[(i + 1) % 3]);
    const double along = i % 4 == 0 ? 0.0 : i % 4 == 1 ? 0.5 : 0.5 + 0.5 * uniform(random);
    const Vector aside = 0.05 * Vector{uniform(random), uniform(random), uniform(random)};
    const sk::float3 from = toFloat3(i % 5 == 0 ? moved : moved + aside), to = toFloat3(a + along * (b - a));
    rays.push_back({.origin = from, .direction = {to.x - from.x, to.y - from.y, to.z - from.z}});
  }
  return rays;
}

Model interior(bool isSmall) {
  Model model;
  model.materials.push_back({.name = "grey"});
  add(model, box(), {4.0, 1.2, 2.0}, {0, 0.6, 0});
  const Mesh vase = withBumps(icosphere(isSmall ? 2 : 4, false), 0.25, 9);
  const Mesh ring = torus(isSmall ? 12 : 40, isSmall ? 8 : 30, 0.2);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 40; ++i) {
    const double x = -1.8 + 0.4 * (i % 10), z = -0.75 + 0.5 * double(i / 10),
                 tall = 0.15 + 0.2 * uniform(random);
    add(model, box(), {0.16, tall, 0.16}, {x, 0.5 * tall, z});
    add(model, vase, {0.2, 0.3, 0.2}, {x, tall + 0.15, z});
    add(model, ring, {0.3, 0.2 + 0.2 * uniform(random), 0.3},
        {x + 0.1, 0.9 + 0.1 * uniform(random), z + 0.1});
  }
  model.camera.from = {-1.7, 0.75, 0.9};
  model.camera.to = {0.6, 0.35, -0.4};
  model.camera.fieldOfView = 65.0;
  return model;
}

Model organic(bool isSmall) {
  Model model;
  model.materials.push_back({.name = "grey"});
  Mesh mesh = isSmall ? torus(30, 20, 0.17) : torus(250, 140, 0.17);
  for (Vector& p : mesh.points) {
    const double around = std::atan2(p.z, p.x);
    p.y += 0.08 * std::sin(3 * around);
    p = p + 0.02 * waves(p, 12) * normalized(p) + 0.006 * waves(p, 70) * normalized(p);
  }
  add(model, mesh, {1, 1, 1}, {});
  model.camera.from = {0.55, 0.75, 0.85};
  model.camera.fieldOfView = 42.0;
  return model;
}

std::vector<Ray> diffuseRays(const Model& model, std::span<const Ray> rays, std::span<const Hit> hits,
                             std::size_t count) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  if (std::ranges::all_of(hits, [](const Hit& hit) { return hit.id < 0; }))
    throw std::logic_error("no ray hits anything");
  std::vector<Ray> next;
  for (std::size_t i = 0; next.size() < count; i = (i + 1) % rays.size()) {
    if (hits[i].id < 0) continue;
    const Triangle& t = model.triangles[static_cast<std::size_t>(hits[i].id)];
    const auto a = vecOf<double>(t.a), d = vecOf<double>(rays[i].direction);
    Vector n = normalized(cross(vecOf<double>(t.b) - a, vecOf<double>(t.c) - a));
    if (dot(n, d) > 0) n = -1.0 * n;
    const Vector point = vecOf<double>(rays[i].origin) + double(hits[i].t) * d + 1e-5 * n;
    const Vector anywhere = normalized(Vector{normal(random), normal(random), normal(random)});
    next.push_back({.origin = toFloat3(point), .direction = toFloat3(normalized(n + 0.999 * anywhere))});
  }
  return next;
}

}  // namespace rays
