// SPDX-License-Identifier: MIT
//
// Text in images, and pictures with a title above, a line below, and a bar that says what colours mean.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sk/types.hpp>

#include "support/image.hpp"

namespace examples {

/// What of a text lies at the place that is given.
enum class Anchor { Left, Centre, Right };

/// Anti-aliased DejaVu Sans, which the program carries with it.
struct Lettering {
  float size = 16;  ///< pixels from the lowest to the highest that letters reach
  sk::float3 colour = {0, 0, 0};  ///< sRGB-encoded, in [0, 1]
  Anchor anchor = Anchor::Left;
  bool bold = false;
};

/// Sets UTF-8 with its baseline at row `y`. What is outside of the image is dropped; what the font lacks is a box.
void letter(Image& image, float x, float y, std::string_view text, const Lettering& how);
/// The width in pixels.
float widthOf(std::string_view text, const Lettering& how);

struct Caption {
  std::string title;     ///< bold, above; empty: none
  std::string subtitle;  ///< beneath it: what is shown
  std::string footnote;  ///< below, small: parameters, step, time
};

/// A scale of values: colours from `low` to `high`, sRGB-encoded.
struct ColourBar {
  std::vector<sk::float3> colours;
  double low = 0;
  double high = 1;
  std::string label;
};

/// The plot between its texts, on a dark ground. Sizes of letters go with the plot's, and the result is even in width and
/// height, as films want it.
Image figure(const Image& plot, const Caption& caption, const std::optional<ColourBar>& bar = std::nullopt);

/// Round numbers from low to high, some `count` of them, and how they are written.
struct Tick {
  double value;
  std::string text;
};
std::vector<Tick> ticksBetween(double low, double high, int count);

}  // namespace examples
