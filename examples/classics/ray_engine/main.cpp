// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "classics/support/classic.hpp"
#include "ray_engine.sk.hpp"
#include "support/vec.hpp"

using namespace ray_engine;
using classics::larger, host::Node, host::Ray;
constexpr int bucketSize = 256, leafSize = 32, triangleCount = 6402, codeBits = 60;
constexpr sk::float2 miss = {1e30f, -1};

/// Appends the octree of triangles first to last - 1, whose sorted codes agree in the bits above `shift`.
void grow(const std::vector<std::uint64_t>& codes, int first, int last, int shift, std::vector<Node>& nodes) {
  const std::size_t at = nodes.size();
  nodes.push_back({first, last, 0, {}, {}});
  for (int begin = first, end = first; last - first > leafSize && shift >= 0 && begin < last; begin = end) {
    while (end < last && codes[end] >> shift == codes[begin] >> shift) ++end;
    grow(codes, begin, end, shift - 5, nodes);
  }
  nodes[at].next = int(nodes.size());
}

struct Way {
  int side, perPass = triangleCount;  // of the picture; triangles that a pass tests
  bool splits = true;  // false: buckets in order of arrival
  std::size_t inFlight = 8;  // buckets on the device while the host goes on
};

struct Engine {
  sk::Device processor = sk::Device::native();
  RayEngineStreams d;  // of the device
  host::RayEngineStreams h{processor, triangleCount};  // of the host
  sk::Stream<sk::float3> picture;
  Way way;
  std::vector<Ray> made;  // for the next cache
  std::vector<std::pair<sk::Stream<Ray>, sk::Future<sk::float2>>> flights;
  std::vector<std::pair<Ray, sk::float2>> sample;  // of all traces
  std::int64_t rays, buckets, splits, passes, tests;
  explicit Engine(sk::Device& device) : d(device, triangleCount) {
    std::vector<Node> nodes;
    host::tessellate(h.triangles, h.code);
    sk::sort(h.code, h.triangles);
    grow(h.code.read(), 0, triangleCount, codeBits - 5, nodes);
    nodes.resize(triangleCount);  // which the root leaves out
    h.octree.write(nodes);
    host::bound(h.triangles, h.octree, h.octree);
    d.triangles.write(h.triangles.read());
  }
  void trace() {
    rays = buckets = splits = passes = tests = 0;
    picture = processor.stream<sk::float3>({way.side, way.side});
    host::look(picture, h.made);
    for (std::vector<Ray> cache = h.made.read(); !cache.empty(); cache = std::exchange(made, {})) {
      if (way.splits) std::ranges::sort(cache, {}, &Ray::code);
      split(cache, way.splits ? codeBits - 2 : -1);
      while (!flights.empty()) land();
    }
  }
  // A bucket that overflows splits into four. It halves the two dimensions of five that were halved longest ago.
  void split(std::span<const Ray> all, int shift) {
    for (; shift < 0 && all.size() > bucketSize; all = all.subspan(bucketSize)) send(all.first(bucketSize));
    if (all.size() <= bucketSize) return send(all);
    if (all.front().code >> shift != all.back().code >> shift) ++splits;
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
      while (end < all.size() && all[end].code >> shift == all[begin].code >> shift) ++end;
      split(all.subspan(begin, end - begin), shift - 2);
    }
  }
  void send(std::span<const Ray> some) {
    sk::Stream<Ray> bucket = processor.stream<Ray>({std::ssize(some)});
    bucket.write(some);
    h.isMet.fill(0);
    host::walk(h.octree, bucket, h.isMet);
    host::list(h.octree, h.isMet, h.candidates);
    host::load(bucket, h.rays);
    const int all = int(h.candidates.size());
    d.candidates.domain({0}, {all}).writeAsync(h.candidates.read());
    d.rays.writeAsync(h.rays.read());
    d.hits.fill(miss);
    for (int first = 0; first < all; first += way.perPass, ++passes)
      intersect(d.triangles, d.candidates, first, std::min(all, first + way.perPass), d.rays, d.hits, d.hits);
    flights.emplace_back(std::move(bucket), d.hits.readAsync());
    ++buckets;
    rays += std::ssize(some);
    tests += std::ssize(some) * all;
    if (flights.size() > way.inFlight) land();
  }
  void land() {
    auto [bucket, future] = std::move(flights.front());
    flights.erase(flights.begin());
    const std::vector<sk::float2> hits = future.get();
    h.hits.write(hits);
    host::shade(h.triangles, h.hits, bucket, picture, h.made);
    for (const Ray& ray : h.made.read()) made.push_back(ray);
    if (buckets % (1 + picture.size() / 500) > 0) return;
    for (std::size_t i = 0; const Ray& ray : bucket.read()) sample.emplace_back(ray, hits[i++]);
  }
  double perRay() const { return double(tests) / double(rays); }
};

