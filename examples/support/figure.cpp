// SPDX-License-Identifier: MIT
#include "support/figure.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "support/lettering.hpp"

namespace examples {
namespace {

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
