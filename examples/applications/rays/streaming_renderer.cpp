// SPDX-License-Identifier: MIT
#include "streaming_renderer.hpp"

#include <utility>

#include "path_tables.hpp"
#include "streaming_path.sk.hpp"

namespace rays {
namespace {

class BranchingRenderer : public PathsRenderer {
 public:
  BranchingRenderer(GridScene& scene, const Picture& picture, Use use)
      : PathsRenderer(scene, picture), scene_(scene), use_(use) {}

  void pass(std::int64_t index) override {
    passBy([&](auto& radiance) {
      kernels::followPathsInGrid(scene(), scene_.grid(), static_cast<unsigned>(use_), sample(index),
                                 radiance);
    });
  }

 private:
  GridScene& scene_;
  Use use_;
};

/// Paths that have not ended, in the order of their pixels.
struct PathStreams {
  PathStreams(sk::Device& device, const sk::Shape& shape)
      : from(device.stream<sk::float4>(shape)),
        along(device.stream<sk::float4>(shape)),
        path(device.stream<kernels::Path>(shape)),
        pixel(device.stream<sk::int2>(shape)) {}

  sk::Stream<sk::float4> from, along;
  sk::Stream<kernels::Path> path;
  sk::Stream<sk::int2> pixel;
};

class MultipassRenderer : public PathsRenderer {
 public:
  MultipassRenderer(const DeviceShapes& shapes, StreamTracer& tracer, const Picture& picture, Use use,
                    PassMeter* meter)
      : PathsRenderer(shapes, picture), tracer_(tracer), depth_(picture.depth), use_(use), meter_(meter) {
    refuseDivided(picture, "a picture in several passes");
  }

  void pass(std::int64_t index) override {
    const std::int64_t count = exposure_.activePixels();
    PathStreams paths(shapes_.device, {count});
    metered(meter_, "generate", count, [&] {
      kernels::generatePaths(scene(), sample(index), sk::iter(0, static_cast<int>(count)), paths.from,
                             paths.along, paths.path, paths.pixel);
    });
    for (int segment = 0; paths.path.size() > 0; ++segment) {
      shade(index, segment, paths);
      auto kept = shapes_.device.stream<int>({0});
      metered(meter_, "end paths", paths.path.size(), [&] {
        kernels::deliverLight(paths.path, paths.along, paths.pixel, exposure_.radiance);
        kernels::keepPaths(paths.along, sk::iter(0, static_cast<int>(paths.path.size())), kept);
      });
      PathStreams next(shapes_.device, kept.shape());
      if (kept.size() > 0) {
        metered(meter_, "move paths", kept.size(), [&] {
          kernels::movePaths(kept, paths.from, paths.along, paths.path, paths.pixel, next.from, next.along,
                             next.path, next.pixel);
        });
      }
      paths = std::move(next);
    }
    exposure_.add();
  }

 private:
  /// Traces the rays of a segment, and those to lights.
  void shade(std::int64_t index, int segment, PathStreams& paths) {
    sk::Device& device = shapes_.device;
    const sk::Shape shape = paths.from.shape();
    auto found = device.stream<kernels::Found>(shape);
    tracer_.find(false, paths.from, paths.along, found);
    auto shadowFrom = device.stream<sk::float4>(shape), shadowAlong = device.stream<sk::float4>(shape);
    auto shadowLight = device.stream<sk::float3>(shape);
    metered(meter_, "shade", paths.from.size(), [&] {
      kernels::shadePaths({.scene = tables_.scene(shapes_),
                           .picture = sample(index),
                           .segment = segment,
                           .use = static_cast<unsigned>(use_),
                           .inHalves = shapes_.inHalves},
                          paths.from, paths.along, found, paths.pixel, paths.path, paths.from, paths.along,
                          paths.path, shadowFrom, shadowAlong, shadowLight);
    });
    if (tables_.lightCount == 0 || use_ == Use::RayCasting || segment + 1 == depth_) return;
    tracer_.find(true, shadowFrom, shadowAlong, found);
    metered(meter_, "add light", paths.from.size(),
            [&] { kernels::addLight(found, shadowLight, paths.path, paths.path); });
  }

  StreamTracer& tracer_;
  int depth_;
  Use use_;
  PassMeter* meter_;
};

}  // namespace

std::unique_ptr<Renderer> makeBranchingRenderer(GridScene& scene, const Picture& picture, Use use) {
  return std::make_unique<BranchingRenderer>(scene, picture, use);
}

std::unique_ptr<Renderer> makeMultipassRenderer(const DeviceShapes& shapes, StreamTracer& tracer,
                                                const Picture& picture, Use use, PassMeter* meter) {
  return std::make_unique<MultipassRenderer>(shapes, tracer, picture, use, meter);
}

}  // namespace rays
