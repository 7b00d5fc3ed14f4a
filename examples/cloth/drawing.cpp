// SPDX-License-Identifier: MIT
#include "drawing.hpp"

#include <vector>

namespace examples {
namespace {

/// OpenGL ES and native devices do not draw by OpenGL 3.3.
bool draws(const sk::Device& device) { return device.profile().starts_with("glsl"); }

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

}  // namespace examples
