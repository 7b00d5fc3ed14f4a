// SPDX-License-Identifier: MIT
#include "still_life.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace examples {
namespace {

struct Vec2 {
  double x, y;
};

struct Light {
  double r, g, b;
};

Light operator+(Light a, Light b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
Light operator*(Light a, double k) { return {a.r * k, a.g * k, a.b * k}; }
Light mix(Light a, Light b, double t) { return a * (1 - t) + b * t; }

Light fromSrgb(int rgb) {
  const auto component = [&](int shift) { return linearFromSrgb(((rgb >> shift) & 255) / 255.0); };
  return {component(16), component(8), component(0)};
}

/// Signed distances, negative inside; positions and lengths are in heights of the picture.
double disc(Vec2 p, Vec2 centre, double radius) {
  return std::hypot(p.x - centre.x, p.y - centre.y) - radius;
}

double bar(Vec2 p, Vec2 centre, double halfLength, double halfWidth, double degrees, double round) {
  const double angle = degrees * 0.017453292519943295;
  const Vec2 d{p.x - centre.x, p.y - centre.y};
  const double u = std::abs(d.x * std::cos(angle) + d.y * std::sin(angle)) - halfLength + round;
  const double v = std::abs(d.y * std::cos(angle) - d.x * std::sin(angle)) - halfWidth + round;
  return std::hypot(std::max(u, 0.0), std::max(v, 0.0)) + std::min(std::max(u, v), 0.0) - round;
}

double triangle(Vec2 p, Vec2 a, Vec2 b, Vec2 c) {
  const auto side = [&](Vec2 from, Vec2 to) {
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    return ((p.x - from.x) * (to.y - from.y) - (p.y - from.y) * (to.x - from.x)) / length;
  };
  return std::max({side(a, b), side(b, c), side(c, a)});
}

/// What lies between the ground and the eye, one shape after the other.
class Canvas {
 public:
  Canvas(Light ground, double pixel) : light_(ground), pixel_(pixel) {}

  void fill(double distance, Light paint, double opacity = 1.0) {
    light_ = mix(light_, paint, opacity * std::clamp(0.5 - distance / pixel_, 0.0, 1.0));
  }
  /// A soft shadow of the shape.
  void shade(double distance, double softness, double depth) {
    light_ = light_ * (1.0 - depth / (1.0 + std::exp(std::clamp(distance / softness, -40.0, 40.0))));
  }
  Light light() const { return light_; }

 private:
  Light light_;
  double pixel_;
};

void paintSphere(Canvas& canvas, Vec2 p, Vec2 centre, double radius) {
  canvas.shade(disc({p.x - 0.05, p.y - 0.06}, centre, radius), 0.018, 0.55);
  const double x = (p.x - centre.x) / radius, y = (p.y - centre.y) / radius;
  const double z = std::sqrt(std::max(0.0, 1.0 - x * x - y * y));
  const double facing = std::max(0.0, -0.48 * x - 0.60 * y + 0.64 * z);
  const double gleam = std::pow(std::max(0.0, -0.27 * x - 0.33 * y + 0.905 * z), 60.0);
  const Light body = fromSrgb(0xD9562B) * (0.10 + 0.95 * facing) + Light{0.6, 0.58, 0.55} * gleam;
  canvas.fill(disc(p, centre, radius), body);
}

void paintShapes(Canvas& canvas, Vec2 p) {
  canvas.fill(disc(p, {0.30, 0.34}, 0.235), fromSrgb(0x1D4E6B));
  canvas.fill(disc(p, {0.30, 0.34}, 0.150), fromSrgb(0xE9B44C));
  canvas.fill(disc(p, {0.34, 0.30}, 0.062), fromSrgb(0xF4EBDD));
  for (int i = 0; i < 6; ++i) {
    canvas.fill(std::abs(disc(p, {0.80, 0.22}, 0.028 + 0.024 * i)) - 0.0055, fromSrgb(0x2B2D33));
  }
  canvas.fill(triangle(p, {0.07, 0.72}, {0.40, 0.90}, {0.10, 0.95}), fromSrgb(0x5B8E7D), 0.92);
  canvas.fill(bar(p, {0.50, 0.50}, 0.52, 0.022, -38, 0.0), fromSrgb(0x2B2D33));
  canvas.fill(bar(p, {0.56, 0.57}, 0.40, 0.007, -38, 0.0), fromSrgb(0xB3382C));
  for (int i = 0; i < 5; ++i) {
    canvas.fill(bar(p, {0.535 + 0.055 * i, 0.885}, 0.017, 0.052 - 0.007 * i, 0, 0.006),
                fromSrgb(i % 2 == 0 ? 0x1D4E6B : 0xE9B44C));
  }
  canvas.fill(disc(p, {0.115, 0.115}, 0.045), fromSrgb(0xB3382C));
  paintSphere(canvas, p, {0.715, 0.625}, 0.165);
}

/// Grain: a hash of the position, summed to a bell shape.
double grain(std::uint32_t x, std::uint32_t y) {
  std::uint32_t h = x * 0x9E3779B1u ^ y * 0x85EBCA77u;
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 12;
    h *= 0x297A2D39u;
    h ^= h >> 15;
    sum += h / 4294967296.0 - 0.5;
  }
  return sum;
}

}  // namespace

Picture stillLife(int width, int height) {
  Picture picture{width, height, 255, {}};
  picture.pixels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const double unit = 1.0 / std::min(width, height);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Vec2 p{(column + 0.5 - 0.5 * width) * unit + 0.5, (row + 0.5 - 0.5 * height) * unit + 0.5};
      const Light ground =
          mix(fromSrgb(0xF6EFE2), fromSrgb(0xC9B79C), std::clamp(0.55 * p.x + 0.6 * p.y - 0.1, 0.0, 1.0));
      Canvas canvas(ground, unit);
      paintShapes(canvas, p);
      const double noise = 6.0 * grain(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row));
      const auto code = [&](double light) {
        return static_cast<std::int32_t>(
            std::clamp(std::lround(255.0 * srgbFromLinear(light) + noise), 0L, 255L));
      };
      const Light light = canvas.light();
      picture.pixels.push_back({code(light.r), code(light.g), code(light.b)});
    }
  }
  return picture;
}

}  // namespace examples
