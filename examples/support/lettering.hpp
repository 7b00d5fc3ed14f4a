// SPDX-License-Identifier: MIT
//
// Anti-aliased text in images: DejaVu Sans, which the program carries with it, by stb_truetype.
#pragma once

#include <string_view>

#include <sk/types.hpp>

#include "support/image.hpp"

namespace examples {

/// What of a text lies at the place that is given.
enum class Anchor { Left, Centre, Right };

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

}  // namespace examples
