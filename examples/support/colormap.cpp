// SPDX-License-Identifier: MIT
#include "support/colormap.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/image.hpp"
#include "support/named.hpp"

namespace examples {
namespace {

constexpr double radian = std::numbers::pi / 180.0;

struct Polar {
  double lightness;
  double chroma;
  double hue;  ///< degrees
};

struct Tint {
  double chroma;
  double hue;  ///< degrees
};

/// Lightness rises evenly from low to high; tints lie evenly along the map and their course is smooth.
struct Map {
  std::string_view name;
  double low;
  double high;
  std::array<Tint, 5> tints;
};

constexpr std::array<Map, 3> maps = {{
    {"lagoon", 0.14, 0.96, {{{0.05, 300}, {0.12, 282}, {0.085, 220}, {0.135, 158}, {0.12, 108}}}},
    {"ember", 0.10, 0.97, {{{0.03, 285}, {0.13, 305}, {0.185, 358}, {0.145, 45}, {0.06, 100}}}},
    {"dusk", 0.13, 0.96, {{{0.05, 268}, {0.09, 258}, {0.02, 240}, {0.085, 85}, {0.06, 92}}}},
}};

std::array<double, 3> linearFromPolar(const Polar& p) {
  const double angle = p.hue * radian;
  const double a = p.chroma * std::cos(angle);
  const double b = p.chroma * std::sin(angle);
  const auto cubed = [](double x) { return x * x * x; };
  const double l = cubed(p.lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cubed(p.lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cubed(p.lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

bool shown(const std::array<double, 3>& linear) {
  return std::all_of(linear.begin(), linear.end(), [](double x) { return x >= -1e-6 && x <= 1.0 + 1e-6; });
}

/// The colour, or the nearest one of the same lightness and hue that sRGB has.
sk::float3 displayable(Polar p) {
  double outside = p.chroma;
  double inside = shown(linearFromPolar(p)) ? p.chroma : 0.0;
  for (int halving = 0; inside < outside && halving < 30; ++halving) {
    p.chroma = 0.5 * (inside + outside);
    (shown(linearFromPolar(p)) ? inside : outside) = p.chroma;
  }
  p.chroma = inside;
  const auto encoded = [](double linear) {
    return static_cast<float>(srgbFromLinear(std::clamp(linear, 0.0, 1.0)));
  };
  const auto [red, green, blue] = linearFromPolar(p);
  return {encoded(red), encoded(green), encoded(blue)};
}

/// Catmull-Rom through four neighbouring control values.
double through(double a, double b, double c, double d, double t) {
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

Polar along(const Map& map, double t) {
  const auto last = static_cast<std::ptrdiff_t>(map.tints.size()) - 1;
  const double scaled = t * static_cast<double>(last);
  const auto i = std::min(static_cast<std::ptrdiff_t>(scaled), last - 1);
  const auto component = [&](double (*axis)(double)) {
    const auto value = [&](std::ptrdiff_t k) {
      const Tint& tint = map.tints[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k, 0, last))];
      return tint.chroma * axis(tint.hue * radian);
    };
    return through(value(i - 1), value(i), value(i + 1), value(i + 2), scaled - static_cast<double>(i));
  };
  const double a = component(std::cos), b = component(std::sin);
  return {map.low + t * (map.high - map.low), std::hypot(a, b), std::atan2(b, a) / radian};
}

}  // namespace

std::vector<std::string_view> colormapNames() {
  std::vector<std::string_view> names;
  for (const Map& map : maps) names.push_back(map.name);
  return names;
}

std::vector<sk::float3> colormap(std::string_view name, int entries) {
  const Map& map = rowNamed(maps, name, "colour map");
  std::vector<sk::float3> colours;
  for (int i = 0; i < entries; ++i) {
    colours.push_back(displayable(along(map, entries > 1 ? static_cast<double>(i) / (entries - 1) : 0.5)));
  }
  return colours;
}

std::vector<sk::float3> hueWheel(int entries) {
  std::vector<sk::float3> colours;
  for (int i = 0; i < entries; ++i) colours.push_back(displayable({0.80, 0.12, 360.0 * i / entries}));
  return colours;
}

}  // namespace examples
