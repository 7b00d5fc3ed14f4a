// SPDX-License-Identifier: MIT
#include "shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace rays {
namespace {

/// Points of a lattice, each of them once, so that neighbouring faces share them.
class LatticePoints {
 public:
  LatticePoints(Mesh& mesh, int cells) : mesh_(mesh), cells_(cells) {}

  std::uint32_t at(const std::array<int, 3>& p) {
    const auto [entry, isNew] = numbers_.try_emplace(p, static_cast<std::uint32_t>(mesh_.points.size()));
    const auto coordinate = [&](std::size_t i) { return double(p[i]) / cells_ - 0.5; };
    if (isNew) mesh_.points.push_back({coordinate(0), coordinate(1), coordinate(2)});
    return entry->second;
  }

 private:
  Mesh& mesh_;
  int cells_;
  std::map<std::array<int, 3>, std::uint32_t> numbers_;
};

/// A cell of the sponge is gone if two of its three digits are 1 in any place of base 3.
bool isSolid(std::array<int, 3> cell, int level) {
  for (int i = 0; i < level; ++i) {
    int middles = 0;
    for (int& c : cell) {
      middles += c % 3 == 1;
      c /= 3;
    }
    if (middles >= 2) return false;
  }
  return true;
}

bool isInside(const std::array<int, 3>& cell, int cells) {
  return std::ranges::all_of(cell, [&](int c) { return c >= 0 && c < cells; });
}

/// The side of a cell towards `axis`, seen from outside.
void addSide(Mesh& mesh, LatticePoints& points, const std::array<int, 3>& cell, std::size_t axis, int step) {
  const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::array<std::uint32_t, 4> corner{};
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<int, 3> p = cell;
    p[axis] += step > 0 ? 1 : 0;
    p[u] += i == 1 || i == 2 ? 1 : 0;
    p[v] += i >= 2 ? 1 : 0;
    corner[i] = points.at(p);
  }
  if (step < 0) std::swap(corner[1], corner[3]);
  mesh.faces.push_back({{corner[0], corner[1], corner[2]}, -1});
  mesh.faces.push_back({{corner[0], corner[2], corner[3]}, -1});
}

std::uint32_t midpoint(Mesh& mesh, std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>& known,
                       std::uint32_t a, std::uint32_t b) {
  const auto [entry, isNew] =
      known.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.points.size()));
  if (isNew) mesh.points.push_back(0.5 * normalized(mesh.points[a] + mesh.points[b]));
  return entry->second;
}

/// A hash of (x, y, seed) as a number in [-1, 1).
double noise(int x, int y, std::uint32_t seed) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8da6b343u ^
                    static_cast<std::uint32_t>(y) * 0xd8163841u ^ seed * 0xcb1ab31fu;
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12)) * 0x297a2d39u;
  h ^= h >> 15;
  return double(h) / 2147483648.0 - 1.0;
}

/// Two unit vectors at right angles to n, and to each other.
std::pair<Vector, Vector> basisOf(Vector n) {
  const Vector other = std::abs(n.x) < 0.5 ? Vector{1, 0, 0} : Vector{0, 1, 0};
  const Vector u = normalized(cross(n, other));
  return {u, cross(n, u)};
}

void addFlake(std::vector<Sphere>& spheres, Vector centre, double radius, Vector axis, int level) {
  spheres.push_back({toFloat3(centre), static_cast<float>(radius), 0});
  if (level == 0) return;
  const auto [u, v] = basisOf(axis);
  // Six about the equator, three above.
  for (int i = 0; i < 9; ++i) {
    const double turn =
        i < 6 ? i * std::numbers::pi / 3 : (i - 6) * 2 * std::numbers::pi / 3 + std::numbers::pi / 6;
    const double rise = i < 6 ? 0.0 : std::asin(std::sqrt(2.0 / 3.0));
    const Vector out = std::cos(rise) * (std::cos(turn) * u + std::sin(turn) * v) + std::sin(rise) * axis;
    addFlake(spheres, centre + (radius * 4.0 / 3.0) * out, radius / 3, normalized(out), level - 1);
  }
}

}  // namespace

Mesh quad() {
  Mesh mesh;
  mesh.points = {{-0.5, 0, -0.5}, {0.5, 0, -0.5}, {0.5, 0, 0.5}, {-0.5, 0, 0.5}};
  mesh.faces = {{{0, 2, 1}, -1}, {{0, 3, 2}, -1}};
  const auto corners = [](sk::float2 a, sk::float2 b, sk::float2 c) { return Corners{{}, {a, b, c}}; };
  mesh.corners = {corners({0, 0}, {1, 1}, {1, 0}), corners({0, 0}, {0, 1}, {1, 1})};
  return mesh;
}

Mesh box() { return sponge(0); }

Mesh sponge(int level) {
  int cells = 1;
  for (int i = 0; i < level; ++i) cells *= 3;
  Mesh mesh;
  LatticePoints points(mesh, cells);
  for (int z = 0; z < cells; ++z) {
    for (int y = 0; y < cells; ++y) {
      for (int x = 0; x < cells; ++x) {
        const std::array<int, 3> cell = {x, y, z};
        if (!isSolid(cell, level)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (const int step : {-1, 1}) {
            std::array<int, 3> beside = cell;
            beside[axis] += step;
            if (!isInside(beside, cells) || !isSolid(beside, level)) addSide(mesh, points, cell, axis, step);
          }
        }
      }
    }
  }
  return mesh;
}

