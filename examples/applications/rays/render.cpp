// SPDX-License-Identifier: MIT
#include "render.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "exposure.hpp"
#include "raster_file.hpp"
#include "state_file.hpp"
#include "support/image.hpp"
#include "support/progress.hpp"
#include "support/stopwatch.hpp"

namespace rays {

namespace {

/// Their sums take 100 bytes each, of the device's memory and, on file, of the host's.
constexpr std::int64_t mostPixels = std::int64_t{1} << 26;
/// What is darker than this part of white counts as so bright, where errors are compared with brightness.
constexpr double darkest = 0.05;
/// So that a run that is stopped loses no more than this.
constexpr double millisecondsBetweenStates = 30000.0;

/// Nothing is kept without a file.
class StateKeeper {
 public:
  StateKeeper(Exposure& exposure, const Scene& scene, const Resuming& resuming)
      : exposure_(exposure), file_(resuming.state) {
    if (file_.empty()) return;
    identity_ = identityOf(scene, resuming.device);
    if (std::filesystem::exists(file_)) exposure_.restore(loadState(file_, identity_));
  }

  void saveAfter(double milliseconds) {
    if (file_.empty() || sinceSaved_.milliseconds() < milliseconds) return;
    saveState(file_, identity_, exposure_.gathered());
    sinceSaved_ = {};
  }

 private:
  Exposure& exposure_;
  std::filesystem::path file_;
  Identity identity_;
  examples::Stopwatch sinceSaved_;
};

}  // namespace

bool isLook(std::int64_t samples, std::int64_t least) {
  if (samples <= least) return samples == least;
  const auto n = static_cast<std::uint64_t>(samples);
  const std::uint64_t odd = n >> std::countr_zero(n);
  return odd == 1 || odd == 3;
}

Rendering render(Renderer& renderer, const Scene& scene, const Resuming& resuming) {
  const Output& output = scene.output;
  const double limit = output.seconds > 0 ? 1000 * output.seconds : HUGE_VAL;
  const Tolerance tolerance{output.error, darkest / output.exposure};
  Exposure& exposure = renderer.exposure();
  StateKeeper keeper(exposure, scene, resuming);
  Rendering rendering;
  rendering.samples = rendering.resumed = exposure.passes();
  rendering.unfinished = exposure.activePixels();
  examples::Progress progress("rendering", output.samples);
  const examples::Stopwatch stopwatch;
  while (rendering.samples < output.samples && rendering.unfinished > 0 &&
         (rendering.samples == rendering.resumed || stopwatch.milliseconds() < limit)) {
    renderer.pass(rendering.samples++);
    if (output.error > 0 && isLook(rendering.samples, output.least))
      rendering.unfinished = exposure.narrow(tolerance);
    if (exposure.space().isFirst()) progress.update(rendering.samples);
    keeper.saveAfter(millisecondsBetweenStates);
  }
  rendering.radiance = exposure.image();
  rendering.milliseconds = stopwatch.milliseconds();
  if (rendering.samples > rendering.resumed) keeper.saveAfter(0);
  const std::vector<int> counts = exposure.counts();
  rendering.perPixel =
      std::accumulate(counts.begin(), counts.end(), 0.0) / std::max<double>(1.0, double(counts.size()));
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
  if (ending != ".png" && ending != ".pfm" && ending != ".exr")
    throw std::runtime_error(
        fmt::format("'{}': pictures are .png, .pfm or .exr files", scene.output.picture.string()));
  if (ending == ".exr") needExr(scene.output.picture);
  if (scene.picture.width == 0 || scene.picture.height == 0)
    throw std::runtime_error(fmt::format("a picture of {} x {} pixels has none; give it a size",
                                         scene.picture.width, scene.picture.height));
  if (std::int64_t{scene.picture.width} * scene.picture.height > mostPixels)
    throw std::runtime_error(fmt::format("a picture of {} x {} pixels is too large; it may have {}",
                                         scene.picture.width, scene.picture.height, mostPixels));
}

void saveRendering(const Rendering& rendering, const Scene& scene, const std::vector<Layer>& layers) {
  checkOutput(scene);
  const Picture& picture = scene.picture;
  if (scene.output.picture.extension() == ".exr")
    return saveExr(scene.output.picture, picture.width, picture.height, rendering.radiance, layers);
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
