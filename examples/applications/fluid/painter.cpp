// SPDX-License-Identifier: MIT
#include "painter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "support/colormap.hpp"
#include "support/figure.hpp"
#include "view.sk.hpp"

namespace fluid {

namespace {

constexpr std::array<const char*, 4> labels = {"smoke", "temperature", "vorticity", "speed"};

/// A stream without the layer around the grid.
template <class T>
auto inner(const sk::Stream<T>& stream, const Model& m) {
  const auto first = [&](int d) { return m.isPeriodic(d) ? std::int64_t{0} : std::int64_t{1}; };
  const auto& n = m.cells;
  return stream.domain({first(2), first(1), first(0)}, {first(2) + n[2], first(1) + n[1], first(0) + n[0]});
}

}  // namespace

Painter::Painter(sk::Device& device, const Scene& scene)
    : device_(device),
      scene_(scene),
      colours_(examples::colormap(scene.view.colours, 256)),
      palette_(device.stream<sk::float3>({256})),
      covered_(device.stream<float>(scene.model.hasObstacles() ? scene.model.shape() : sk::Shape{1, 1, 1})) {
  palette_.write(colours_);
  if (scene.model.hasObstacles()) covered_.writeReals(coverageOf(scene.model));
}

examples::Image Painter::plane(Flow& flow) {
  const Model& m = scene_.model;
  const auto derived = [&]() -> linear::Vector& {
    if (!derived_) derived_.emplace(flow.space().stream<float>());
    return *derived_;
  };
  const linear::Vector* shown = nullptr;
  switch (scene_.view.shown) {
    case Shown::Smoke: shown = &flow.stream(Scalar::Smoke); break;
    case Shown::Temperature: shown = &flow.stream(Scalar::Heat); break;
    case Shown::Speed:
      shown = &derived();
      speedOf(flow.velocityStream(0), flow.velocityStream(1), derived());
      break;
    case Shown::Vorticity:
      shown = &derived();
      vorticityOf(static_cast<float>(1.0 / m.spacing), flow.velocityStream(0), flow.velocityStream(1),
                  derived());
      break;
  }
  const sk::Stream<float>& all = shown_.of(*shown, device_);
  if (!all) return {};
  const auto field = inner(all, m).reshape({m.cells[1], m.cells[0]});
  const std::vector<double> values = field.readReals();
  const auto [least, most] = std::ranges::minmax_element(values);
  values_ = examples::shownValues(scene_.view, *least, *most, scene_.view.shown == Shown::Vorticity);
  const int zoom = examples::zoomFor(scene_.view, m.cells[0], m.cells[1]);
  auto colour = device_.stream<sk::float3>({m.cells[1] * zoom, m.cells[0] * zoom});
  const auto draw = [&](const auto& covered) {
    fluid::paint(m.hasObstacles(), palette_, static_cast<float>(values_.low),
                 static_cast<float>(values_.high), 1.0f / static_cast<float>(zoom), field, covered, colour);
  };
  if (!m.hasObstacles())
    draw(sk::none);
  else
    draw(inner(covered_, m).reshape({m.cells[1], m.cells[0]}));
  return examples::imageOf(static_cast<int>(colour.shape()[1]), static_cast<int>(colour.shape()[0]),
                           colour.read());
}

examples::Image Painter::space(Flow& flow) {
  constexpr int finer = 2;  // rays for each pixel, in each direction
  const Model& m = scene_.model;
  const examples::BoxView view = examples::boxView(m.cells, scene_.view.turn, scene_.view.tilt, 720L * finer);
  const Camera camera = {view.middle, view.right, view.up, view.ahead};
  const bool hasObstacles = m.hasObstacles(), glows = scene_.view.glows;
  Air air{};
  const Triple sun = {-0.45, 1.0, -0.35};
  const double norm = std::sqrt(sun[0] * sun[0] + sun[1] * sun[1] + sun[2] * sun[2]);
  air.toLight = {static_cast<float>(sun[0] / norm), static_cast<float>(sun[1] / norm),
                 static_cast<float>(sun[2] / norm)};
  air.thickness = static_cast<float>(10.0 * scene_.view.thickness / static_cast<double>(m.cells[1]));
  air.cells = {static_cast<float>(m.cells[0]), static_cast<float>(m.cells[1]),
               static_cast<float>(m.cells[2])};
  if (!light_) light_.emplace(device_.stream<float>({m.cells[2], m.cells[1], m.cells[0]}));
  const sk::Stream<float>& allSmoke = shown_.of(flow.stream(Scalar::Smoke), device_);
  const sk::Stream<float>* const allHeat = glows ? &heat_.of(flow.stream(Scalar::Heat), device_) : nullptr;
  if (!allSmoke) return {};
  const auto smoke = inner(allSmoke, m);
  double hottest = 1e-30;
  for (const Source& source : m.sources) hottest = std::max(hottest, source.temperature);
  auto colour = device_.stream<sk::float3>({view.height, view.width});
  const auto draw = [&](const auto& covered) {
    illuminate(hasObstacles, air, smoke, covered, *light_);
    if (glows)
      march(hasObstacles, true, air, camera, palette_, static_cast<float>(hottest), smoke, *light_, covered,
            inner(*allHeat, m), colour);
    else
      march(hasObstacles, false, air, camera, palette_, 1.0f, smoke, *light_, covered, sk::none, colour);
  };
  if (hasObstacles)
    draw(inner(covered_, m));
  else
    draw(covered_);
  return examples::reduced(
      examples::imageOf(static_cast<int>(view.width), static_cast<int>(view.height), colour.read()), finer);
}

examples::Image Painter::paint(Flow& flow, const std::string& moment) {
  const examples::Image image = scene_.model.isSpace() ? space(flow) : plane(flow);
  if (!flow.space().isFirst()) return image;
  if (scene_.model.isSpace()) return examples::figure(image, {scene_.title, "", moment});
  const std::string label = labels[static_cast<std::size_t>(scene_.view.shown)];
  return examples::figure(image, {scene_.title, "", moment},
                          examples::ColourBar{colours_, values_.low, values_.high, label});
}

}  // namespace fluid