Mesh icosphere(int level, bool smooth) {
  Mesh mesh;
  const double g = std::numbers::phi;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-g, g}) {
      mesh.points.push_back({0, a, b});
      mesh.points.push_back({a, b, 0});
      mesh.points.push_back({b, 0, a});
    }
  }
  for (Vector& p : mesh.points) p = 0.5 * normalized(p);
  // Faces are the triples of points that are next to each other.
  const double near = length(mesh.points[0] - mesh.points[6]);
  const auto isNear = [&](std::size_t a, std::size_t b) {
    return length(mesh.points[a] - mesh.points[b]) < 1.01 * near;
  };
  for (std::uint32_t a = 0; a < 12; ++a) {
    for (std::uint32_t b = a + 1; b < 12; ++b) {
      for (std::uint32_t c = b + 1; c < 12; ++c) {
        if (!isNear(a, b) || !isNear(b, c) || !isNear(a, c)) continue;
        const Vector& p = mesh.points[a];
        const bool facesOut = dot(cross(mesh.points[b] - p, mesh.points[c] - p), p) > 0;
        mesh.faces.push_back({facesOut ? std::array{a, b, c} : std::array{a, c, b}, -1});
      }
    }
  }
  for (int i = 0; i < level; ++i) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    std::vector<Face> finer;
    for (const auto& [p, material] : mesh.faces) {
      const std::uint32_t ab = midpoint(mesh, known, p[0], p[1]), bc = midpoint(mesh, known, p[1], p[2]),
                          ca = midpoint(mesh, known, p[2], p[0]);
      for (const std::array<std::uint32_t, 3>& q : {std::array{p[0], ab, ca}, std::array{p[1], bc, ab},
                                                    std::array{p[2], ca, bc}, std::array{ab, bc, ca}})
        finer.push_back({q, material});
    }
    mesh.faces = std::move(finer);
  }
  if (!smooth) return mesh;
  for (const Face& face : mesh.faces) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i)
      corners.normals[i] = toFloat3(normalized(mesh.points[face.points[i]]));
    mesh.corners.push_back(corners);
  }
  return mesh;
}

Mesh torus(int around, int across, double tube) {
  Mesh mesh;
  const double radius = 0.5 - tube;
  std::vector<sk::float3> normals;
  for (int i = 0; i < around; ++i) {
    const double a = 2 * std::numbers::pi * i / around;
    for (int j = 0; j < across; ++j) {
      const double b = 2 * std::numbers::pi * j / across;
      const Vector n = {std::cos(a) * std::cos(b), std::sin(b), std::sin(a) * std::cos(b)};
      mesh.points.push_back(radius * Vector{std::cos(a), 0, std::sin(a)} + tube * n);
      normals.push_back(toFloat3(n));
    }
  }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>((i % around) * across + j % across);
  };
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.faces.push_back({{a, b, c}, -1});
    mesh.corners.push_back({{normals[a], normals[b], normals[c]}, {}});
  };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      add(at(i, j), at(i, j + 1), at(i + 1, j + 1));
      add(at(i, j), at(i + 1, j + 1), at(i + 1, j));
    }
  }
  return mesh;
}

Mesh terrain(int level, double height, std::uint32_t seed) {
  const int n = 1 << level;
  const int side = n + 1;
  std::vector<double> y(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0.0);
  const auto at = [&](int i, int j) -> double& {
    return y[static_cast<std::size_t>(j) * static_cast<std::size_t>(side) + static_cast<std::size_t>(i)];
  };
  double amplitude = height / 2;
  for (const int i : {0, n})
    for (const int j : {0, n}) at(i, j) = amplitude * noise(i, j, seed);
  for (int step = n; step > 1; step /= 2, amplitude *= 0.55) {
    const int half = step / 2;
    for (int j = 0; j < n; j += step) {
      for (int i = 0; i < n; i += step) {
        at(i + half, j + half) = (at(i, j) + at(i + step, j) + at(i, j + step) + at(i + step, j + step)) / 4 +
                                 amplitude * noise(i + half, j + half, seed);
      }
    }
    for (int j = 0; j <= n; j += half) {
      for (int i = (j / half) % 2 == 0 ? half : 0; i <= n; i += step) {
        double sum = 0.0;
        int count = 0;
        for (const auto& [dx, dy] :
             {std::pair{-half, 0}, std::pair{half, 0}, std::pair{0, -half}, std::pair{0, half}}) {
          if (i + dx < 0 || i + dx > n || j + dy < 0 || j + dy > n) continue;
          sum += at(i + dx, j + dy);
          ++count;
        }
        at(i, j) = sum / count + amplitude * noise(i, j, seed);
      }
    }
  }
  Mesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) mesh.points.push_back({double(i) / n - 0.5, at(i, j), double(j) / n - 0.5});
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const auto p = static_cast<std::uint32_t>(j * side + i), below = p + static_cast<std::uint32_t>(side);
      mesh.faces.push_back({{p, below, p + 1}, -1});
      mesh.faces.push_back({{p + 1, below, below + 1}, -1});
    }
  }
  return mesh;
}

std::vector<Sphere> sphereFlake(Vector centre, double radius, int level) {
  std::vector<Sphere> spheres;
  addFlake(spheres, centre, radius, {0, 1, 0}, level);
  return spheres;
}

}  // namespace rays
