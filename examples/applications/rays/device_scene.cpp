// SPDX-License-Identifier: MIT
#include "device_scene.hpp"

#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

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

struct TraversalDefault {
  HowToTraverse traversal;
  int nodes;
};

/// What was fastest on devices of a kind in the study of speed (docs/rays.md).
TraversalDefault fastestOn(const sk::Device& device) {
  if (device.name().starts_with("native")) return {HowToTraverse::Stack, wideChildren};
  if (device.isSoftware()) return {HowToTraverse::Leaves, 2};
  return {HowToTraverse::Stack, 2};
}

/// A copy where shapes are to be rounded, else none.
std::unique_ptr<Model> copyToRound(const Model& model, VertexStorage storage) {
  return storage == VertexStorage::Half ? std::make_unique<Model>(model) : nullptr;
}

std::vector<std::uint32_t> ownOrder(const Model& model) {
  std::vector<std::uint32_t> order(model.triangles.size() + model.spheres.size());
  std::iota(order.begin(), order.end(), 0u);
  return order;
}

}  // namespace

DeviceShapes::DeviceShapes(sk::Device& onDevice, const Model& ofModel, std::span<const std::uint32_t> order,
                           VertexStorage storage)
    : device(onDevice),
      model(ofModel),
      inHalves(storage == VertexStorage::Half),
      planes(streamOf(onDevice, planeLayout(ofModel))),
      floats(streamOf(onDevice, inHalves ? std::vector<sk::float4>{} : shapeLayout(order, ofModel))) {
  HalfLayout layout;
  if (inHalves) layout = halfLayout(order, ofModel);
  halves = streamOf(onDevice, std::move(layout.rows));
  numbers = streamOf(onDevice, std::move(layout.numbers));
}

DeviceShapes::DeviceShapes(sk::Device& onDevice, const Model& ofModel)
    : DeviceShapes(onDevice, ofModel, ownOrder(ofModel)) {}

kernels::Scene DeviceShapes::scene() const {
  return {.shapes = {.floats = floats,
                     .halves = halves,
                     .numbers = numbers,
                     .triangles = hasTriangles(),
                     .spheres = hasSpheres(),
                     .contracted = !device.name().starts_with("native")},
          .planes = {.rows = planes,
                     .count = static_cast<int>(model.planes.size()),
                     .firstId = model.planeId(0),
                     .exist = !model.planes.empty()}};
}

std::string_view nameOf(HowToTraverse way) {
  switch (way) {
    case HowToTraverse::Stack: return "stack";
    case HowToTraverse::Leaves: return "leaves";
    case HowToTraverse::Skip: return "skip";
  }
  return "";
}

DeviceScene::DeviceScene(sk::Device& device, const Model& given, const DeviceSettings& settings)
    : device_(&device),
      rounded_(copyToRound(given, settings.storage)),
      model_(rounded_ ? rounded_.get() : &given) {
  if (rounded_) rounding_ = roundToHalves(*rounded_);
  const Model& model = *model_;
  const examples::Stopwatch stopwatch;
  bvh_ = built(model, settings.bvh);
  milliseconds_ = stopwatch.milliseconds();
  intersection_ = settings.intersection;
  precision_ = settings.precision;
  const TraversalDefault fastest = fastestOn(device);
  traversal_ = settings.traversal.value_or(fastest.traversal);
  // Links are for two children, and there are at most as many wide nodes as others.
  const bool canBeWide = traversal_ != HowToTraverse::Skip && bvh_.nodes.size() <= mostWideNodes;
  width_ = settings.nodes.value_or(canBeWide ? fastest.nodes : 2);
  isChosen_ = !settings.traversal && !settings.nodes;
  WideBvh wide;
  std::vector<sk::float4> nodes;
  if (width_ == wideChildren)
    wide = widen(bvh_);
  else
    nodes = traversal_ == HowToTraverse::Skip ? skipLayout(bvh_) : pairLayout(bvh_);
  nodes_ = streamOf(device, std::move(nodes));
  wide_ = streamOf(device, std::move(wide.nodes));
  children_ = streamOf(device, std::move(wide.children));
  shapes_.emplace(device, model, bvh_.order, settings.storage);
}

void DeviceScene::explain(const sk::Error& error) const {
  const bool isAboutDoubles = precision_ == sk::Precision::Double &&
                              error.kind() == sk::Error::Kind::Device &&
                              std::string_view(error.what()).find("no doubles") != std::string_view::npos;
  if (isAboutDoubles)
    throw std::runtime_error(
        fmt::format("'{}' has no doubles; write precision = \"extended\" in [bvh] for pairs of floats, or "
                    "choose another device",
                    device_->name()));
}

kernels::Hierarchy DeviceScene::hierarchy() const {
  // As in hierarchy.sk: Stack, Leaves, Skip, and the first two of them for nodes of eight; both tests in floats, then both in halves.
  return {.nodes = nodes_,
          .wide = wide_,
          .children = children_,
          .nodeCount = static_cast<int>(bvh_.nodes.size()),
          .traversal = static_cast<unsigned>(traversal_) + (width_ == wideChildren ? 3u : 0u),
          .test = static_cast<unsigned>(intersection_) + (shapes_->inHalves ? 2u : 0u)};
}

std::vector<std::string> DeviceScene::account() const {
  if (bvh_.nodes.empty()) return {};
  std::vector<std::string> lines = {
      fmt::format("hierarchy: {} triangles, {} spheres in {} nodes, {} levels, expected cost {:.1f}, "
                  "built in {:.0f} ms",
                  model_->triangles.size(), model_->spheres.size(), bvh_.nodes.size(), bvh_.depth, bvh_.cost,
                  milliseconds_),
      fmt::format("rays go through nodes of {} children, traversal \"{}\"{}", width_, nameOf(traversal_),
                  isChosen_ ? ", the fastest on such a device" : "")};
  if (rounded_)
    lines.push_back(fmt::format(
        "shapes are in halves, {} bytes each in place of {}; the farthest vertex is {:.2g} from where the "
        "file "
        "has it",
        bytesOfShape(VertexStorage::Half), bytesOfShape(VertexStorage::Single), rounding_.farthest));
  return lines;
}

std::vector<std::string> DeviceScene::warnings() const {
  if (rounding_.collapsed == 0) return {};
  return {
      fmt::format("halves leave {} of {} triangles without an area, so that no ray meets them; storage = "
                  "\"single\" keeps them",
                  rounding_.collapsed, model_->triangles.size())};
}

}  // namespace rays
