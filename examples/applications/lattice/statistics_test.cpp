// SPDX-License-Identifier: MIT
#include "statistics.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

namespace examples {
namespace {

constexpr std::int64_t width = 96, height = 64;

std::vector<double> made(const std::function<double(double, double)>& value) {
  std::vector<double> values;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) values.push_back(value(x, y));
  return values;
}
PlaneField plane(const std::vector<double>& values) { return {width, height, values}; }

double wave(double x, double length) { return std::sin(2.0 * std::numbers::pi * x / length); }

TEST_CASE("a wave has its length") {
  const auto along = made([](double x, double) { return 3.0 + wave(x, 12); });
  CHECK(wavelengthOf(plane(along)) == Approx(12.0));
  const auto up = made([](double, double y) { return wave(y, 16); });
  CHECK(wavelengthOf(plane(up)) == Approx(16.0));
  CHECK(wavelengthOf(plane(made([](double, double) { return 2.0; }))) == 0.0);
}

TEST_CASE("a ring of the spectrum has its power, by Parseval's theorem") {
  const auto field = made([](double x, double y) { return wave(x, 12) + 0.5 * wave(y, 16); });
  const std::vector<double> rings = radialSpectrum(plane(field));
  const double all = static_cast<double>(width * height) * static_cast<double>(width * height);
  CHECK(rings[8] == Approx(0.5 * all));  // 96 / 12
  CHECK(rings[6] == Approx(0.125 * all));  // 96 / 16
  CHECK(rings[3] == Approx(0.0).margin(1e-6));
}

TEST_CASE("kinds of patterns") {
  const auto kind = [](const std::function<double(double, double)>& value) {
    return kindOf(plane(made(value)));
  };
  const auto dots = [](double x, double y) { return wave(x, 16) + wave(y, 16); };
  CHECK(kind([](double, double) { return 0.3; }) == Kind::Homogeneous);
  CHECK(kind([](double x, double) { return 0.005 * wave(x, 16); }) == Kind::Homogeneous);
  CHECK(kind([&](double x, double y) { return std::exp(2.0 * dots(x, y)); }) == Kind::Spots);
  CHECK(kind([&](double x, double y) { return -std::exp(-2.0 * dots(x, y)); }) == Kind::Holes);
  CHECK(kind([](double x, double) { return wave(x, 12); }) == Kind::Worms);
  CHECK(kind([](double x, double y) { return y < 4 ? 1.0 : wave(x, 12); }) == Kind::Network);
  CHECK(kind([](double x, double y) { return std::hypot(x - 30, y - 30) < 9 ? 1.0 : 0.0; }) == Kind::Spots);
}

}  // namespace
}  // namespace examples
