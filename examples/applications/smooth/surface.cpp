// SPDX-License-Identifier: MIT
#include "surface.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "support/obj_file.hpp"
#include "support/text_file.hpp"

namespace smooth {

namespace {

constexpr double degenerateArea = 1e-12;  // of the square of the longest edge

Vector at(const Surface& s, std::int32_t i) { return s.points[static_cast<std::size_t>(i)]; }

Vector doubledArea(const Surface& s, const Triangle& f) {
  const Vector a = at(s, f[0]);
  return cross(at(s, f[1]) - a, at(s, f[2]) - a);
}

bool isDegenerate(const Surface& s, const Triangle& f) {
  double longest = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    longest = std::max(longest, length(at(s, f[i]) - at(s, f[(i + 1) % 3])));
  return !(length(doubledArea(s, f)) > 2.0 * degenerateArea * longest * longest);
}

template <class Number, class Write>
void addLine(std::string& text, const std::vector<Number>& faults, std::string_view what, Write&& write) {
  constexpr std::size_t most = 8;
  if (faults.empty()) return;
  fmt::format_to(std::back_inserter(text), "{} {}: ", faults.size(), what);
  for (std::size_t i = 0; i < std::min(most, faults.size()); ++i)
    text += (i == 0 ? "" : ", ") + write(faults[i]);
  text += faults.size() > most ? " ...\n" : "\n";
}

}  // namespace

void inspectAreas(const Surface& s, Faults& faults) {
  faults.degenerate.clear();
  faults.isolated.clear();
  std::vector<bool> used(s.points.size(), false);
  for (std::size_t f = 0; f < s.faces.size(); ++f) {
    if (isDegenerate(s, s.faces[f])) {
      faults.degenerate.push_back(static_cast<std::int64_t>(f));
    } else {
      for (const std::int32_t i : s.faces[f]) used[static_cast<std::size_t>(i)] = true;
    }
  }
  for (std::size_t i = 0; i < used.size(); ++i)
    if (!used[i]) faults.isolated.push_back(static_cast<std::int32_t>(i));
}

Faults inspect(const Surface& s) {
  Faults faults;
  inspectAreas(s, faults);
  std::map<std::pair<std::int32_t, std::int32_t>, int> edges;
  for (const Triangle& face : s.faces) {
    // A face that names a point twice has no inside, which an edge could bound.
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) continue;
    for (std::size_t i = 0; i < 3; ++i) ++edges[std::minmax(face[i], face[(i + 1) % 3])];
  }
  faults.boundary.assign(s.points.size(), false);
  for (const auto& [edge, count] : edges) {
    if (count > 2) faults.nonManifold.push_back(edge);
    if (count != 1) continue;
    faults.isClosed = false;
    faults.boundary[static_cast<std::size_t>(edge.first)] = true;
    faults.boundary[static_cast<std::size_t>(edge.second)] = true;
  }
  return faults;
}

std::string textOf(const Faults& faults) {
  const auto number = [](std::int64_t i) { return std::to_string(i + 1); };
  std::string text;
  addLine(text, faults.degenerate, "degenerate triangles have no weight", number);
  addLine(text, faults.nonManifold, "edges have more than two triangles, which all count",
          [&](const auto& e) { return number(e.first) + "-" + number(e.second); });
  addLine(text, faults.isolated, "vertices have no triangle with an area, and stay", number);
  return text;
}

double volumeOf(const Surface& s) {
  // From a point nearby, so that a surface far from the origin cancels nothing.
  const Vector centre = centreOf(s);
  double volume = 0.0;
  for (const Triangle& f : s.faces)
    volume += dot(at(s, f[0]) - centre, cross(at(s, f[1]) - centre, at(s, f[2]) - centre)) / 6.0;
  return volume;
}

double areaOf(const Surface& s) {
  double area = 0.0;
  for (const Triangle& f : s.faces) area += length(doubledArea(s, f)) / 2.0;
  return area;
}

Vector centreOf(const Surface& s) {
  Vector sum;
  for (const Vector& p : s.points) sum += p;
  return s.points.empty() ? sum : (1.0 / static_cast<double>(s.points.size())) * sum;
}

Surface sphere(int level, double radius) {
  const double g = std::numbers::phi;
  Surface s;
  s.points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
              {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  s.faces = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
             {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
             {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int i = 0; i < level; ++i) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [found, isNew] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(s.points.size()));
      if (isNew) s.points.push_back(at(s, a) + at(s, b));
      return found->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& f : s.faces) {
      const std::int32_t ab = middle(f[0], f[1]), bc = middle(f[1], f[2]), ca = middle(f[2], f[0]);
      finer.insert(finer.end(), {{f[0], ab, ca}, {f[1], bc, ab}, {f[2], ca, bc}, {ab, bc, ca}});
    }
    s.faces = std::move(finer);
    for (Vector& p : s.points) p = normalized(p);
  }
  for (Vector& p : s.points) p = radius * normalized(p);
  return s;
}

Surface torus(int around, int across, double radius, double tube) {
  Surface s;
  const double turn = 2.0 * std::numbers::pi;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = turn * i / around, v = turn * j / across, r = radius + tube * std::cos(v);
      s.points.push_back({r * std::cos(u), tube * std::sin(v), r * std::sin(u)});
      const std::int32_t here = i * across + j, up = i * across + (j + 1) % across;
      const std::int32_t right = (i + 1) % around * across + j,
                         both = (i + 1) % around * across + (j + 1) % across;
      s.faces.push_back({here, up, right});
      s.faces.push_back({up, both, right});
    }
  }
  return s;
}

void addNoise(Surface& s, double amplitude, std::uint32_t seed) {
  std::uint64_t state = seed;
  const auto next = [&] {  // splitmix64
    std::uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
  };
  for (Vector& p : s.points) {
    const double x = next(), y = next(), z = next();
    p += amplitude * Vector{x, y, z};
  }
}

Surface loadObj(const std::filesystem::path& file) {
  examples::ObjFile obj =
      examples::parseObj(file.string(), examples::bytesOf(file, "the mesh"), {.onlyFinite = true});
  Surface s;
  s.points = std::move(obj.points);
  for (const auto& [corners, material] : obj.triangles)
    s.faces.push_back({corners[0].point, corners[1].point, corners[2].point});
  return s;
}

void saveObj(const std::filesystem::path& file, const Surface& s) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (const Vector& p : s.points) fmt::format_to(out, "v {} {} {}\n", p.x, p.y, p.z);
  for (const Triangle& f : s.faces) fmt::format_to(out, "f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
  examples::writeFile(file, text);
}

}  // namespace smooth
