// SPDX-License-Identifier: MIT
#include "surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace smooth {

namespace {

constexpr int samples = 3;  // across and along each pixel

Vector turned(Vector p) {
  const double around = 0.6, up = 0.5;
  const Vector q = {std::cos(around) * p.x + std::sin(around) * p.z, p.y,
                    -std::sin(around) * p.x + std::cos(around) * p.z};
  return {q.x, std::cos(up) * q.y - std::sin(up) * q.z, std::sin(up) * q.y + std::cos(up) * q.z};
}

/// Warm light from the left above, cool light from the right, a highlight. Both sides of a face are lit.
sk::float3 shadeOf(Vector normal) {
  const Vector n = normal.z < 0.0 ? -1.0 * normal : normal;
  const Vector key = normalized(Vector{-0.5, 0.7, 0.6}), fill = normalized(Vector{0.8, -0.1, 0.5});
  const double k = std::max(0.0, dot(n, key)), f = std::max(0.0, dot(n, fill));
  const double shine = std::pow(std::max(0.0, dot(n, normalized(key + Vector{0, 0, 1}))), 40.0);
  const auto part = [&](double warm, double cool) {
    return static_cast<float>(std::sqrt(std::min(1.0, 0.03 + warm * k + cool * f + 0.18 * shine)));
  };
  return {part(0.62, 0.05), part(0.47, 0.09), part(0.30, 0.16)};
}

}  // namespace

examples::Image pictureOf(const Surface& surface, const Surface& frame, int size) {
  const int n = size * samples;
  const Vector centre = centreOf(frame);
  double reach = 1e-300;
  for (const Vector& p : frame.points) reach = std::max(reach, length(p - centre));
  const double scale = 0.44 * n / reach;
  std::vector<Vector> seen;
  for (const Vector& p : surface.points)
    seen.push_back(Vector{n / 2.0, n / 2.0, 0.0} + scale * turned(p - centre));

  std::vector<double> depth(static_cast<std::size_t>(n) * static_cast<std::size_t>(n),
                            -std::numeric_limits<double>::infinity());
  examples::Image image = examples::plainImage(n, n, {0.055f, 0.065f, 0.09f});
  for (const Triangle& face : surface.faces) {
    const Vector a = seen[static_cast<std::size_t>(face[0])], b = seen[static_cast<std::size_t>(face[1])],
                 c = seen[static_cast<std::size_t>(face[2])];
    const Vector normal = cross(b - a, c - a);
    if (normal.z == 0.0) continue;
    const sk::float3 colour = shadeOf(normalized(normal));
    const auto bound = [n](double v) {
      return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(n - 1)));
    };
    for (int y = bound(std::min({a.y, b.y, c.y})); y <= bound(std::max({a.y, b.y, c.y})); ++y) {
      for (int x = bound(std::min({a.x, b.x, c.x})); x <= bound(std::max({a.x, b.x, c.x})); ++x) {
        const double px = x + 0.5 - a.x, py = y + 0.5 - a.y;
        const double u = (px * (c.y - a.y) - py * (c.x - a.x)) / normal.z;
        const double v = (py * (b.x - a.x) - px * (b.y - a.y)) / normal.z;
        if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
        const double z = a.z + u * (b.z - a.z) + v * (c.z - a.z);
        const int row = n - 1 - y;
        double& nearest =
            depth[static_cast<std::size_t>(row) * static_cast<std::size_t>(n) + static_cast<std::size_t>(x)];
        if (z <= nearest) continue;
        nearest = z;
        examples::blend(image, x, row, colour, 1.0f);
      }
    }
  }
  return examples::reduced(image, samples);
}

}  // namespace smooth
