// SPDX-License-Identifier: MIT
#include "support/triangulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>

#include <catch2/catch.hpp>

namespace examples {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;
using Polygon = std::vector<Vector>;

Triangles trianglesOf(const Polygon& polygon) {
  Triangles triangles;
  triangulate(polygon, triangles);
  return triangles;
}

/// The area of the polygon, if its triangles have its orientation and together its area; -1 if not.
double areaOf(const Polygon& polygon) {
  const Triangles triangles = trianglesOf(polygon);
  Vector normal;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    normal += 0.5 * cross(polygon[i] - polygon[0], polygon[(i + 1) % polygon.size()] - polygon[0]);
  double sum = 0.0;
  bool areTurned = triangles.size() + 2 != polygon.size();
  for (const auto& [a, b, c] : triangles) {
    const Vector n = 0.5 * cross(polygon[b] - polygon[a], polygon[c] - polygon[a]);
    sum += length(n);
    areTurned = areTurned || dot(n, normal) < -1e-9 * dot(normal, normal);
  }
  return !areTurned && std::abs(sum - length(normal)) <= 1e-9 * sum ? sum : -1.0;
}

/// The area of every polygon that starts at another corner, runs in the other direction, and lies in another plane; -1 if they differ.
double areaOfAll(Polygon polygon) {
  const double area = areaOf(polygon);
  for (int plane = 0; plane < 3; ++plane) {
    for (const bool isReversed : {false, true}) {
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        std::ranges::rotate(polygon, polygon.begin() + 1);
        if (std::abs(areaOf(polygon) - area) > 1e-9 * area) return -1.0;
      }
      if (!isReversed) std::ranges::reverse(polygon);
    }
    for (Vector& p : polygon) p = {p.y, p.z, p.x};
  }
  return area;
}

TEST_CASE("polygons are cut inside, whichever corner comes first") {
  CHECK(areaOfAll({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}) == Approx(1));
  CHECK(areaOfAll({{0, 10, 0}, {-1, 0, 0}, {0, 1, 0}, {1, 0, 0}}) == Approx(9));  // a dart
  CHECK(areaOfAll({{3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}, {0, 0, 0}}) == Approx(5));  // an L
  CHECK(areaOfAll({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}}) ==
        Approx(4));  // corners in one line
  CHECK(areaOfAll({{0, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}) == Approx(4));  // a corner twice
  // A square with a square hole, which a cut to the outside joins with it.
  CHECK(areaOfAll({{0, 0, 0},
                   {3, 0, 0},
                   {3, 3, 0},
                   {0, 3, 0},
                   {0, 0, 0},
                   {1, 1, 0},
                   {1, 2, 0},
                   {2, 2, 0},
                   {2, 1, 0},
                   {1, 1, 0}}) == Approx(8));
}

TEST_CASE("random polygons are cut inside") {
  std::mt19937 random(5);  // the same everywhere
  const auto unit = [&] { return static_cast<double>(random()) / 4294967296.0; };
  for (int i = 0; i < 300; ++i) {
    const std::size_t count = 4 + random() % 30;
    const double scale = std::exp2(static_cast<double>(random() % 200) - 100.0);
    Polygon star, comb;
    for (std::size_t k = 0; k < count; ++k) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count);
      const double radius = scale * (0.1 + unit());
      star.push_back({radius * std::cos(angle), scale * 0.5, radius * std::sin(angle)});
      comb.push_back({scale * static_cast<double>(k), k % 2 == 0 ? 0.0 : scale * unit(), 0.0});
    }
    comb.push_back({scale * static_cast<double>(count), -scale * unit(), 0.0});
    comb.push_back({-scale, -scale * unit(), 0.0});
    CHECK(areaOfAll(star) > 0.0);
    CHECK(areaOfAll(comb) > 0.0);
  }
}

TEST_CASE("polygons without an inside have as many triangles as others") {
  const double infinite = HUGE_VAL;
  for (const Polygon& polygon :
       {Polygon{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, Polygon(5, Vector{1, 2, 3}),
        Polygon{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
        Polygon{{0, 0, 0}, {infinite, 0, 0}, {1, 1, 0}, {0, 1, 0}},
        Polygon{{0, 0, 0}, {NAN, 0, 0}, {1, 1, 0}, {0, 1, 0}},
        Polygon{{-1e308, 0, 0}, {1e308, 0, 0}, {1e308, 1e308, 0}, {0, 1, 0}},
        Polygon{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {1, -1, 0}, {2, 3, 0}, {1, 1, 0}}})
    CHECK(trianglesOf(polygon).size() == polygon.size() - 2);
  CHECK(trianglesOf({{0, 0, 0}, {1, 0, 0}}).empty());
}

}  // namespace
}  // namespace examples