/// How far hits are from what plain loops in double find, as shares of the lengths whose products are rounded.
double errorOf(const Engine& engine, double bound) {
  const auto vec = examples::vecOf<double>;
  const std::vector<Triangle> triangles = engine.h.triangles.read();
  double error = 0;
  for (const auto& [ray, hit] : engine.sample) {
    const bool isHit = hit.x > 0 && hit.y >= 0 && hit.y < triangleCount && hit.y == std::floor(hit.y);
    if (!isHit && hit != miss) return HUGE_VAL;
    for (int id = 0; id < triangleCount; ++id) {
      const auto& [a, b, ab, ac, cb, n] = triangles[id];
      const auto d = vec(ray.direction), ao = vec(ray.origin) - vec(a), bo = vec(ray.origin) - vec(b);
      const auto aod = cross(ao, d), bod = cross(bo, d);
      const double u = dot(vec(ac), aod), v = -dot(vec(ab), aod), w = dot(vec(cb), bod);
      const double inside = std::max(std::min({u, v, w}), -std::max({u, v, w}));
      if (inside < 0 && id != hit.y) continue;
      const double size = (length(vec(ab)) + length(vec(ac))) * (length(ao) + length(bo));
      const double t = -dot(vec(n), ao) / dot(vec(n), d);
      const double scale = std::abs(dot(vec(n), d)) / length(vec(n)) / (length(ao) + std::abs(t));
      if (inside > bound * size && t * scale > bound) error = larger(error, (hit.x - t) * scale);
      if (id == hit.y) error = larger(larger(error, -inside / size), std::abs(hit.x - t) * scale);
    }
  }
  return error;
}

int main(int argc, char** argv) {
  const classics::Classic about{"ray_engine", "Carr, Hall, Hart 2002", "pixels along a side", 400, 16, 1024};
  return classics::run(argc, argv, about, [](classics::Run& run) {
    Engine e(run.device());
    const int side = run.size(), part = (side + 2) / 3;
    const auto tracing = [&e](Way way) { return [&e, way] { e.way = way, e.trace(); }; };
    tracing({.side = side, .splits = false})();
    run.say("in order of arrival: {} buckets, {:.1f} tests a ray", e.buckets, e.perRay());
    run.timed(tracing({.side = side}));
    run.say("by the ray tree: {} buckets, {} splits, {:.1f} tests a ray", e.buckets, e.splits, e.perRay());
    run.say("{} rays, {} triangles: {} tests in {} passes; the octree saved {}", e.rays, triangleCount,
            e.tests, e.passes, e.rays * triangleCount - e.tests);
    run.check(fmt::format("hits of {} rays", e.sample.size()), errorOf(e, 0x1p-20), 0x1p-20, "16 roundings");
    run.picture("ray_engine.png", examples::imageOf(side, side, e.picture.read()));
    const auto standard = tracing({.side = part});
    run.ratio("buckets as rays arrive / by the tree", tracing({.side = part, .splits = false}), standard, 3);
    run.ratio("host and device in turn / at once", tracing({.side = part, .inFlight = 0}), standard, 3);
    run.ratio("a pass for each triangle / each bucket", tracing({.side = part, .perPass = 1}), standard, 1);
    e.d.t.fill(0), e.d.id.fill(0), e.d.uvw.fill({0, 0, 0});
    const auto unpacked = [&] { e.d.t.read(), e.d.id.read(), e.d.uvw.read(); };
    run.ratio("a bucket back as t, id, u, v, w / packed", unpacked, [&] { e.d.hits.read(); }, 99);
  });
}
