// SPDX-License-Identifier: MIT
#include "support/lettering.hpp"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <stb/stb_truetype.h>

extern "C" {
extern const unsigned char skFontRegular[], skFontBold[];
}

namespace examples {
namespace {

class Font {
 public:
  explicit Font(const unsigned char* bytes) {
    if (stbtt_InitFont(&info_, bytes, stbtt_GetFontOffsetForIndex(bytes, 0)) == 0) {
      throw std::runtime_error("the font that the program was built with is none");
    }
  }
  const stbtt_fontinfo* info() const { return &info_; }

 private:
  stbtt_fontinfo info_{};
};

const Font& fontOf(const Lettering& how) {
  static const Font regular(skFontRegular), bold(skFontBold);
  return how.bold ? bold : regular;
}

/// Takes one character off the text; what is no UTF-8 is one of its own for each byte.
int takeCharacter(std::string_view& text) {
  const auto first = static_cast<unsigned char>(text.front());
  const int following = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : 0;
  text.remove_prefix(1);
  if (static_cast<std::size_t>(following) > text.size()) return 0xfffd;
  int code = following == 0 ? first : first & (0x3f >> following);
  for (int i = 0; i < following; ++i) {
    code = (code << 6) | (static_cast<unsigned char>(text.front()) & 0x3f);
    text.remove_prefix(1);
  }
  return code;
}

/// Calls visit(character, x) for each, with x from 0 on; the whole width.
template <class Visit>
float forEachCharacter(const stbtt_fontinfo* font, float scale, std::string_view text, Visit&& visit) {
  float x = 0;
  int previous = 0;
  while (!text.empty()) {
    const int code = takeCharacter(text);
    if (previous != 0) x += scale * static_cast<float>(stbtt_GetCodepointKernAdvance(font, previous, code));
    visit(code, x);
    int advance = 0, bearing = 0;
    stbtt_GetCodepointHMetrics(font, code, &advance, &bearing);
    x += scale * static_cast<float>(advance);
    previous = code;
  }
  return x;
}

void setCharacter(Image& image, const stbtt_fontinfo* font, float scale, int code, float x, float y,
                  const sk::float3& colour) {
  const float column = std::floor(x), row = std::floor(y);
  int left = 0, top = 0, right = 0, bottom = 0;
  stbtt_GetCodepointBitmapBoxSubpixel(font, code, scale, scale, x - column, y - row, &left, &top, &right,
                                      &bottom);
  const int width = right - left, height = bottom - top;
  if (width <= 0 || height <= 0) return;
  std::vector<std::uint8_t> covered(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  stbtt_MakeCodepointBitmapSubpixel(font, covered.data(), width, height, width, scale, scale, x - column,
                                    y - row, code);
  const std::uint8_t* next = covered.data();
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const float share = static_cast<float>(*next++) / 255.0f;
      blend(image, static_cast<int>(column) + left + i, static_cast<int>(row) + top + j, colour, share);
    }
  }
}

}  // namespace

void letter(Image& image, float x, float y, std::string_view text, const Lettering& how) {
  const stbtt_fontinfo* font = fontOf(how).info();
  const float scale = stbtt_ScaleForPixelHeight(font, how.size);
  const float start =
      how.anchor == Anchor::Left ? x : x - widthOf(text, how) * (how.anchor == Anchor::Right ? 1.0f : 0.5f);
  forEachCharacter(font, scale, text, [&](int code, float at) {
    setCharacter(image, font, scale, code, start + at, y, how.colour);
  });
}

float widthOf(std::string_view text, const Lettering& how) {
  const stbtt_fontinfo* font = fontOf(how).info();
  return forEachCharacter(font, stbtt_ScaleForPixelHeight(font, how.size), text, [](int, float) {});
}

}  // namespace examples
