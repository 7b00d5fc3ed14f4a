// SPDX-License-Identifier: MIT
#include "support/figure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <fmt/format.h>
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

constexpr sk::float3 ground = {0.055f, 0.062f, 0.078f};
constexpr sk::float3 bright = {0.93f, 0.94f, 0.96f};
constexpr sk::float3 soft = {0.62f, 0.65f, 0.70f};

/// Where everything lies, in pixels.
struct Plan {
  Plan(const Image& plot, const Caption& caption, bool hasBar) {
    const int shorter = std::min(plot.width, plot.height);
    letters = std::clamp(static_cast<float>(std::max(shorter, plot.width / 2)) / 30.0f, 11.0f, 40.0f);
    margin = static_cast<int>(std::lround(letters * 1.2f));
    if (!caption.title.empty()) top += std::lround(letters * 1.9f);
    if (!caption.subtitle.empty()) top += std::lround(letters * 1.35f);
    if (!caption.footnote.empty()) bottom = static_cast<int>(std::lround(letters * 1.6f));
    if (hasBar) right = static_cast<int>(std::lround(letters * 6.4f));
    const int plotTop = margin + static_cast<int>(top);
    x = margin;
    y = plotTop;
    width = (margin + plot.width + right + margin + 1) / 2 * 2;
    height = (plotTop + plot.height + bottom + margin + 1) / 2 * 2;
  }

  float letters = 0;
  int margin = 0;
  long top = 0;
  int bottom = 0, right = 0;
  int x = 0, y = 0;  ///< of the plot
  int width = 0, height = 0;
};

sk::float3 colourAt(const std::vector<sk::float3>& colours, float t) {
  const auto last = static_cast<float>(colours.size() - 1);
  const float at = std::clamp(t, 0.0f, 1.0f) * last;
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, colours.size() - 1);
  const float share = at - static_cast<float>(below);
  const auto mix = [&](float a, float b) { return a + (b - a) * share; };
  return {mix(colours[below].x, colours[above].x), mix(colours[below].y, colours[above].y),
          mix(colours[below].z, colours[above].z)};
}

void drawBar(Image& image, const Plan& plan, int plotWidth, int plotHeight, const ColourBar& bar) {
  const int left = plan.x + plotWidth + plan.margin;
  const int width = std::max(6, static_cast<int>(std::lround(plan.letters * 0.9f)));
  const float text = plan.letters * 0.85f;
  const int labelRows = bar.label.empty() ? 0 : static_cast<int>(std::lround(plan.letters * 1.5f));
  const int top = plan.y + labelRows, height = plotHeight - labelRows;
  if (height < 2 || bar.colours.empty()) return;
  for (int j = 0; j < height; ++j) {
    const sk::float3 colour =
        colourAt(bar.colours, 1.0f - static_cast<float>(j) / static_cast<float>(height - 1));
    for (int i = 0; i < width; ++i) blend(image, left + i, top + j, colour, 1.0f);
  }
  if (labelRows > 0) {
    letter(image, static_cast<float>(left), static_cast<float>(plan.y) + text, bar.label,
           {.size = text, .colour = bright});
  }
  const int count = std::clamp(static_cast<int>(static_cast<float>(height) / (plan.letters * 3.0f)), 2, 7);
  for (const Tick& tick : ticksBetween(bar.low, bar.high, count)) {
    const double share = bar.high > bar.low ? (tick.value - bar.low) / (bar.high - bar.low) : 0.5;
    const double row = top + (1.0 - share) * (height - 1);
    for (int i = 0; i < width / 3 + 1; ++i) {
      blend(image, left + width + i, static_cast<int>(std::lround(row)), soft, 1.0f);
    }
    letter(image, static_cast<float>(left + width) + text * 0.6f, static_cast<float>(row) + text * 0.3f,
           tick.text, {.size = text, .colour = soft});
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

std::vector<Tick> ticksBetween(double low, double high, int count) {
  if (!(high > low) || !std::isfinite(high - low)) return {{low, fmt::format("{:.3g}", low)}};
  const double rough = (high - low) / std::max(count - 1, 1);
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * decade;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * decade >= rough * 0.999) step = factor * decade;
  }
  const int digits = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  const bool isPlain = digits <= 4 && std::max(std::abs(low), std::abs(high)) < 1e5;
  std::vector<Tick> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + step * 1e-9; ++k) {
    const double value = k == 0 ? 0.0 : k * step;
    ticks.push_back({value, isPlain ? fmt::format("{:.{}f}", value, digits) : fmt::format("{:.3g}", value)});
  }
  return ticks;
}

Image figure(const Image& plot, const Caption& caption, const std::optional<ColourBar>& bar) {
  const Plan plan(plot, caption, bar.has_value());
  Image image = plainImage(plan.width, plan.height, ground);
  paste(image, plot, plan.x, plan.y);
  const auto left = static_cast<float>(plan.x);
  float row = static_cast<float>(plan.margin);
  if (!caption.title.empty()) {
    letter(image, left, row + plan.letters * 1.05f, caption.title,
           {.size = plan.letters * 1.35f, .colour = bright, .bold = true});
    row += plan.letters * 1.9f;
  }
  if (!caption.subtitle.empty()) {
    letter(image, left, row + plan.letters * 0.7f, caption.subtitle, {.size = plan.letters, .colour = soft});
  }
  if (!caption.footnote.empty()) {
    const float below = static_cast<float>(plan.y + plot.height) + plan.letters * 1.35f;
    letter(image, left, below, caption.footnote, {.size = plan.letters * 0.85f, .colour = soft});
  }
  if (bar) drawBar(image, plan, plot.width, plot.height, *bar);
  return image;
}

}  // namespace examples
