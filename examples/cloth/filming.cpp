// SPDX-License-Identifier: MIT
#include "filming.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "support/figure.hpp"
#include "support/stopwatch.hpp"

namespace examples {

Filming::Filming(sk::Device& device, const Scene& scene, const Look& look, const std::string& precision)
    : scene_(scene),
      look_(look),
      where_(fmt::format("{} precision on {}", precision, device.name())),
      drawing_(device, scene) {
  if (scene.cloth.columns < 2 || scene.cloth.rows < 2) {
    throw std::runtime_error(
        "a cloth of one row or column has no faces to draw; leave --output out, and take --csv or --obj");
  }
  const bool picture = scene.record.frames == 1 && scene.record.film.ends_with(".png");
  if (!picture) film_.emplace(scene.record.film, static_cast<int>(std::lround(scene.record.framesPerSecond)));
}

Filming::~Filming() {
  // Where a run has broken, the frames before are still a film.
  try {
    if (film_ && film_->frames() > 0) film_->finish();
  } catch (const std::exception&) {
  }
}

Image Filming::frameOf(Simulation& simulation) {
  const Stopwatch stopwatch;
  drawing_.update(simulation);
  const Image plot = drawing_.picture(look_.size.width, look_.size.height, look_.samples);
  const double time = static_cast<double>(simulation.step()) * scene_.run.dt;
  const Caption caption{
      scene_.title, scene_.subtitle,
      fmt::format("{} x {} points, t = {:.2f} s, {}", scene_.cloth.columns, scene_.cloth.rows, time, where_)};
  Image image = look_.isTitled ? figure(plot, caption) : plot;
  milliseconds_ += stopwatch.milliseconds();
  ++frames_;
  return image;
}

void Filming::add(Simulation& simulation) {
  if (film_) film_->add(frameOf(simulation));
}

void Filming::finish(Simulation& simulation) {
  if (film_) {
    film_->finish();
  } else {
    savePng(scene_.record.film, frameOf(simulation));
  }
}

std::string Filming::report() const {
  return fmt::format(
      "wrote {}, {} frame{} of {} x {}, {:.3g} ms each; positions went {}", scene_.record.film, frames_,
      frames_ == 1 ? "" : "s", look_.size.width, look_.size.height, milliseconds_ / std::max(1, frames_),
      drawing_.isDirect() ? "from stream to vertex buffer on the device" : "up from host memory");
}

}  // namespace examples
