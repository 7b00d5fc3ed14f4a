// SPDX-License-Identifier: MIT
//
// The way of a simulated cloth to a picture. On a GL device its points go from the streams to the buffers that are drawn, in the
// same context, and never visit host memory; of a native device, whose streams are host memory, they are uploaded once a
// frame to a context of their own.
#pragma once

#include <optional>
#include <string>

#include <sk/sk.hpp>

#include "camera.hpp"
#include "renderer.hpp"
#include "simulation.hpp"
#include "support/gl_objects.hpp"
#include "support/image.hpp"

namespace examples {

class Drawing {
 public:
  /// Off screen. The device must share its context, or have no OpenGL. Throws sk::Error where there is none to draw with.
  Drawing(sk::Device& device, const Scene& scene);
  /// In the context that is current, a window's; the device has adopted it, or is native.
  struct InWindow {};
  Drawing(InWindow, sk::Device& device, const Scene& scene);

  /// Takes over the points as they are now.
  void update(Simulation& simulation);
  /// What was taken over last.
  Image picture(int width, int height, int factor);
  void draw(int width, int height, int factor, GLuint target);

  Orbit& camera() { return camera_; }
  /// Whether positions go the short way, from stream to buffer.
  bool isDirect() const { return isDirect_; }

 private:
  void makeObjects(const Scene& scene);

  sk::Device* device_;
  std::optional<sk::Device> ownContext_;  ///< of a device without one that draws
  bool isDirect_ = false;
  bool inWindow_ = false;
  Scene scene_;
  Orbit camera_;
  std::vector<Placed> bodies_;
  // After the device, in whose context they are deleted.
  GlBuffer positions_, normals_;
  std::optional<Renderer> renderer_;
};

/// What draws where the simulation's device does not: the first GPU, else software. Throws sk::Error where there is no OpenGL.
sk::Device drawingDevice();

}  // namespace examples
