// SPDX-License-Identifier: MIT
#include "account.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "support/stopwatch.hpp"

namespace rays {
namespace {

/// A renderer and the shortest time of a sample of the picture. The first one compiles the kernels and does not count.
struct Measured {
  std::unique_ptr<Renderer> renderer;
  std::int64_t samples = 0;
  double milliseconds = HUGE_VAL;

  std::vector<sk::float3> sample() {
    const examples::Stopwatch stopwatch;
    renderer->pass(samples++);
    std::vector<sk::float3> image = renderer->image();
    if (samples > 1) milliseconds = std::min(milliseconds, stopwatch.milliseconds());
    return image;
  }
};

double sumOf(const std::vector<sk::float3>& pixels) {
  double sum = 0.0;
  for (const sk::float3& p : pixels) sum += double(p.x) + double(p.y) + double(p.z);
  return sum;
}

}  // namespace

Account accountFor(Engine& engine, const Scene& scene) {
  Picture full = scene.picture;
  full.everything = true;
  Measured own{engine.renderer(scene.picture)}, all{engine.renderer(full)};
  std::vector<sk::float3> ownImage, allImage;
  for (int i = 0; i < 8; ++i) {
    ownImage = own.sample();
    allImage = all.sample();
  }
  examples::Verification agreement(
      "light of the picture with and without what the scene does not name", 1e-3,
      "a path that a rounding turns at an edge, of a device that compiles both otherwise");
  const double light = sumOf(ownImage);
  agreement.compare(0, sumOf(allImage), light, std::max(light, 1e-30));
  return {fmt::format("a sample of the picture takes {:.3g} ms; with all that a scene may name it would take "
                      "{:.3g} ms, {:.2f} times as much",
                      own.milliseconds, all.milliseconds, all.milliseconds / own.milliseconds),
          agreement};
}

}  // namespace rays
