// SPDX-License-Identifier: MIT
#include "painter.hpp"

#include <algorithm>

#include "flow.sk.hpp"
#include "observe.sk.hpp"
#include "support/colormap.hpp"
#include "view.sk.hpp"

namespace examples {
Painter::Painter(sk::Device& device, const Scene& scene)
    : device_(device),
      scene_(scene),
      colours_(colormap(scene.view.colours, 256)),
      palette_(device.stream<sk::float3>({256})) {
  if (scene.view.mirror) std::reverse(colours_.begin(), colours_.end());
  palette_.write(colours_);
}

GridStream<float>& Painter::shown(Lattice& lattice) {
  const auto derive = [&](const auto& kernel) -> GridStream<float>& {
    if (!derived_) derived_.emplace(lattice.space().stream<float>());
    kernel(lattice.stream(Field::VelocityX), lattice.stream(Field::VelocityY), *derived_);
    return *derived_;
  };
  switch (scene_.view.shown) {
    case Shown::Temperature:
    case Shown::Bubbles: return lattice.stream(Field::Temperature);
    case Shown::U: return lattice.stream(Field::U);
    case Shown::V: return lattice.stream(Field::V);
    case Shown::Pressure: return lattice.stream(Field::Pressure);
    case Shown::Speed: return derive(lattice::speedOf);
    case Shown::Vorticity: return derive(lattice::curlOf);
  }
  return lattice.stream(Field::Temperature);
}

ShownValues Painter::range(const GridStream<float>& field) const {
  const auto [least, most, total, broken] = lattice::observe(field);
  return shownValues(scene_.view, least, most, scene_.view.shown == Shown::Vorticity);
}

sk::Stream<sk::float3> Painter::plane(const sk::Stream<float>& field, ShownValues values) {
  const Grid& g = scene_.model.grid;
  const int zoom = zoomFor(scene_.view, g.width, g.height);
  auto colour = device_.stream<sk::float3>({g.height * zoom, g.width * zoom});
  const auto low = static_cast<float>(values.low), high = static_cast<float>(values.high);
  const auto relief = static_cast<float>(scene_.view.relief);
  lattice::paint(relief > 0.0f, palette_, low, high, relief, 1.0f / static_cast<float>(zoom), field, colour);
  return colour;
}

sk::Stream<sk::float3> Painter::bubbles(const sk::Stream<float>& temperature, ShownValues values, int finer) {
  const Grid& g = scene_.model.grid;
  const BoxView view = boxView({g.width, g.height, g.depth}, 0.55, 0.32, 960L * finer);
  const lattice::Camera camera = {view.middle, view.right, view.up, view.ahead};
  auto colour = device_.stream<sk::float3>({view.height, view.width});
  lattice::march(palette_, static_cast<float>(values.low), static_cast<float>(values.high),
                 static_cast<float>(scene_.model.boilingPoint), camera, temperature, colour);
  return colour;
}

Image Painter::plot(Lattice& lattice) {
  constexpr int finer = 2;  // rays for each pixel, in each direction: surfaces have edges
  const GridStream<float>& field = shown(lattice);
  last_ = range(field);
  const sk::Stream<float>& cells = gathered_.of(field, device_);
  if (!cells) return {};
  const bool isSpace = scene_.view.shown == Shown::Bubbles;
  const auto colour = isSpace ? bubbles(cells, last_, finer) : plane(cells, last_);
  const Image image =
      imageOf(static_cast<int>(colour.shape()[1]), static_cast<int>(colour.shape()[0]), colour.read());
  return isSpace ? reduced(image, finer) : image;
}

Painter::Texture Painter::texture(Lattice& lattice) {
  const GridStream<float>& field = shown(lattice);
  last_ = range(field);
  const sk::Stream<float>& cells = field.whole();
  if (scene_.view.shown != Shown::Bubbles) return {cells.texture(), false, last_.low, last_.high};
  seen_.emplace(bubbles(cells, last_, 1));
  return {seen_->texture(), true, last_.low, last_.high};
}

Image Painter::paint(Lattice& lattice, const std::string& moment) {
  const Image image = plot(lattice);
  if (image.rgb.empty()) return image;
  std::optional<ColourBar> bar;  // surfaces in space are coloured by their height
  if (scene_.view.shown != Shown::Bubbles)
    bar = ColourBar{colours_, last_.low, last_.high, std::string(nameOf(scene_.view.shown))};
  return figure(image, {scene_.title, "", moment}, bar);
}

}  // namespace examples
