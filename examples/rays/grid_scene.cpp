// SPDX-License-Identifier: MIT
#include "grid_scene.hpp"

#include <numeric>

#include <fmt/format.h>

#include "support/stopwatch.hpp"

namespace rays {

GridScene::GridScene(sk::Device& onDevice, const Model& ofModel, const GridSettings& settings, HowToIntersect howToIntersect)
    : device(onDevice), model(ofModel), intersection(howToIntersect) {
  const examples::Stopwatch stopwatch;
  UniformGrid built = buildGrid(model, settings);
  const double milliseconds = stopwatch.milliseconds();
  contracted = !device.name().starts_with("native");
  hasTriangles = !model.triangles.empty();
  hasSpheres = !model.spheres.empty();
  hasPlanes = !model.planes.empty();
  planeCount = static_cast<int>(model.planes.size());
  firstPlane = model.planeId(0);
  grid = {built.bounds.least, built.bounds.most, built.cell, built.size};
  planes = streamOf(device, planeLayout(model));
  std::vector<std::uint32_t> order(model.triangles.size() + model.spheres.size());
  std::iota(order.begin(), order.end(), 0u);
  shapes = streamOf(device, shapeLayout(order, model));
  if (!order.empty()) {
    size_ = fmt::format("grid: {} triangles, {} spheres in {} x {} x {} cells, {:.0f} % of them empty, {:.1f} entries for each shape, "
                        "{} in the longest list, built in {:.0f} ms",
                        model.triangles.size(), model.spheres.size(), built.size.x, built.size.y, built.size.z,
                        100.0 * double(built.starts.size() - std::size_t(built.occupied)) / double(built.starts.size()),
                        double(built.entries) / double(order.size()), built.longest, milliseconds);
  }
  cells = streamOf(device, std::move(built.starts));
  lists = streamOf(device, std::move(built.lists));
}

std::vector<std::string> GridScene::account() const {
  if (size_.empty()) return {};
  return {size_};
}

}  // namespace rays
