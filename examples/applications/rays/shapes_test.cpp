// SPDX-License-Identifier: MIT
//
// Meshes that kernels and patches make.
#include "shapes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "scenes_test.hpp"
#include "support/testing.hpp"

namespace rays {
namespace {

using examples::vecOf;

double volumeOf(const Mesh& mesh) {
  double sum = 0.0;
  for (const Face& f : mesh.faces)
    sum += dot(mesh.points[f.points[0]], cross(mesh.points[f.points[1]], mesh.points[f.points[2]])) / 6;
  return sum;
}

/// The cosine between a corner's normal and the face's, on average over the area.
double agreement(const Mesh& mesh) {
  double sum = 0.0, area = 0.0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto p = [&](std::size_t i) { return mesh.points[mesh.faces[f].points[i]]; };
    const Vector across = cross(p(1) - p(0), p(2) - p(0));
    area += 3 * length(across);
    for (const sk::float3& n : mesh.corners[f].normals) sum += dot(across, vecOf<double>(n));
  }
  return sum / area;
}

TEST_CASE("marching cubes make closed surfaces of any field, on every device") {
  constexpr int points = 14;
  std::vector<float> values(points * points * points, 1.0f);
  std::minstd_rand random(7);
  for (int z = 1; z + 1 < points; ++z)
    for (int y = 1; y + 1 < points; ++y)
      for (int x = 1; x + 1 < points; ++x)
        values[std::size_t((z * points + y) * points + x)] = random() % 2 == 0 ? -1.0f : 1.0f;
  std::vector<sk::int3> expected;
  for (const char* profile : {"native", "essl300", "glsl430"}) {
    INFO(profile);
    sk::Device device = examples::deviceNamed(profile);
    auto field = device.stream<float>({points, points, points});
    field.write(values);
    const std::vector<sk::int3> triangles = surfaceOf(device, field);
    if (expected.empty()) expected = triangles;
    // Random signs have nearly all of the 256 kinds of cells.
    CHECK(triangles.size() > 4000);
    Mesh mesh;
    for (const sk::int3& t : triangles)
      mesh.faces.push_back({.points = {std::uint32_t(t.x), std::uint32_t(t.y), std::uint32_t(t.z)}});
    CHECK(isClosed(mesh));
    CHECK((triangles == expected));
  }
}

TEST_CASE("a cell's triangles are seen from outside where its corners are inside") {
  // One corner, and all but one.
  CHECK(std::ranges::count_if(cubeTable()[1], [](int e) { return e >= 0; }) == 3);
  for (int kind = 0; kind < 256; ++kind) {
    std::map<int, int> uses;
    for (const int e : cubeTable()[std::size_t(kind)])
      if (e >= 0) ++uses[e];
    for (int axis = 0; axis < 3; ++axis) {
      for (int place = 0; place < 4; ++place) {
        const int from = (place & 1) << ((axis + 1) % 3) | (place >> 1) << ((axis + 2) % 3),
                  to = from | 1 << axis;
        const bool isCrossed = ((kind >> from ^ kind >> to) & 1) != 0;
        CHECK(uses.contains(4 * axis + place) == isCrossed);
      }
    }
  }
}

TEST_CASE("the gyroid is closed, lies in its ball and has its normals") {
  sk::Device device = sk::Device::native();
  const Mesh mesh = gyroid(device, 48, 1.25, 0.4);
  CHECK(mesh.faces.size() > 5000);
  CHECK(isClosed(mesh));
  for (const Vector& p : mesh.points) CHECK(length(p) <= 0.481);
  // As much as points of a lattice are in it.
  int inside = 0;
  constexpr int n = 64;
  for (int i = 0; i < n * n * n; ++i) {
    const Vector p =
        Vector{(i % n + 0.5) / n - 0.5, (i / n % n + 0.5) / n - 0.5, (i / (n * n) + 0.5) / n - 0.5};
    const Vector q = 2.5 * std::numbers::pi * p;
    const double height =
        std::sin(q.x) * std::cos(q.y) + std::sin(q.y) * std::cos(q.z) + std::sin(q.z) * std::cos(q.x);
    const double wall = std::sqrt(height * height + 0.04) - std::sqrt(0.2);
    const double ball = 2.5 * std::numbers::pi * (length(p) - 0.48),
                 near = std::max(0.4 - std::abs(wall - ball), 0.0);
    inside += std::max(wall, ball) + 0.625 * near * near < 0 ? 1 : 0;
  }
  CHECK(volumeOf(mesh) == Approx(double(inside) / (n * n * n)).epsilon(0.02));
  CHECK(agreement(mesh) > 0.98);
}

TEST_CASE("the teapot is 1 wide, stands on the ground and shows its outside") {
  const Mesh mesh = teapot(8);
  CHECK(mesh.faces.size() ==
        64 * 8 * 8 - 2 * 4 * 8);  // the lid's top and the bottom's centre have one triangle for two
  Vector least{1, 1, 1}, most{-1, -1, -1};
  for (const Vector& p : mesh.points) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
  }
  CHECK(least.y == 0.0);
  CHECK(most.y == Approx(3.15 / 6.525));
  CHECK(most.x - least.x ==
        Approx(1).epsilon(0.06));  // control points of the handle and the spout lie outside of them
  CHECK(most.z == Approx(-least.z));
  CHECK(agreement(mesh) > 0.98);
  // The profile of the body, turned about its axis, encloses about this volume; inverted triangles would lower it.
  CHECK(volumeOf(mesh) == Approx(0.105).epsilon(0.15));
}

}  // namespace
}  // namespace rays
