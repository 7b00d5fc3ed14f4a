// SPDX-License-Identifier: MIT
#include "body_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace examples {
namespace {

constexpr int perCorner = 14;  // lines of the grid in a rounded edge

/// Where the lines of the grid on a face run: along an axis, from -half to half, dense where it is rounded.
std::vector<double> gridLines(double half, double radius) {
  std::vector<double> lines;
  for (int i = -perCorner; i <= perCorner; ++i) {
    const double rounded = radius * std::tan(std::numbers::pi / 4 * i / perCorner);
    if (i == 0 && half > radius) lines.push_back(-(half - radius));
    lines.push_back(i < 0 ? rounded - (half - radius) : rounded + (half - radius));
  }
  return lines;
}

/// The grid of one face: `u` x `v` points out along `w`.
struct Face {
  int w;
  double side;
};

double& component(Vector& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

void addFace(Mesh& mesh, const Face& face, Vector half, double radius) {
  const int u = (face.w + 1) % 3, v = (face.w + 2) % 3;
  const std::vector<double> us = gridLines(component(half, u), radius),
                            vs = gridLines(component(half, v), radius);
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  const Vector core = half - Vector{radius, radius, radius};
  for (const double y : vs) {
    for (const double x : us) {
      Vector p;
      component(p, face.w) = face.side * component(half, face.w);
      component(p, u) = x;
      component(p, v) = y;
      const Vector q{std::clamp(p.x, -core.x, core.x), std::clamp(p.y, -core.y, core.y),
                     std::clamp(p.z, -core.z, core.z)};
      const Vector normal = normalized(p - q);
      mesh.positions.push_back(toFloat3(q + radius * normal));
      mesh.normals.push_back(toFloat3(normal));
    }
  }
  const auto columns = static_cast<std::uint32_t>(us.size());
  for (std::uint32_t y = 0; y + 1 < vs.size(); ++y) {
    for (std::uint32_t x = 0; x + 1 < columns; ++x) {
      const std::uint32_t a = base + y * columns + x, b = a + 1, c = a + columns, d = c + 1;
      if (face.side > 0) {
        mesh.triangles.insert(mesh.triangles.end(), {a, b, c, b, d, c});
      } else {
        mesh.triangles.insert(mesh.triangles.end(), {a, c, b, b, c, d});
      }
    }
  }
}

/// The quaternion's turn of v.
Vector turned(Vector v, Vector axis, double w) { return v + 2.0 * cross(axis, cross(axis, v) + w * v); }

void turn(Mesh& mesh, Vector axis, double w) {
  for (auto* list : {&mesh.positions, &mesh.normals}) {
    for (sk::float3& v : *list) v = toFloat3(turned(vecOf<double>(v), axis, w));
  }
}

}  // namespace

Mesh roundedBox(Vector half, double radius) {
  Mesh mesh;
  for (const int axis : {0, 1, 2}) {
    for (const double side : {1.0, -1.0}) addFace(mesh, {axis, side}, half, radius);
  }
  return mesh;
}

Mesh meshOf(const Body& body) {
  const double r = body.size.x;
  switch (body.kind) {
    case Kind::Sphere: return roundedBox({r, r, r}, r);
    case Kind::Plane: return {};
    case Kind::Box: {
      Mesh mesh = roundedBox(body.size, 0.04 * std::min({body.size.x, body.size.y, body.size.z}));
      turn(mesh, body.axis, body.turn);
      return mesh;
    }
    case Kind::Capsule: {
      const double l = length(body.along);
      Mesh mesh = roundedBox({r, r + l / 2, r}, r);
      // From +y to the capsule's own direction, by the half-way vector; straight down is half a turn around x.
      const Vector to = l > 0 ? (1 / l) * body.along : Vector{0, 1, 0};
      const Vector halfway = normalized(to + Vector{0, 1, 0});
      if (halfway == Vector{}) {
        turn(mesh, {1, 0, 0}, 0);
      } else {
        turn(mesh, cross(Vector{0, 1, 0}, halfway), halfway.y);
      }
      for (sk::float3& p : mesh.positions) p = toFloat3(vecOf<double>(p) + 0.5 * body.along);
      return mesh;
    }
  }
  return {};
}

}  // namespace examples
