// SPDX-License-Identifier: MIT
//
// The way of a simulated cloth to a picture. On a GL device its points go from the streams to the buffers that are drawn, in the
// same context, and never visit host memory; of a native device, whose streams are host memory, they are uploaded once a
// frame to a context of their own. And a run's frames, drawn, titled and put on file; what was filmed before a run breaks stays.
#pragma once

#include <optional>
#include <string>

#include <sk/sk.hpp>

#include "camera.hpp"
#include "renderer.hpp"
#include "simulation.hpp"
#include "support/gl_objects.hpp"
#include "support/image.hpp"
#include "support/record.hpp"

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

/// How frames look.
struct Look {
  PictureSize size;
  int samples = 2;  ///< samples x samples to a pixel
  bool isTitled = true;
};

class Filming {
 public:
  /// To scene.record.output. Throws before anything is simulated where that cannot be written, or nothing can draw.
  Filming(sk::Device& device, const Scene& scene, const Look& look, const std::string& precision);

  void add(Simulation& simulation);
  void finish(Simulation& simulation);
  /// One line on what was written, and how long drawing took.
  std::string report() const;

 private:
  Image frameOf(Simulation& simulation);

  Scene scene_;
  Look look_;
  std::string where_;
  Drawing drawing_;
  Frames frames_;
  double milliseconds_ = 0;
};

}  // namespace examples
