// SPDX-License-Identifier: MIT
//
// Figures: letters are where they should be, and plots are not touched.
#include "support/figure.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

namespace {

using namespace examples;

/// Pixels that are not black.
int inkOf(const Image& image, int left, int right) {
  int ink = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = left; x < right; ++x) ink += image.pixel(x, y)[0] != 0 ? 1 : 0;
  }
  return ink;
}

std::vector<std::string> textsOf(const std::vector<Tick>& ticks) {
  std::vector<std::string> texts;
  for (const Tick& tick : ticks) texts.push_back(tick.text);
  return texts;
}

}  // namespace

TEST_CASE("text is as wide as it says, on the side that the anchor names") {
  const Lettering how{.size = 20, .colour = {1, 1, 1}};
  const float width = widthOf("Boiling, 1 °C", how);
  CHECK(width > 80);
  CHECK(widthOf("Boiling, 1 °C", {.size = 40}) == Approx(2 * width).margin(0.5));
  CHECK(widthOf("WW", {.size = 20, .bold = true}) > widthOf("WW", how));
  for (const Anchor anchor : {Anchor::Left, Anchor::Centre, Anchor::Right}) {
    Image image = plainImage(400, 40, {0, 0, 0});
    letter(image, 200, 30, "Boiling, 1 °C", {.size = 20, .colour = {1, 1, 1}, .anchor = anchor});
    const int before = inkOf(image, 0, 199), behind = inkOf(image, 201, 400);
    CHECK((before == 0) == (anchor == Anchor::Left));
    CHECK((behind == 0) == (anchor == Anchor::Right));
    CHECK(before + behind > 300);
  }
}

TEST_CASE("text beyond the edges, empty, or no UTF-8 does no harm") {
  Image image = plainImage(20, 20, {0, 0, 0});
  letter(image, -50, 10, "wide wide wide wide", {.size = 30, .colour = {1, 1, 1}});
  letter(image, 5, 500, "below", {.colour = {1, 1, 1}});
  CHECK(inkOf(image, 0, 20) > 0);
  CHECK(widthOf("", {}) == 0);
  CHECK(widthOf("\xff\xe2\x82", {}) > 0);
}

TEST_CASE("a figure has even extents and its plot's pixels") {
  const Image plot = plainImage(101, 63, {1, 0.5f, 0});
  const Image made =
      figure(plot, {"Title", "what it shows", "a footnote"}, ColourBar{{{0, 0, 0}, {1, 1, 1}}, -1, 1, "T"});
  CHECK(made.width % 2 == 0);
  CHECK(made.height % 2 == 0);
  int found = 0;
  for (int y = 0; y < made.height; ++y) {
    for (int x = 0; x < made.width; ++x)
      found += std::equal(plot.rgb.begin(), plot.rgb.begin() + 3, made.pixel(x, y)) ? 1 : 0;
  }
  CHECK(found == 101 * 63);
  CHECK(figure(plot, {}).width < made.width);
}

TEST_CASE("ticks are round numbers within the range") {
  CHECK(textsOf(ticksBetween(0, 1, 5)) == std::vector<std::string>{"0.0", "0.5", "1.0"});
  CHECK(textsOf(ticksBetween(-0.21, 0.19, 5)) == std::vector<std::string>{"-0.2", "-0.1", "0.0", "0.1"});
  CHECK(textsOf(ticksBetween(0, 7e6, 4)) == std::vector<std::string>{"0", "5e+06"});
  CHECK(textsOf(ticksBetween(3, 3, 4)) == std::vector<std::string>{"3"});
}

TEST_CASE("a reduced image is the mean of light, not of codes") {
  Image image = plainImage(2, 2, {0, 0, 0});
  std::fill_n(image.rgb.begin(), 6, std::uint8_t{255});
  CHECK(int{reduced(image, 2).rgb[0]} == 188);
  CHECK(reduced(image, 2).width == 1);
}
