// SPDX-License-Identifier: MIT
#include "device_scene.hpp"

#include <utility>

#include <fmt/format.h>

#include "support/progress.hpp"
#include "support/stopwatch.hpp"

namespace rays {
namespace {

/// Seconds of building that are worth a progress bar.
constexpr std::size_t manyShapes = 200'000;

Bvh built(const Model& model, const BvhSettings& settings) {
  const std::size_t shapes = model.triangles.size() + model.spheres.size();
  if (shapes < manyShapes) return buildBvh(model.triangles, model.spheres, settings);
  examples::Progress progress("building the hierarchy", static_cast<std::int64_t>(shapes));
  Bvh bvh =
      buildBvh(model.triangles, model.spheres, settings, [&](std::int64_t done) { progress.update(done); });
  progress.clear();
  return bvh;
}

}  // namespace

DeviceScene::DeviceScene(sk::Device& device, const Model& model, const DeviceSettings& settings)
    : device_(&device), model_(&model) {
  const examples::Stopwatch stopwatch;
  bvh_ = built(model, settings.bvh);
  milliseconds_ = stopwatch.milliseconds();
  const bool isNative = device.name().starts_with("native");
  intersection_ = settings.intersection;
  precision_ = settings.precision;
  traversal_ = settings.traversal.value_or(isNative ? HowToTraverse::Stack : HowToTraverse::Leaves);
  contracted_ = !isNative;
  hasTriangles_ = !model.triangles.empty();
  hasSpheres_ = !model.spheres.empty();
  hasPlanes_ = !model.planes.empty();
  nodeCount_ = static_cast<int>(bvh_.nodes.size());
  planeCount_ = static_cast<int>(model.planes.size());
  firstPlane_ = model.planeId(0);
  planes_ = streamOf(device, planeLayout(model));
  nodes_ = streamOf(device, traversal_ == HowToTraverse::Skip ? skipLayout(bvh_) : pairLayout(bvh_));
  shapes_ = streamOf(device, shapeLayout(bvh_.order, model));
}

std::vector<std::string> DeviceScene::account() const {
  if (bvh_.nodes.empty()) return {};
  return {fmt::format(
      "hierarchy: {} triangles, {} spheres in {} nodes, {} levels, expected cost {:.1f}, built in {:.0f} ms",
      model_->triangles.size(), model_->spheres.size(), bvh_.nodes.size(), bvh_.depth, bvh_.cost,
      milliseconds_)};
}

}  // namespace rays
