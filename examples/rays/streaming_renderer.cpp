// SPDX-License-Identifier: MIT
#include "streaming_renderer.hpp"

#include <utility>
#include <vector>

#include "path_tables.hpp"
#include "streaming_path.sk.hpp"

namespace rays {
namespace {

class StreamingRenderer : public Renderer {
 public:
  StreamingRenderer(GridScene& scene, GridTracer& tracer, const Picture& picture, const StreamingSettings& settings)
      : scene_(scene),
        tracer_(tracer),
        picture_(picture),
        settings_(settings),
        tables_(scene.device, scene.model, picture),
        exposure_(scene.device, picture) {}

  void pass(std::int64_t index) override {
    const auto sample = static_cast<std::uint32_t>(index);
    if (settings_.machine == Machine::Branching) followInOneCall(sample);
    else followInManyCalls(sample);
    exposure_.add();
  }

  std::vector<sk::float3> image() override { return exposure_.image(); }

  std::vector<std::string> account() override { return {tables_.account()}; }

 private:
  /// Paths that have not ended, in the order of their pixels.
  struct Paths {
    Paths(sk::Device& device, const sk::Shape& shape)
        : from(device.stream<sk::float4>(shape)),
          along(device.stream<sk::float4>(shape)),
          path(device.stream<kernels::Path>(shape)),
          pixel(device.stream<sk::int2>(shape)) {}

    sk::Stream<sk::float4> from, along;
    sk::Stream<kernels::Path> path;
    sk::Stream<sk::int2> pixel;
  };

  void followInOneCall(std::uint32_t sample) {
    const PathTables& t = tables_;
    scene_.call(kernels::followPathsInGrid, t.features, static_cast<unsigned>(t.sampling), static_cast<unsigned>(settings_.use), t.view,
                t.setting, sample, t.seed, t.materials, t.corners, t.lights, t.sky, t.texels, t.textures, exposure_.radiance);
  }

  void followInManyCalls(std::uint32_t sample) {
    const PathTables& t = tables_;
    sk::Device& device = scene_.device;
    const std::int64_t count = std::int64_t{picture_.width} * picture_.height;
    Paths paths(device, {count});
    kernels::generatePaths(t.features, static_cast<unsigned>(t.sampling), t.view, t.setting, sample, t.seed,
                           sk::iter(0, static_cast<int>(count)), paths.from, paths.along, paths.path, paths.pixel);
    for (int segment = 0; paths.path.size() > 0; ++segment) {
      shade(sample, segment, paths);
      kernels::deliverLight(paths.path, paths.along, paths.pixel, exposure_.radiance);
      Paths next(device, {0});
      kernels::keepPaths(paths.from, paths.along, paths.path, paths.pixel, next.from, next.along, next.path, next.pixel);
      paths = std::move(next);
    }
  }

  /// Traces the rays of a segment, and those to lights.
  void shade(std::uint32_t sample, int segment, Paths& paths) {
    const PathTables& t = tables_;
    sk::Device& device = scene_.device;
    auto found = device.stream<kernels::Found>(paths.from.shape());
    tracer_.find(false, paths.from, paths.along, found);
    auto shadowFrom = device.stream<sk::float4>(paths.from.shape()), shadowAlong = device.stream<sk::float4>(paths.from.shape());
    auto shadowLight = device.stream<sk::float3>(paths.from.shape());
    kernels::shadePaths(static_cast<unsigned>(scene_.intersection), scene_.contracted, scene_.hasTriangles, scene_.hasSpheres,
                        scene_.planes, scene_.shapes, t.features, static_cast<unsigned>(t.sampling),
                        static_cast<unsigned>(settings_.use), t.setting, sample, t.seed, segment, t.materials, t.corners, t.lights,
                        t.sky, t.texels, t.textures, paths.from, paths.along, found, paths.pixel, paths.path, paths.from, paths.along,
                        paths.path, shadowFrom, shadowAlong, shadowLight);
    if (t.setting.lights == 0 || settings_.use == Use::RayCasting || segment + 1 == picture_.depth) return;
    tracer_.find(true, shadowFrom, shadowAlong, found);
    kernels::addLight(found, shadowLight, paths.path, paths.path);
  }

  GridScene& scene_;
  GridTracer& tracer_;
  Picture picture_;
  StreamingSettings settings_;
  PathTables tables_;
  Exposure exposure_;
};

}  // namespace

std::unique_ptr<Renderer> makeStreamingRenderer(GridScene& scene, GridTracer& tracer, const Picture& picture,
                                                const StreamingSettings& settings) {
  return std::make_unique<StreamingRenderer>(scene, tracer, picture, settings);
}

}  // namespace rays
