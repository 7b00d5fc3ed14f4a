// SPDX-License-Identifier: MIT
#include "drawing.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "support/figure.hpp"
#include "support/stopwatch.hpp"

namespace examples {
namespace {

/// OpenGL ES and native devices do not draw by OpenGL 3.3.
bool draws(const sk::Device& device) { return device.profile().starts_with("glsl"); }

const Scene& drawable(const Scene& scene) {
  if (scene.cloth.columns < 2 || scene.cloth.rows < 2) {
    throw std::runtime_error(
        "a cloth of one row or column has no faces to draw; leave --output out, and take --csv or --obj");
  }
  return scene;
}

}  // namespace

sk::Device drawingDevice() {
  try {
    return sk::Device({.device = "gpu", .profile = "glsl330", .sharesContext = true});
  } catch (const sk::Error&) {
    return sk::Device({.device = "software", .profile = "glsl330", .sharesContext = true});
  }
}

Drawing::Drawing(sk::Device& device, const Scene& scene)
    : device_(&device), isDirect_(draws(device)), scene_(scene), camera_(scene.view) {
  if (!isDirect_) ownContext_ = drawingDevice();
  makeObjects(scene);
}

Drawing::Drawing(InWindow, sk::Device& device, const Scene& scene)
    : device_(&device), isDirect_(draws(device)), inWindow_(true), scene_(scene), camera_(scene.view) {
  makeObjects(scene);
}

void Drawing::makeObjects(const Scene& scene) {
  if (!inWindow_) (isDirect_ ? *device_ : *ownContext_).makeCurrent();
  const std::int64_t bytes = scene.points() * static_cast<std::int64_t>(sizeof(sk::float4));
  positions_ = makeBuffer(bytes, nullptr, GL_DYNAMIC_DRAW);
  normals_ = makeBuffer(bytes, nullptr, GL_DYNAMIC_DRAW);
  renderer_.emplace(scene, ClothBuffers{positions_.get(), normals_.get()});
}

void Drawing::update(Simulation& simulation) {
  simulation.dress();
  const auto& positions = simulation.dressedPositions();
  const auto& normals = simulation.dressedNormals();
  bodies_ = momentAt(scene_, simulation.step()).bodies;
  if (isDirect_) {
    positions.fillBuffer(positions_.get());
    normals.fillBuffer(normals_.get());
    return;
  }
  const auto upload = [](const GlBuffer& buffer, const std::vector<sk::float4>& elements) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer.get());
    glBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(elements.size() * sizeof(sk::float4)),
                    elements.data());
  };
  if (ownContext_) ownContext_->makeCurrent();
  upload(positions_, positions.read());
  upload(normals_, normals.read());
}

Image Drawing::picture(int width, int height, int factor) {
  if (!inWindow_) (isDirect_ ? *device_ : *ownContext_).makeCurrent();
  return renderer_->picture(camera_, bodies_, width, height, factor);
}

void Drawing::draw(int width, int height, int factor, GLuint target) {
  renderer_->draw(camera_, bodies_, width, height, factor, target);
}

Filming::Filming(sk::Device& device, const Scene& scene, const Look& look, const std::string& precision)
    : scene_(scene),
      look_(look),
      where_(fmt::format("{} precision on {}", precision, device.name())),
      drawing_(device, scene),
      frames_(drawable(scene).record) {}

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
  return image;
}

void Filming::add(Simulation& simulation) {
  if (frames_.isFilm()) frames_.add([&] { return frameOf(simulation); }, {});
}

void Filming::finish(Simulation& simulation) {
  if (!frames_.isFilm()) frames_.add([&] { return frameOf(simulation); }, {});
  frames_.finish();
}

std::string Filming::report() const {
  return fmt::format(
      "wrote {}, {} frame{} of {} x {}, {:.3g} ms each; positions went {}", scene_.record.output.string(),
      frames_.count(), frames_.count() == 1 ? "" : "s", look_.size.width, look_.size.height,
      milliseconds_ / std::max(1, frames_.count()),
      drawing_.isDirect() ? "from stream to vertex buffer on the device" : "up from host memory");
}

}  // namespace examples
