// SPDX-License-Identifier: MIT
#include "study.hpp"

#include <array>
#include <ctime>
#include <random>

#include "support/stopwatch.hpp"

namespace rays {

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

double callMilliseconds(bool isProcessor, const std::function<void()>& call) {
  const examples::Stopwatch stopwatch;
  const std::clock_t start = std::clock();
  call();
  return isProcessor ? 1e3 * double(std::clock() - start) / CLOCKS_PER_SEC : stopwatch.milliseconds();
}

}  // namespace rays
