// SPDX-License-Identifier: MIT
#include "support/colormap.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "support/image.hpp"

namespace examples {
namespace {

/// Oklab's lightness.
double lightness(const sk::float3& encoded) {
  const double r = linearFromSrgb(encoded.x), g = linearFromSrgb(encoded.y), b = linearFromSrgb(encoded.z);
  return 0.2104542553 * std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b) +
         0.7936177850 * std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b) -
         0.0040720468 * std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
}

TEST_CASE("lightness rises evenly along every colour map") {
  for (const std::string_view name : colormapNames()) {
    const auto colours = colormap(name, 101);
    const double first = lightness(colours.front());
    const double whole = lightness(colours.back()) - first;
    REQUIRE(whole > 0.75);
    for (std::size_t i = 0; i < colours.size(); ++i) {
      INFO(name << " at " << i);
      CHECK(lightness(colours[i]) == Approx(first + whole * static_cast<double>(i) / 100.0).margin(1e-3));
    }
  }
}

TEST_CASE("every colour is one that sRGB has") {
  for (const auto& colours :
       {colormap("lagoon", 256), colormap("ember", 256), colormap("dusk", 2), hueWheel(360)}) {
    for (const sk::float3& c : colours) {
      CHECK((c.x >= 0.0f && c.x <= 1.0f && c.y >= 0.0f && c.y <= 1.0f && c.z >= 0.0f && c.z <= 1.0f));
    }
  }
}

TEST_CASE("the hues of the wheel have one lightness") {
  for (const sk::float3& c : hueWheel(36)) CHECK(lightness(c) == Approx(0.80).margin(1e-3));
}

TEST_CASE("a map of one entry, and a name that is none") {
  CHECK(colormap("ember", 1).size() == 1);
  CHECK_THROWS_AS(colormap("grey", 4), std::runtime_error);
}

}  // namespace
}  // namespace examples
