// SPDX-License-Identifier: MIT
#include "shapes.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "gyroid.sk.hpp"

namespace rays {
namespace {

/// The edge between two corners that differ in one bit.
int edgeBetween(int a, int b) {
  const int from = std::min(a, b), bit = a ^ b, axis = bit == 1 ? 0 : bit == 2 ? 1 : 2;
  const int s = from >> ((axis + 1) % 3) & 1, t = from >> ((axis + 2) % 3) & 1;
  return 4 * axis + s + 2 * t;
}

/// On a side of the cell, a line leads from the edge where its border comes into the solid to the edge where it next goes out. The same edge is an
/// end on one side and a beginning on another, so that lines make rings.
void addLines(int inside, std::size_t axis, int side, std::map<int, int>& next) {
  const auto bit = [](std::size_t a) { return 1 << (a % 3); };
  std::array<int, 4> ring = {0, bit(axis + 1), bit(axis + 1) | bit(axis + 2), bit(axis + 2)};
  if (side == 0) std::swap(ring[1], ring[3]);  // counterclockwise, seen from outside
  for (int& corner : ring) corner |= side == 0 ? 0 : bit(axis);
  const auto isInside = [&](std::size_t i) { return (inside >> ring[i % 4] & 1) != 0; };
  for (std::size_t i = 0; i < 4; ++i) {
    if (isInside(i) || !isInside(i + 1)) continue;
    std::size_t last = i + 1;
    while (isInside(last + 1)) ++last;
    next[edgeBetween(ring[i], ring[(i + 1) % 4])] = edgeBetween(ring[last % 4], ring[(last + 1) % 4]);
  }
}

std::array<int, 32> trianglesOf(int inside) {
  std::map<int, int> next;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {0, 1}) addLines(inside, axis, side, next);
  std::array<int, 32> row{};
  row.fill(-1);
  std::size_t count = 0;
  while (!next.empty()) {
    std::vector<int> ring;
    for (int edge = next.begin()->first; next.contains(edge);) {
      ring.push_back(edge);
      edge = next.extract(edge).mapped();
    }
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
      for (const int edge : {ring[0], ring[i], ring[i + 1]}) row[count++] = edge;
  }
  return row;
}

sk::Stream<int> tableOn(sk::Device& device) {
  auto table = device.stream<int>({256, 32});
  std::vector<int> elements;
  for (const std::array<int, 32>& row : cubeTable()) elements.insert(elements.end(), row.begin(), row.end());
  table.write(elements);
  return table;
}

}  // namespace

const CubeTable& cubeTable() {
  static const CubeTable table = [] {
    CubeTable t{};
    for (int inside = 0; inside < 256; ++inside) t[static_cast<std::size_t>(inside)] = trianglesOf(inside);
    return t;
  }();
  return table;
}

std::vector<sk::int3> surfaceOf(sk::Device& device, const sk::Stream<float>& field) {
  auto triangles = device.stream<sk::int3>({0});
  kernels::marchCubes(field, field, tableOn(device), static_cast<int>(field.shape()[0]), triangles);
  return triangles.read();
}

Mesh gyroid(sk::Device& device, int cells, double turns, double thickness) {
  const int points = cells + 1;
  const kernels::Gyroid shape{static_cast<float>(turns), static_cast<float>(thickness)};
  auto field = device.stream<float>({points, points, points});
  kernels::sampleGyroid(shape, cells, field);

  // Each edge that triangles use becomes a vertex.
  const std::vector<sk::int3> faces = surfaceOf(device, field);
  std::vector<int> edges;
  for (const sk::int3& f : faces) edges.insert(edges.end(), {f.x, f.y, f.z});
  std::ranges::sort(edges);
  edges.erase(std::ranges::unique(edges).begin(), edges.end());
  Mesh mesh;
  if (edges.empty()) return mesh;
  auto edge = device.stream<int>({static_cast<std::int64_t>(edges.size())});
  auto place = device.stream<sk::float3>(edge.shape()), normal = device.stream<sk::float3>(edge.shape());
  edge.write(edges);
  kernels::placeVertices(shape, edge, field, points, place, normal);
  for (const sk::float3& p : place.read()) mesh.points.push_back(examples::vecOf<double>(p));
  const std::vector<sk::float3> normals = normal.read();
  for (const sk::int3& f : faces) {
    const auto vertex = [&](int e) {
      return static_cast<std::uint32_t>(std::ranges::lower_bound(edges, e) - edges.begin());
    };
    const std::array<std::uint32_t, 3> corners = {vertex(f.x), vertex(f.y), vertex(f.z)};
    mesh.faces.push_back({corners, -1});
    mesh.corners.push_back({{normals[corners[0]], normals[corners[1]], normals[corners[2]]}, {}});
  }
  return mesh;
}

}  // namespace rays
