// SPDX-License-Identifier: MIT
#include "statistics.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

namespace examples {
namespace {

using Complex = std::complex<double>;

/// The DFT of `count` numbers that lie `stride` apart, in place.
void transform(std::vector<Complex>& all, std::size_t first, std::size_t count, std::size_t stride,
               const std::vector<Complex>& roots) {
  std::vector<Complex> result(count);
  for (std::size_t k = 0; k < count; ++k) {
    Complex sum = 0.0;
    for (std::size_t j = 0; j < count; ++j) sum += all[first + j * stride] * roots[j * k % count];
    result[k] = sum;
  }
  for (std::size_t k = 0; k < count; ++k) all[first + k * stride] = result[k];
}

std::vector<Complex> rootsOfUnity(std::size_t count) {
  std::vector<Complex> roots(count);
  for (std::size_t j = 0; j < count; ++j)
    roots[j] = std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(count));
  return roots;
}

struct Islands {
  std::vector<double> areas;
  std::vector<double> outlines;  ///< edges between cells
};

/// The connected regions of the cells where `inside` is true.
Islands islandsOf(std::int64_t width, std::int64_t height, const std::vector<bool>& inside) {
  Islands islands;
  std::vector<bool> seen(inside.size(), false);
  std::vector<std::size_t> open;
  for (std::size_t start = 0; start < inside.size(); ++start) {
    if (!inside[start] || seen[start]) continue;
    double area = 0.0, outline = 0.0;
    seen[start] = true;
    open.push_back(start);
    while (!open.empty()) {
      const auto cell = static_cast<std::int64_t>(open.back());
      open.pop_back();
      area += 1.0;
      const std::int64_t x = cell % width, y = cell / width;
      for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{-1, 0}, std::pair{0, 1}, std::pair{0, -1}}) {
        const auto next =
            static_cast<std::size_t>((y + dy + height) % height * width + (x + dx + width) % width);
        if (!inside[next]) {
          outline += 1.0;
        } else if (!seen[next]) {
          seen[next] = true;
          open.push_back(next);
        }
      }
    }
    islands.areas.push_back(area);
    islands.outlines.push_back(outline);
  }
  return islands;
}

/// The median over islands of outline^2 over that of a disc as large: 1 for discs.
double stretchOf(const Islands& islands) {
  std::vector<double> stretches;
  for (std::size_t i = 0; i < islands.areas.size(); ++i) {
    const double outline = islands.outlines[i] * std::numbers::pi / 4.0;
    stretches.push_back(outline * outline / (4.0 * std::numbers::pi * islands.areas[i]));
  }
  std::nth_element(stretches.begin(), stretches.begin() + static_cast<std::ptrdiff_t>(stretches.size() / 2),
                   stretches.end());
  return stretches[stretches.size() / 2];
}

}  // namespace

std::vector<double> radialSpectrum(const PlaneField& f) {
  const auto w = static_cast<std::size_t>(f.width), h = static_cast<std::size_t>(f.height);
  const double mean =
      std::accumulate(f.values.begin(), f.values.end(), 0.0) / static_cast<double>(f.values.size());
  std::vector<Complex> all;
  all.reserve(f.values.size());
  for (const double value : f.values) all.emplace_back(value - mean);
  const std::vector<Complex> alongX = rootsOfUnity(w), alongY = rootsOfUnity(h);
  for (std::size_t y = 0; y < h; ++y) transform(all, y * w, w, 1, alongX);
  for (std::size_t x = 0; x < w; ++x) transform(all, x, h, w, alongY);
  std::vector<double> rings(std::min(w, h) / 2 + 1, 0.0);
  for (std::size_t y = 0; y < h; ++y) {
    for (std::size_t x = 0; x < w; ++x) {
      const auto kx = static_cast<double>(std::min(x, w - x));
      const double ky =
          static_cast<double>(std::min(y, h - y)) * static_cast<double>(w) / static_cast<double>(h);
      const auto ring = static_cast<std::size_t>(std::lround(std::hypot(kx, ky)));
      if (ring < rings.size()) rings[ring] += std::norm(all[y * w + x]);
    }
  }
  return rings;
}

double wavelengthOf(const PlaneField& field) {
  const std::vector<double> rings = radialSpectrum(field);
  double power = 0.0, weighted = 0.0;
  for (std::size_t k = 1; k < rings.size(); ++k) {
    power += rings[k];
    weighted += rings[k] * static_cast<double>(k);
  }
  return weighted > 0.0 ? static_cast<double>(field.width) * power / weighted : 0.0;
}

std::string_view nameOf(Kind kind) {
  switch (kind) {
    case Kind::Homogeneous: return "homogeneous";
    case Kind::Spots: return "spots";
    case Kind::Worms: return "worms";
    case Kind::Network: return "network";
    case Kind::Holes: return "holes";
  }
  return "";
}

Kind kindOf(const PlaneField& f) {
  constexpr double round = 1.7;
  const auto [low, high] = std::minmax_element(f.values.begin(), f.values.end());
  if (!(*high - *low >= 0.02)) return Kind::Homogeneous;
  const double middle = 0.5 * (*low + *high);
  std::vector<bool> above(f.values.size());
  std::transform(f.values.begin(), f.values.end(), above.begin(),
                 [&](double value) { return value > middle; });
  const Islands islands = islandsOf(f.width, f.height, above);
  const double all = std::accumulate(islands.areas.begin(), islands.areas.end(), 0.0);
  const double largest = *std::max_element(islands.areas.begin(), islands.areas.end());
  const bool isOne = islands.areas.size() == 1 && all < 0.25 * static_cast<double>(f.values.size());
  if (isOne || largest <= 0.5 * all) return stretchOf(islands) < round ? Kind::Spots : Kind::Worms;
  above.flip();
  const Islands lakes = islandsOf(f.width, f.height, above);
  const double sea = static_cast<double>(f.values.size()) - all;
  const bool isolated =
      !lakes.areas.empty() && *std::max_element(lakes.areas.begin(), lakes.areas.end()) <= 0.5 * sea;
  return isolated && stretchOf(lakes) < round ? Kind::Holes : Kind::Network;
}

}  // namespace examples
