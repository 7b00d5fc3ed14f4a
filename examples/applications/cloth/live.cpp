// SPDX-License-Identifier: MIT
#include "run.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include "drawing.hpp"
#include "support/stopwatch.hpp"
#include "support/window.hpp"

namespace examples {
namespace {

/// What a person can change while it runs.
struct Show {
  bool restarts = false;
  double wind = 1.0;  ///< in place of the scene's
};

void obey(const Input& input, Show& show, Orbit& camera) {
  if (input.isDragged) camera.turn(-0.006 * input.dragX, 0.006 * input.dragY);
  if (input.wheel != 0) camera.approach(std::pow(0.9, input.wheel));
  for (const char key : input.typed) {
    if (key == 'r' || key == 'R') show.restarts = true;
    if (key == 'w' || key == 'W') show.wind = show.wind >= 2.0 ? 0.0 : show.wind + 0.5;
  }
}

Scene withWind(const Scene& scene, double factor) {
  Scene s = scene;
  if (s.wind) s.wind->velocity = factor * s.wind->velocity;
  return s;
}

}  // namespace

void runLive(const Scene& scene, sk::Precision precision, const std::string& name, PictureSize size) {
  Window window(scene.title, size.width, size.height);
  sk::Device device = Window::device(name);
  const auto make = [&](double wind) {
    return std::make_unique<Simulation>(device, withWind(scene, wind), Features::of(scene), precision);
  };
  Show show;
  auto simulation = make(show.wind);
  Drawing drawing(Drawing::InWindow{}, device, scene);
  double milliseconds = 16.0;  // a frame's, lately
  while (window.isOpen()) {
    const Stopwatch stopwatch;
    if (!window.isPaused()) {
      // As many steps as the last frame took, but no more than keep the picture moving.
      const auto due = static_cast<std::int64_t>(std::min(milliseconds, 40.0) / 1000.0 / scene.run.dt);
      simulation->advance(std::max<std::int64_t>(1, due));
      if (const Census census = simulation->census(); census.broken > 0) {
        throw std::runtime_error(fmt::format(
            "step {}: {} points have flown off, or are no numbers any more; take a smaller dt, stiffness "
            "or relaxation",
            simulation->step(), census.broken));
      }
      drawing.update(*simulation);
    }
    if (const auto pixels = window.size())
      drawing.draw(pixels->width, pixels->height, device.isSoftware() ? 1 : 2, 0);
    const double wind = show.wind;
    obey(window.show(), show, drawing.camera());
    if (show.restarts || show.wind != wind) {
      const State state = simulation->state();
      simulation = make(show.wind);
      if (!show.restarts) simulation->restore(state);
      show.restarts = false;
    }
    milliseconds = 0.8 * milliseconds + 0.2 * stopwatch.milliseconds();
    window.setTitle(fmt::format("{} - t = {:.1f} s, {:.0f} frames/s", scene.title,
                                static_cast<double>(simulation->step()) * scene.run.dt,
                                1000.0 / milliseconds));
  }
}

}  // namespace examples
