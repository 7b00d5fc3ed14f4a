// SPDX-License-Identifier: MIT
#include "grid.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "scenes_test.hpp"

namespace rays {
namespace {

std::vector<int> listAt(const UniformGrid& grid, const std::array<int, 3>& c) {
  std::vector<int> list;
  int at = grid.starts[static_cast<std::size_t>((c[2] * grid.size.y + c[1]) * grid.size.x + c[0])];
  for (; at >= 0 && grid.lists[static_cast<std::size_t>(at)] >= 0; ++at)
    list.push_back(grid.lists[static_cast<std::size_t>(at)]);
  return list;
}

/// The cell of a point, whose coordinates differ from it by `off` times the margin.
std::array<int, 3> cellAt(const UniformGrid& grid, const sk::float3& p, double off) {
  const double away = off * gridMargin(grid.bounds);
  const auto along = [&](double x, double low, double cell, int size) {
    return std::clamp(static_cast<int>(std::floor((x + away - low) / cell)), 0, size - 1);
  };
  return {along(p.x, grid.bounds.least.x, grid.cell.x, grid.size.x),
          along(p.y, grid.bounds.least.y, grid.cell.y, grid.size.y),
          along(p.z, grid.bounds.least.z, grid.cell.z, grid.size.z)};
}

void checkThatPointsAreListed(const Model& model, const UniformGrid& grid) {
  std::mt19937 random(5);
  const auto unit = [&] { return float(random()) * 0x1p-32f; };
  for (std::size_t i = 0; i < model.triangles.size(); ++i) {
    const Triangle& t = model.triangles[i];
    float u = unit(), v = unit();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const float w = 1 - u - v;
    const sk::float3 p = {w * t.a.x + u * t.b.x + v * t.c.x, w * t.a.y + u * t.b.y + v * t.c.y,
                          w * t.a.z + u * t.b.z + v * t.c.z};
    for (const double off : {0.0, -0.9, 0.9}) {
      INFO("triangle " << i << ", off by " << off);
      CHECK(std::ranges::count(listAt(grid, cellAt(grid, p, off)), static_cast<int>(i)) == 1);
    }
  }
}

TEST_CASE("cells list each shape that comes near them, once") {
  const Model model = soup({.triangles = 500, .spheres = 0, .planes = 0});
  for (const double density : {0.01, 1.0, 16.0}) {
    const UniformGrid grid = buildGrid(model, {.density = density});
    checkThatPointsAreListed(model, grid);
    CHECK(double(grid.starts.size()) <= std::max(1.0, density * 500));
    CHECK(grid.lists.size() == static_cast<std::size_t>(grid.entries + grid.occupied));
  }
}

TEST_CASE("a grid leaves out cells that a triangle's box meets and the triangle does not") {
  Model model;
  model.triangles.push_back({{0, 0, 0}, {1, 0, 0}, {0, 1, 1}});
  const UniformGrid grid = buildGrid(model, {.density = 1000});
  CHECK(grid.occupied > 20);
  CHECK(grid.occupied < std::int64_t(grid.starts.size() / 4));
}

TEST_CASE("a sphere's inside is empty") {
  Model model;
  model.spheres.push_back({{0, 0, 0}, 1.0f});
  const UniformGrid grid = buildGrid(model, {.density = 1000});
  REQUIRE(grid.size.x == 10);
  CHECK(listAt(grid, {5, 5, 5}).empty());
  CHECK(listAt(grid, {0, 0, 0}).empty());
  CHECK(listAt(grid, {0, 5, 5}) == std::vector<int>{0});
}

TEST_CASE("grids of degenerate scenes") {
  CHECK(buildGrid({}, {}).starts.empty());
  Model point;
  for (int i = 0; i < 100; ++i) point.triangles.push_back({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}});
  const UniformGrid dot = buildGrid(point, {});
  CHECK(dot.longest == 100);
  checkThatPointsAreListed(point, dot);
  Model flat = soup({.triangles = 100, .spheres = 0, .planes = 0});
  for (Triangle& t : flat.triangles) t.a.y = t.b.y = t.c.y = 0.5f;
  const UniformGrid thin = buildGrid(flat, {});
  CHECK(thin.size.y == 1);
  CHECK(thin.starts.size() > 200);
  checkThatPointsAreListed(flat, thin);
  Model far = soup({.triangles = 100, .spheres = 0, .planes = 0});
  for (Triangle& t : far.triangles)
    for (sk::float3* p : {&t.a, &t.b, &t.c}) p->x = 0x1p22f + p->x;
  checkThatPointsAreListed(far, buildGrid(far, {}));
}

}  // namespace
}  // namespace rays
