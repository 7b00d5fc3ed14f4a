// SPDX-License-Identifier: MIT
#include "run.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "lattice.hpp"
#include "painter.hpp"
#include "support/colormap.hpp"
#include "support/gl_objects.hpp"
#include "support/stopwatch.hpp"
#include "support/window.hpp"

namespace examples {
namespace {

// Values are interpolated between cells before they are coloured: colours between two colours are others.
constexpr std::string_view fieldShader = R"(
  in vec2 at;
  out vec4 colour;
  uniform sampler2D field, palette;
  uniform vec2 range;
  uniform bool isColour;
  vec4 cell(ivec2 p) { return texelFetch(field, clamp(p, ivec2(0), textureSize(field, 0) - 1), 0); }
  void main() {
    vec2 place = isColour ? vec2(at.x, 1.0 - at.y) : at;
    vec2 p = place * vec2(textureSize(field, 0)) - 0.5;
    ivec2 i = ivec2(floor(p));
    vec2 f = p - vec2(i);
    vec4 value = mix(mix(cell(i), cell(i + ivec2(1, 0)), f.x), mix(cell(i + ivec2(0, 1)), cell(i + ivec2(1, 1)), f.x), f.y);
    float t = clamp((value.x - range.x) / (range.y - range.x), 0.0, 1.0);
    float last = float(textureSize(palette, 0).x - 1);
    vec4 shade = mix(texelFetch(palette, ivec2(int(t * last), 0), 0), texelFetch(palette, ivec2(min(int(t * last) + 1, int(last)), 0), 0),
                     fract(t * last));
    colour = vec4(isColour ? value.rgb : shade.rgb, 1.0);
  })";

/// Draws a stream's texture into the window.
class Screen {
 public:
  Screen(sk::Device& device, const View& view) : palette_(device.stream<sk::float3>({256})) {
    std::vector<sk::float3> colours = colormap(view.colours, 256);
    if (view.mirror) std::reverse(colours.begin(), colours.end());
    palette_.write(colours);
  }

  void draw(const sk::StreamTexture& field, bool isColour, double low, double high, Window::Size size) {
    if (field.linear || field.layers != 0)
      throw std::runtime_error(
          "the lattice is too large to be drawn from one texture; take a smaller --size");
    glViewport(0, 0, size.width, size.height);
    view_.use();
    view_.bind("field", 0, field.name);
    view_.bind("palette", 1, palette_.texture().name);
    glUniform2f(view_["range"], static_cast<float>(low), static_cast<float>(high));
    glUniform1i(view_["isColour"], isColour ? 1 : 0);
    view_.draw();
  }

 private:
  FullView view_{fieldShader};
  sk::Stream<sk::float3> palette_;
};

struct Show {
  bool single = false, restarts = false, next = false;
  int steps = 8;  ///< for a picture
};

void obey(const Input& input, Show& show, Window& window) {
  for (const char key : input.typed) {
    if (key == 's') {
      window.pause();
      show.single = true;
    }
    if (key == 'f') show.next = true;
    if (key == 'r') show.restarts = true;
    if (key == '+') show.steps = std::min(show.steps * 2, 1 << 16);
    if (key == '-') show.steps = std::max(show.steps / 2, 1);
  }
}

/// What can be shown of a scene, beginning with what it asks for.
std::vector<View> viewsOf(const Scene& scene) {
  std::vector<View> views = {scene.view};
  for (const Shown shown :
       {Shown::Temperature, Shown::U, Shown::V, Shown::Speed, Shown::Vorticity, Shown::Pressure}) {
    if (shown == scene.view.shown || scene.model.grid.isSpace() || !has(scene.model, shown)) continue;
    View view = scene.view;
    view.shown = shown;
    view.low.reset();
    view.high.reset();
    views.push_back(view);
  }
  return views;
}

}  // namespace

void runLive(const Scene& scene, const std::string& deviceName) {
  if (deviceName == "native" || deviceName.starts_with("reference"))
    throw std::runtime_error(fmt::format(
        "device '{}' has no OpenGL, from which a window is drawn; leave --device out", deviceName));
  const Grid& g = scene.model.grid;
  const double scale = 1000.0 / static_cast<double>(std::max(g.width, g.height));
  Window window(scene.title, g.isSpace() ? 960 : static_cast<int>(scale * static_cast<double>(g.width)),
                g.isSpace() ? 800 : static_cast<int>(scale * static_cast<double>(g.height)));
  sk::Device device = sk::Device::adopt();
  const auto make = [&] {
    auto lattice = std::make_unique<Lattice>(device, scene.model);
    writeInitial(scene.model, scene.initial, *lattice);
    return lattice;
  };
  auto lattice = make();
  const std::vector<View> views = viewsOf(scene);
  std::size_t view = 0;
  auto painter = std::make_unique<Painter>(device, scene);
  Screen screen(device, scene.view);
  Show show;
  std::int64_t step = 0;
  double milliseconds = 16.0;
  while (window.isOpen()) {
    const Stopwatch stopwatch;
    if (!window.isPaused() || show.single) {
      const int steps = show.single ? 1 : show.steps;
      lattice->advance(steps);
      step += steps;
      show.single = false;
      requireFinite(*lattice, step);
    }
    const Painter::Texture texture = painter->texture(*lattice);
    if (const auto size = window.size())
      screen.draw(texture.texture, texture.isColour, texture.low, texture.high, *size);
    obey(window.show(), show, window);
    if (show.restarts) {
      lattice = make();
      step = 0;
    }
    if (show.next) {
      view = (view + 1) % views.size();
      Scene shown = scene;
      shown.view = views[view];
      painter = std::make_unique<Painter>(device, shown);
    }
    show.restarts = show.next = false;
    milliseconds = 0.8 * milliseconds + 0.2 * stopwatch.milliseconds();
    window.setTitle(fmt::format("{} - {} - step {}, {:.0f} pictures/s", scene.title,
                                nameOf(views[view].shown), step, 1000.0 / milliseconds));
  }
}

}  // namespace examples
