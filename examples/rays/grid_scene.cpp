// SPDX-License-Identifier: MIT
#include "grid_scene.hpp"

#include <fmt/format.h>

#include "support/stopwatch.hpp"

namespace rays {

GridScene::GridScene(sk::Device& onDevice, const Model& ofModel, const GridSettings& settings,
                     HowToIntersect howToIntersect)
    : DeviceShapes(onDevice, ofModel), intersection(howToIntersect) {
  const examples::Stopwatch stopwatch;
  UniformGrid built = buildGrid(model, settings);
  const double milliseconds = stopwatch.milliseconds();
  grid = {built.bounds.least, built.bounds.most, built.cell, built.size};
  if (hasShapes()) {
    const auto all = double(built.starts.size()),
               number = double(model.triangles.size() + model.spheres.size());
    size = fmt::format(
        "grid: {} triangles, {} spheres in {} x {} x {} cells, {:.0f} % of them empty, {:.1f} entries for "
        "each shape, "
        "{} in the longest list, built in {:.0f} ms",
        model.triangles.size(), model.spheres.size(), built.size.x, built.size.y, built.size.z,
        100.0 * (1.0 - double(built.occupied) / all), double(built.entries) / number, built.longest,
        milliseconds);
  }
  cells = streamOf(device, std::move(built.starts));
  lists = streamOf(device, std::move(built.lists));
}

}  // namespace rays
