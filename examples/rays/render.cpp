// SPDX-License-Identifier: MIT
#include "render.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "raster_file.hpp"
#include "support/picture.hpp"
#include "support/progress.hpp"
#include "support/stopwatch.hpp"

namespace rays {

Rendering render(Renderer& renderer, const Scene& scene) {
  const std::int64_t samples = scene.output.samples;
  const double limit = scene.output.seconds > 0 ? 1000 * scene.output.seconds : HUGE_VAL;
  Rendering rendering;
  examples::Progress progress("rendering", samples);
  const examples::Stopwatch stopwatch;
  while (rendering.samples < samples && (rendering.samples == 0 || stopwatch.milliseconds() < limit)) {
    renderer.pass(rendering.samples++);
    progress.update(rendering.samples);
  }
  rendering.radiance = renderer.image();
  rendering.milliseconds = stopwatch.milliseconds();
  progress.clear();
  return rendering;
}

float toneMapped(float radiance, const Output& output) {
  double x = std::max(0.0, output.exposure * radiance);
  if (output.tone == ToneMap::Filmic) x = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
  return static_cast<float>(examples::srgbFromLinear(std::clamp(x, 0.0, 1.0)));
}

void checkOutput(const Scene& scene) {
  const std::filesystem::path ending = scene.output.picture.extension();
  if (ending != ".png" && ending != ".pfm")
    throw std::runtime_error(
        fmt::format("'{}': pictures are .png or .pfm files", scene.output.picture.string()));
  if (scene.picture.width == 0 || scene.picture.height == 0)
    throw std::runtime_error(fmt::format("a picture of {} x {} pixels has none; give it a size",
                                         scene.picture.width, scene.picture.height));
}

void saveRendering(const Rendering& rendering, const Scene& scene) {
  checkOutput(scene);
  const Picture& picture = scene.picture;
  if (scene.output.picture.extension() == ".pfm")
    return savePfm(scene.output.picture, picture.width, picture.height, rendering.radiance);
  std::vector<sk::float3> pixels;
  pixels.reserve(rendering.radiance.size());
  for (const sk::float3& r : rendering.radiance)
    pixels.push_back(
        {toneMapped(r.x, scene.output), toneMapped(r.y, scene.output), toneMapped(r.z, scene.output)});
  examples::savePng(scene.output.picture, picture.width, picture.height, pixels);
}

}  // namespace rays
