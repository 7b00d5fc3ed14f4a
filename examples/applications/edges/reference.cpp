// SPDX-License-Identifier: MIT
#include "reference.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace examples {
namespace {

/// Roundings on the way of values of at most 1 to the gradient's length, each at most `roundoff`: five in the
/// luminance (two tables, product, two sums), radius + 3 in each blur (weight, product, sums), two in Sobel's
/// masks; the length stretches their error by sqrt 2 and adds up to six units of its own (GLSL's sqrt).
double steepnessBound(std::size_t radius) {
  const double component = 5.0 + 2.0 * (static_cast<double>(radius) + 3.0) + 2.0;
  return (std::numbers::sqrt2 * component + 6.0) * roundoff;
}

}  // namespace

Reference::Reference(const Picture& picture, std::span<const float> linear, std::span<const float> weights)
    : width_(picture.width), height_(picture.height), bound_(steepnessBound(weights.size() - 1)) {
  std::vector<double> plane;
  plane.reserve(picture.pixels.size());
  const auto light = [&](std::int32_t code) { return double{linear[static_cast<std::size_t>(code)]}; };
  for (const sk::int3& p : picture.pixels) {
    plane.push_back(0.2126 * light(p.x) + 0.7152 * light(p.y) + 0.0722 * light(p.z));
  }
  blur(weights, 1, 0, plane);
  blur(weights, 0, 1, plane);
  sobel(plane);
}

double Reference::at(const std::vector<double>& plane, std::int64_t x, std::int64_t y) const {
  x = std::clamp<std::int64_t>(x, 0, width_ - 1);
  y = std::clamp<std::int64_t>(y, 0, height_ - 1);
  return plane[static_cast<std::size_t>(y * width_ + x)];
}

void Reference::blur(std::span<const float> weights, std::int64_t dx, std::int64_t dy,
                     std::vector<double>& plane) const {
  std::vector<double> blurred;
  blurred.reserve(plane.size());
  for (std::int64_t y = 0; y < height_; ++y) {
    for (std::int64_t x = 0; x < width_; ++x) {
      double sum = weights[0] * at(plane, x, y);
      for (std::int64_t i = 1; i < std::ssize(weights); ++i) {
        sum += weights[static_cast<std::size_t>(i)] *
               (at(plane, x + i * dx, y + i * dy) + at(plane, x - i * dx, y - i * dy));
      }
      blurred.push_back(sum);
    }
  }
  plane = std::move(blurred);
}

void Reference::sobel(const std::vector<double>& plane) {
  for (std::int64_t y = 0; y < height_; ++y) {
    for (std::int64_t x = 0; x < width_; ++x) {
      double right = 0.0, down = 0.0;
      for (int i = -1; i <= 1; ++i) {
        const double weight = i == 0 ? 2.0 : 1.0;
        right += weight * (at(plane, x + 1, y + i) - at(plane, x - 1, y + i));
        down += weight * (at(plane, x + i, y + 1) - at(plane, x + i, y - 1));
      }
      slopeX_.push_back(right / 8.0);
      slopeY_.push_back(down / 8.0);
      steepness_.push_back(std::hypot(right / 8.0, down / 8.0));
    }
  }
}

Reference::Ridge Reference::thin(std::int64_t x, std::int64_t y) const {
  const double sx = at(slopeX_, x, y), sy = at(slopeY_, x, y);
  const std::int64_t dx = sx < 0 ? -1 : 1, dy = sy < 0 ? -1 : 1;
  const bool steep = std::abs(sy) > std::abs(sx);
  const double larger = std::max(std::abs(sx), std::abs(sy)), smaller = std::min(std::abs(sx), std::abs(sy));
  const double t = larger > 0 ? smaller / larger : 0.0;
  const auto side = [&](std::int64_t sign) {
    const double straight = steep ? at(steepness_, x, y + sign * dy) : at(steepness_, x + sign * dx, y);
    return straight + t * (at(steepness_, x + sign * dx, y + sign * dy) - straight);
  };
  const double here = at(steepness_, x, y);
  const double overAhead = here - side(1), overBehind = here - side(-1);
  const bool kept = overAhead > 0 && overBehind >= 0;
  const double margin = kept ? std::min(overAhead, overBehind)
                             : std::max(std::max(0.0, -overAhead), std::max(0.0, -overBehind));
  return {kept, margin};
}

Verification Reference::checkSteepness(std::span<const float> device) const {
  Verification verification("gradient against double loops", bound_,
                            "the roundings of the chain, at white 1");
  for (std::size_t i = 0; i < device.size(); ++i) {
    verification.compare(static_cast<std::int64_t>(i), device[i], steepness_[i]);
  }
  return verification;
}

Verification Reference::checkRidges(std::span<const float> device) const {
  Verification verification("thinned edges against double loops", 3 * bound_,
                            "as above, for the three lengths of a comparison");
  for (std::int64_t i = 0; i < std::ssize(device); ++i) {
    const auto place = static_cast<std::size_t>(i);
    const Ridge ridge = thin(i % width_, i / width_);
    const double length = steepness_[place];
    const bool agree = ridge.kept == (device[place] != 0.0f);
    if (agree) {
      verification.compare(i, device[place], ridge.kept ? length : 0.0);
    } else {
      const double error = device[place] != 0.0f ? std::abs(device[place] - length) : 0.0;
      verification.note(i, std::max(error, std::min(length, ridge.margin)));
    }
  }
  return verification;
}

Verification checkLinks(std::int64_t width, std::int64_t height, std::vector<std::int32_t> marks,
                        std::span<const std::int32_t> device) {
  std::vector<std::int64_t> open;
  for (std::int64_t i = 0; i < std::ssize(marks); ++i) {
    if (marks[static_cast<std::size_t>(i)] == 2) open.push_back(i);
  }
  while (!open.empty()) {
    const std::int64_t x = open.back() % width, y = open.back() / width;
    open.pop_back();
    for (std::int64_t ny = std::max<std::int64_t>(y - 1, 0); ny <= std::min(y + 1, height - 1); ++ny) {
      for (std::int64_t nx = std::max<std::int64_t>(x - 1, 0); nx <= std::min(x + 1, width - 1); ++nx) {
        std::int32_t& mark = marks[static_cast<std::size_t>(ny * width + nx)];
        if (mark == 1) {
          mark = 2;
          open.push_back(ny * width + nx);
        }
      }
    }
  }
  Verification verification("linked marks against following them on the host", 0.0, "integers");
  for (std::size_t i = 0; i < marks.size(); ++i)
    verification.compare(static_cast<std::int64_t>(i), device[i], marks[i]);
  return verification;
}

}  // namespace examples
