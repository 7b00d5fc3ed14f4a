// SPDX-License-Identifier: MIT
#include "alike.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "bvh_engine.hpp"
#include "ray_engine.hpp"
#include "streaming_engine.hpp"

namespace rays {
namespace {

Mode bvhMode(std::string name, const DeviceSettings& settings) {
  return {std::move(name), [settings](sk::Device& device, const Model& model) {
            return makeBvhEngine(device, model, settings);
          }};
}

Mode streamingMode(std::string name, const StreamingSettings& settings) {
  return {std::move(name), [settings](sk::Device& device, const Model& model) {
            return makeStreamingEngine(device, model, settings);
          }};
}

Mode rayEngineMode(std::string name, const RayEngineSettings& settings) {
  return {std::move(name), [settings](sk::Device& device, const Model& model) -> std::unique_ptr<Engine> {
            return makeRayEngine(device, model, settings);
          }};
}

/// The sum of a pixel's components.
double total(const sk::float3& p) { return double(p.x) + p.y + p.z; }

}  // namespace

std::vector<Mode> allModes() {
  return {bvhMode("bvh", {}),
          bvhMode("bvh, stack", {.traversal = HowToTraverse::Stack}),
          bvhMode("bvh, leaves", {.traversal = HowToTraverse::Leaves}),
          bvhMode("bvh, skip", {.traversal = HowToTraverse::Skip}),
          bvhMode("bvh, nodes of two", {.nodes = 2}),
          bvhMode("bvh, nodes of eight", {.nodes = 8}),
          bvhMode("bvh, wavefront", {.machine = PathMachine::Wavefront}),
          bvhMode("bvh, wavefront, sorted", {.machine = PathMachine::Wavefront, .sort = RaySort::Origin}),
          bvhMode("bvh, in doubles", {.precision = sk::Precision::Double}),
          bvhMode("bvh, moller", {.intersection = HowToIntersect::Moller}),
          streamingMode("streaming, branching", {}),
          streamingMode("streaming, multipass", {.machine = Machine::Multipass}),
          rayEngineMode("ray_engine", {}),
          rayEngineMode("ray_engine, watertight", {.test = BucketTest::Watertight})};
}

Result resultOf(sk::Device& device, const Scene& scene, const Mode& mode) {
  const std::unique_ptr<Engine> engine = mode.make(device, scene.model);
  const std::unique_ptr<Renderer> renderer = engine->renderer(scene.picture);
  for (std::int64_t i = 0; i < scene.output.samples; ++i) renderer->pass(i);
  return {renderer->image(), renderer->variance()};
}

Likeness likenessOf(const Result& a, const Result& b) {
  Likeness likeness;
  const std::size_t count = std::min(a.radiance.size(), b.radiance.size());
  const auto n = static_cast<double>(count);
  double sum = 0.0, squares = 0.0, brightness = 0.0;
  for (std::size_t i = 0; i < count; ++i) brightness += total(b.radiance[i]) / n;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = total(a.radiance[i]), y = total(b.radiance[i]), d = x - y;
    sum += d;
    squares += d * d;
    if (!(std::abs(d) <= 1e-3 * std::abs(y))) likeness.differing += 1 / n;
    // What floats round, beside noise.
    const double rounding = 1e-4 * (brightness + y);
    const double variance = total(a.variance[i]) + total(b.variance[i]) + rounding * rounding;
    const double pixel = std::abs(d) / std::sqrt(variance);
    likeness.pixel = std::isnan(pixel) ? HUGE_VAL : std::max(likeness.pixel, pixel);
  }
  const double mean = sum / n, rounding = 1e-5 * brightness;
  const double variance = std::max(squares / n - mean * mean, 0.0) / n + rounding * rounding;
  likeness.mean = variance > 0 ? std::abs(mean) / std::sqrt(variance) : mean == 0 ? 0.0 : HUGE_VAL;
  if (a.radiance.size() != b.radiance.size() || count == 0) likeness.mean = HUGE_VAL;
  return likeness;
}

std::vector<std::filesystem::path> sceneFiles(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

}  // namespace rays
