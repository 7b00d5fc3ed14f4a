// SPDX-License-Identifier: MIT
#include "shapes.hpp"

#include <array>

namespace rays {
namespace {

using ControlRow = std::array<Vector, 4>;
using Patch = std::array<ControlRow, 4>;

/// A row of control points around the z axis, a quarter of a circle of radius r that k makes nearly round.
struct Turn {
  double r, k, z;
};
/// A row across the handle or the spout, from the inner side (x0, z0) by way of -y = width to the outer one.
struct Across {
  double x0, z0, x1, z1, width;
};

// Newell's control points; z is up.
constexpr std::array<std::array<Turn, 4>, 6> turnedPatches = {{
    {{{1.4, 0.784, 2.4}, {1.3375, 0.749, 2.53125}, {1.4375, 0.805, 2.53125}, {1.5, 0.84, 2.4}}},  // rim
    {{{1.5, 0.84, 2.4}, {1.75, 0.98, 1.875}, {2, 1.12, 1.35}, {2, 1.12, 0.9}}},                   // body
    {{{2, 1.12, 0.9}, {2, 1.12, 0.45}, {1.5, 0.84, 0.225}, {1.5, 0.84, 0.15}}},
    {{{0, 0, 3.15}, {0.8, 0.45, 3.15}, {0, 0, 2.85}, {0.2, 0.112, 2.7}}},  // lid
    {{{0.2, 0.112, 2.7}, {0.4, 0.224, 2.55}, {1.3, 0.728, 2.55}, {1.3, 0.728, 2.4}}},
    {{{1.5, 0.84, 0.15}, {1.5, 0.84, 0.075}, {1.425, 0.798, 0}, {0, 0, 0}}},  // bottom
}};
constexpr std::array<std::array<Across, 4>, 4> mirroredPatches = {{
    {{{-1.6, 2.025, -1.5, 2.25, 0.3},  // handle
      {-2.3, 2.025, -2.5, 2.25, 0.3},
      {-2.7, 2.025, -3, 2.25, 0.3},
      {-2.7, 1.8, -3, 1.8, 0.3}}},
    {{{-2.7, 1.8, -3, 1.8, 0.3},
      {-2.7, 1.575, -3, 1.35, 0.3},
      {-2.5, 1.125, -2.65, 0.9375, 0.3},
      {-2, 0.9, -1.9, 0.6, 0.3}}},
    {{{1.7, 1.425, 1.7, 0.6, 0.66},  // spout
      {2.6, 1.425, 3.1, 0.825, 0.66},
      {2.3, 2.1, 2.4, 2.025, 0.25},
      {2.7, 2.4, 3.3, 2.4, 0.25}}},
    {{{2.7, 2.4, 3.3, 2.4, 0.25},
      {2.8, 2.475, 3.525, 2.49375, 0.25},
      {2.9, 2.475, 3.45, 2.5125, 0.15},
      {2.8, 2.4, 3.2, 2.4, 0.15}}},
}};

std::array<double, 4> bernstein(double t) {
  const double s = 1 - t;
  return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}
std::array<double, 4> bernsteinSlope(double t) {
  const double s = 1 - t;
  return {-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t};
}

Vector mixed(const Patch& patch, const std::array<double, 4>& along, const std::array<double, 4>& across) {
  Vector sum;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) sum = sum + (along[i] * across[j]) * patch[i][j];
  return sum;
}

/// `across` and `along` from 0 to 1.
Vector normalAt(const Patch& patch, double across, double along) {
  const auto slopes = [&](double u, double v) {
    return cross(mixed(patch, bernstein(v), bernsteinSlope(u)),
                 mixed(patch, bernsteinSlope(v), bernstein(u)));
  };
  const Vector n = slopes(across, along);
  // At a pole all points of a row are one, and the normal is that beside it.
  if (length(n) > 1e-9) return normalized(n);
  return normalized(slopes(across, along < 0.5 ? along + 1e-4 : along - 1e-4));
}

/// Adds cells of a patch whose normal is slope across x slope along, z up, in the teapot's own lengths.
void addPatch(Mesh& mesh, const Patch& patch, int level) {
  constexpr double size = 1 / 6.525;  // from the handle at -3 to the spout at 3.525
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  const auto upright = [](Vector p) { return Vector{p.x, p.z, -p.y}; };
  std::vector<sk::float3> normals;
  for (int i = 0; i <= level; ++i) {
    for (int j = 0; j <= level; ++j) {
      const double along = double(i) / level, across = double(j) / level;
      mesh.points.push_back(size * upright(mixed(patch, bernstein(along), bernstein(across))));
      normals.push_back(toFloat3(upright(normalAt(patch, across, along))));
    }
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    // The points of a pole differ by roundings.
    const auto same = [&](std::uint32_t p, std::uint32_t q) {
      return length(mesh.points[first + p] - mesh.points[first + q]) < 1e-12;
    };
    if (same(a, b) || same(b, c) || same(c, a)) return;
    mesh.faces.push_back({{first + a, first + b, first + c}, -1});
    mesh.corners.push_back({{normals[a], normals[b], normals[c]}, {}});
  };
  const auto side = static_cast<std::uint32_t>(level + 1);
  for (std::uint32_t i = 0; i + 1 < side; ++i) {
    for (std::uint32_t j = 0; j + 1 < side; ++j) {
      const std::uint32_t a = i * side + j, b = a + 1, c = a + side, d = c + 1;
      add(a, b, d);
      add(a, d, c);
    }
  }
}

}  // namespace

Mesh teapot(int level) {
  Mesh mesh;
  for (const std::array<Turn, 4>& rows : turnedPatches) {
    Patch patch;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto [r, k, z] = rows[i];
      patch[i] = {Vector{r, 0, z}, Vector{r, -k, z}, Vector{k, -r, z}, Vector{0, -r, z}};
    }
    for (int quarter = 0; quarter < 4; ++quarter) {
      addPatch(mesh, patch, level);
      for (ControlRow& row : patch)
        for (Vector& p : row) p = {p.y, -p.x, p.z};
    }
  }
  for (const std::array<Across, 4>& rows : mirroredPatches) {
    Patch patch, mirror;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto [x0, z0, x1, z1, w] = rows[i];
      patch[i] = {Vector{x0, 0, z0}, Vector{x0, -w, z0}, Vector{x1, -w, z1}, Vector{x1, 0, z1}};
      mirror[i] = {Vector{x1, 0, z1}, Vector{x1, w, z1}, Vector{x0, w, z0}, Vector{x0, 0, z0}};
    }
    addPatch(mesh, patch, level);
    addPatch(mesh, mirror, level);
  }
  return mesh;
}

}  // namespace rays
