// SPDX-License-Identifier: MIT
#include "render.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "camera.hpp"
#include "exposure.hpp"
#include "support/gl_objects.hpp"
#include "support/stopwatch.hpp"
#include "support/window.hpp"

namespace rays {
namespace {

// As toneMapped in render.cpp.
constexpr std::string_view toneShader = R"(
  in vec2 at;
  out vec4 colour;
  uniform sampler2D radiance;
  uniform float exposure;
  uniform bool isFilmic;
  void main() {
    vec3 x = max(exposure * texture(radiance, vec2(at.x, 1.0 - at.y)).rgb, 0.0);
    if (isFilmic) x = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
    x = clamp(x, 0.0, 1.0);
    colour = vec4(mix(12.92 * x, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, greaterThan(x, vec3(0.0031308))), 1.0);
  })";

/// Draws pictures that come from host memory, so that any device can make them.
class Screen {
 public:
  Screen(int width, int height)
      : width_(width),
        height_(height),
        texture_(examples::makeTexture(GL_RGB32F, GL_RGB, GL_FLOAT, width, height)) {}

  void show(const std::vector<sk::float3>& pixels) {
    glBindTexture(GL_TEXTURE_2D, texture_.get());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_RGB, GL_FLOAT, pixels.data());
  }

  /// As large as the window allows without another shape.
  void draw(const Output& output, examples::Window::Size size) {
    glViewport(0, 0, size.width, size.height);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    const double scale = std::min(double(size.width) / width_, double(size.height) / height_);
    const int w = static_cast<int>(scale * width_), h = static_cast<int>(scale * height_);
    glViewport((size.width - w) / 2, (size.height - h) / 2, w, h);
    view_.use();
    view_.bind("radiance", 0, texture_.get());
    glUniform1f(view_["exposure"], static_cast<float>(output.exposure));
    glUniform1i(view_["isFilmic"], output.tone == ToneMap::Filmic ? 1 : 0);
    view_.draw();
  }

 private:
  int width_, height_;
  examples::FullView view_{toneShader};
  examples::GlTexture texture_;
};

/// True if the picture begins anew: the camera has moved, or somebody wants it.
bool obey(const examples::Input& input, Scene& scene) {
  bool restarts = false;
  for (const char key : input.typed) {
    if (key == 'r') restarts = true;
    if (key == '+') scene.output.exposure *= 1.25;
    if (key == '-') scene.output.exposure /= 1.25;
  }
  Camera& camera = scene.model.camera;
  if (input.isDragged && (input.dragX != 0 || input.dragY != 0))
    camera = turned(camera, -0.006 * input.dragX, 0.006 * input.dragY);
  else if (input.wheel != 0)
    camera = approached(camera, std::pow(0.9, input.wheel));
  else
    return restarts;
  return true;
}

/// The size of a window with the picture's shape, neither tiny nor larger than screens are.
examples::Window::Size windowSize(const Picture& picture) {
  const double longest = std::max(picture.width, picture.height);
  const double scale = std::clamp(longest, 480.0, 1200.0) / longest;
  return {std::max(1, static_cast<int>(scale * picture.width)),
          std::max(1, static_cast<int>(scale * picture.height))};
}

}  // namespace

void runLive(Scene& scene, const std::string& name) {
  const Picture& picture = scene.picture;
  const examples::Window::Size opened = windowSize(picture);
  examples::Window window(scene.title, opened.width, opened.height);
  sk::Device device = examples::Window::device(name);
  const std::unique_ptr<Engine> engine = scene.engines.at(scene.engine)(device, scene.model);
  for (const std::string& warning : engine->warnings()) fmt::print(stderr, "rays: warning: {}\n", warning);
  const std::unique_ptr<Renderer> renderer = engine->renderer(picture);
  Screen screen(picture.width, picture.height);
  std::int64_t samples = 0;
  double passMilliseconds = 1.0;
  while (window.isOpen()) {
    // A frame takes the samples that fit into 50 ms, because showing them costs time, too.
    const auto due = static_cast<std::int64_t>(50.0 / passMilliseconds);
    const std::int64_t end = std::min(samples + std::clamp<std::int64_t>(due, 1, 16), scene.output.samples);
    if (!window.isPaused() && samples < end) {
      const examples::Stopwatch stopwatch;
      const auto passes = static_cast<double>(end - samples);
      while (samples < end) renderer->pass(samples++);
      screen.show(renderer->image());
      passMilliseconds = std::max(0.1, stopwatch.milliseconds() / passes);
    }
    if (const auto size = window.size()) screen.draw(scene.output, *size);
    if (obey(window.show(), scene)) {
      renderer->look(scene.model.camera);
      samples = 0;
    }
    window.setTitle(fmt::format("{} - {} of {} samples, {:.3g} ms each", scene.title, samples,
                                scene.output.samples, passMilliseconds));
  }
}

}  // namespace rays
