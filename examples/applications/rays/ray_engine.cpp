// SPDX-License-Identifier: MIT
#include "ray_engine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "device_scene.hpp"
#include "octree.hpp"
#include "ray_engine.sk.hpp"
#include "ray_streams.hpp"
#include "ray_tree.hpp"
#include "streaming_renderer.hpp"
#include "support/stopwatch.hpp"

namespace rays {
namespace {

using examples::Range;
using examples::SceneTable;

constexpr std::array<std::string_view, 3> testNames = {"watertight", "moller", "modified"};
constexpr std::size_t bucketWidth = 64;
/// Shapes that a kernel takes in one call.
constexpr std::size_t mostShapes = 64;
/// Rays of one tree, which only grows.
constexpr std::size_t batch = std::size_t{1} << 16;

bool isFinite(const sk::float3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// ab x ac of each triangle, computed once.
std::vector<sk::float4> normalsOf(const Model& model) {
  std::vector<sk::float4> normals;
  for (const Triangle& t : model.triangles) {
    const auto a = examples::vecOf<double>(t.a);
    const sk::float3 n = toFloat3(cross(examples::vecOf<double>(t.b) - a, examples::vecOf<double>(t.c) - a));
    normals.push_back({n.x, n.y, n.z, 0});
  }
  return normals;
}

/// Streams of a bucket, which stay with the device for the buckets to come.
struct Slot {
  sk::Stream<sk::float4> from, along;
  sk::Stream<kernels::Found> found;
};

/// A bucket on the device.
struct Flight {
  Slot slot;
  std::vector<std::uint32_t> rays;
  sk::Future<kernels::Found> found;
};

class OctreeEngine : public RayEngine, public StreamTracer {
 public:
  OctreeEngine(sk::Device& device, const Model& model, const RayEngineSettings& settings)
      : shapes_(device, model),
        settings_(settings),
        octree_(model, settings.leaf),
        normals_(streamOf(device, normalsOf(model))) {}

  void closest(std::span<const Ray> rays, std::span<Hit> hits) override {
    trace(rays, [&](std::size_t ray, const kernels::Found& f) {
      hits[ray] = f.which.x < 0 ? Hit{} : Hit{f.which.x, f.hit.x, f.hit.y, f.hit.z};
    });
  }

  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) override {
    trace(rays, [&](std::size_t ray, const kernels::Found& f) { blocked[ray] = f.which.x >= 0 ? 1 : 0; });
  }

  void find(bool, const sk::Stream<sk::float4>& from, const sk::Stream<sk::float4>& along,
            sk::Stream<kernels::Found>& found) override {
    const std::vector<sk::float4> begins = from.read(), ways = along.read();
    std::vector<Ray> rays;
    rays.reserve(begins.size());
    for (std::size_t i = 0; i < begins.size(); ++i)
      rays.push_back({{begins[i].x, begins[i].y, begins[i].z},
                      begins[i].w,
                      {ways[i].x, ways[i].y, ways[i].z},
                      ways[i].w});
    std::vector<kernels::Found> all(rays.size());
    trace(rays, [&](std::size_t ray, const kernels::Found& f) { all[ray] = f; });
    found.write(all);
  }

  std::unique_ptr<Renderer> renderer(const Picture& picture) override {
    return makeMultipassRenderer(shapes_, *this, picture, Use::Paths);
  }

  const BucketCount& count() const override { return count_; }
  const Model& model() const override { return shapes_.model; }
  TriangleTest triangleTest() const override {
    return {.isWatertight = settings_.test == BucketTest::Watertight};
  }

  std::vector<std::string> account() override {
    return {
        fmt::format("octree: {} nodes, built in {:.0f} ms", octree_.nodes(), octreeMilliseconds_),
        fmt::format("{} rays in {} buckets, {} calls, {:.1f} tests for each ray", count_.rays, count_.buckets,
                    count_.calls, double(count_.tests) / double(std::max<std::int64_t>(count_.rays, 1)))};
  }

 private:
  /// Calls `arrive` for each ray, in any order.
  template <class Arrive>
  void trace(std::span<const Ray> rays, const Arrive& arrive) {
    flights_.clear();  // of a trace that an error has ended
    const auto capacity = static_cast<std::size_t>(settings_.bucket);
    for (std::size_t first = 0; first < rays.size(); first += batch) {
      const std::span<const Ray> some = rays.subspan(first, std::min(batch, rays.size() - first));
      RayTree tree(some, capacity);
      const auto land = [&](std::size_t mostLeft) {
        while (flights_.size() > mostLeft)
          landOne([&](std::size_t ray, const kernels::Found& f) { arrive(first + ray, f); });
      };
      for (std::size_t i = 0; i < some.size(); ++i) {
        const Ray& r = some[i];
        // What is no ray hits nothing.
        if (!isFinite(r.origin) || !isFinite(r.direction) || !(r.most >= r.least))
          arrive(first + i, missed(r));
        else
          tree.insert(static_cast<std::uint32_t>(i));
        if (tree.size() < capacity * static_cast<std::size_t>(settings_.cache)) continue;
        send(some, tree.take());
        land(static_cast<std::size_t>(settings_.inFlight));
      }
      while (tree.size() > 0) {
        send(some, tree.take());
        land(static_cast<std::size_t>(settings_.inFlight));
      }
      land(0);
    }
  }

  static kernels::Found missed(const Ray& r) { return {{r.most, 0, 0}, {-1, -1}}; }

  Slot takeSlot() {
    if (!free_.empty()) {
      Slot slot = std::move(free_.back());
      free_.pop_back();
      return slot;
    }
    const sk::Shape shape{settings_.bucket / static_cast<int>(bucketWidth), static_cast<int>(bucketWidth)};
    sk::Device& device = shapes_.device;
    return {device.stream<sk::float4>(shape), device.stream<sk::float4>(shape),
            device.stream<kernels::Found>(shape)};
  }

  void send(std::span<const Ray> rays, std::vector<std::uint32_t> bucket) {
    // The last ray fills the bucket up.
    std::vector<sk::float4> from, along;
    Bundle bundle;
    for (std::size_t i = 0; i < static_cast<std::size_t>(settings_.bucket); ++i) {
      const Ray& r = rays[bucket[std::min(i, bucket.size() - 1)]];
      from.push_back({r.origin.x, r.origin.y, r.origin.z, r.least});
      along.push_back({r.direction.x, r.direction.y, r.direction.z, r.most});
      bundle.grow(r, i == 0);
    }
    Slot slot = takeSlot();
    slot.from.writeAsync(from);
    slot.along.writeAsync(along);
    kernels::startBucket(shapes_.scene().planes, slot.from, slot.along, slot.found);
    test(octree_.shapesOf(bundle), slot);
    if (shapes_.hasSpheres())
      kernels::finishBucket(shapes_.scene().shapes, slot.from, slot.along, slot.found, slot.found);
    count_.rays += static_cast<std::int64_t>(bucket.size());
    ++count_.buckets;
    sk::Future<kernels::Found> found = slot.found.readAsync();
    flights_.push_back({std::move(slot), std::move(bucket), std::move(found)});
  }

  void test(const std::vector<int>& shapes, Slot& slot) {
    const auto perCall = static_cast<std::size_t>(settings_.shapesPerCall);
    for (std::size_t first = 0; first < shapes.size(); first += perCall) {
      const std::size_t count = std::min(perCall, shapes.size() - first);
      std::array<int, mostShapes> chosen{};
      std::copy_n(shapes.begin() + static_cast<std::ptrdiff_t>(first), count, chosen.begin());
      kernels::testBucket(static_cast<unsigned>(settings_.test), shapes_.scene().shapes, normals_,
                          static_cast<int>(count), chosen, slot.from, slot.along, slot.found, slot.found);
      ++count_.calls;
    }
    count_.tests += static_cast<std::int64_t>(shapes.size()) * settings_.bucket;
  }

  template <class Arrive>
  void landOne(const Arrive& arrive) {
    Flight flight = std::move(flights_.front());
    flights_.pop_front();
    const std::vector<kernels::Found> found = flight.found.get();
    for (std::size_t i = 0; i < flight.rays.size(); ++i) arrive(flight.rays[i], found[i]);
    free_.push_back(std::move(flight.slot));
  }

  DeviceShapes shapes_;
  RayEngineSettings settings_;
  examples::Stopwatch building_;
  Octree octree_;
  double octreeMilliseconds_ = building_.milliseconds();
  sk::Stream<sk::float4> normals_;
  std::deque<Flight> flights_;
  std::vector<Slot> free_;
  BucketCount count_;
};

RayEngineSettings settingsOf(const SceneTable& table) {
  RayEngineSettings s;
  table.read("intersection", s.test, testNames);
  table.read("bucket", s.bucket, Range{64, 65536});
  if (s.bucket % static_cast<int>(bucketWidth) != 0)
    table.fail("bucket", "'bucket' is a multiple of 64, for buckets are 64 rays wide");
  table.read("cache", s.cache, Range{1, 4096});
  table.read("shapes_per_call", s.shapesPerCall, Range{1, mostShapes});
  table.read("in_flight", s.inFlight, Range{0, 64});
  table.read("leaf", s.leaf, Range{1, 1000});
  return s;
}

}  // namespace

std::unique_ptr<RayEngine> makeRayEngine(sk::Device& device, const Model& model,
                                         const RayEngineSettings& settings) {
  return std::make_unique<OctreeEngine>(device, model, settings);
}

MakeEngine readRayEngine(const std::optional<SceneTable>& table) {
  const RayEngineSettings settings = table ? settingsOf(*table) : RayEngineSettings{};
  return [settings](sk::Device& device, const Model& model) -> std::unique_ptr<Engine> {
    return makeRayEngine(device, model, settings);
  };
}

}  // namespace rays
