// SPDX-License-Identifier: MIT
//
// Embree 3 (I. Wald and others, "Embree: a kernel framework for efficient CPU ray tracing", 2014) on the rays of the study of speed, on one
// thread: one ray at a time and in packets of eight, as it is by default and with RTC_SCENE_FLAG_ROBUST.
#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "bvh_engine.hpp"
#include "camera.hpp"
#include "pass_meter.hpp"
#include "study.hpp"
#include "support/table.hpp"

namespace rays {
namespace {

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

Owned<RTCScene> embreeScene(RTCDevice device, const Model& model, RTCSceneFlags flags) {
  Owned<RTCScene> scene(rtcNewScene(device));
  rtcSetSceneFlags(scene.get(), flags);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const std::size_t count = model.triangles.size();
  auto* points = static_cast<sk::float3*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(sk::float3), 3 * count));
  auto* faces = static_cast<sk::uint3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                                RTC_FORMAT_UINT3, sizeof(sk::uint3), count));
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle& t = model.triangles[i];
    const auto first = static_cast<std::uint32_t>(3 * i);
    points[3 * i] = t.a;
    points[3 * i + 1] = t.b;
    points[3 * i + 2] = t.c;
    faces[i] = {first, first + 1, first + 2};
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene.get());
  return scene;
}

void traceSingly(RTCScene scene, std::span<const Ray> rays, std::span<Hit> hits) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& r = rays[i];
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    ray.ray = {r.origin.x, r.origin.y, r.origin.z, r.least, r.direction.x, r.direction.y, r.direction.z, 0,
               r.most,     ~0u,        0,          0};
    ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context, &ray);
    const bool isHit = ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    hits[i] =
        isHit ? Hit{static_cast<std::int32_t>(ray.hit.primID), ray.ray.tfar, ray.hit.u, ray.hit.v} : Hit{};
  }
}

/// Whole packets; what is left is traced singly.
void traceInPackets(RTCScene scene, std::span<const Ray> rays, std::span<Hit> hits) {
  alignas(32) constexpr std::array<int, 8> all = {-1, -1, -1, -1, -1, -1, -1, -1};
  std::size_t i = 0;
  for (; i + 8 <= rays.size(); i += 8) {
    alignas(64) RTCRayHit8 packet{};
    for (std::size_t k = 0; k < 8; ++k) {
      const Ray& r = rays[i + k];
      packet.ray.org_x[k] = r.origin.x;
      packet.ray.org_y[k] = r.origin.y;
      packet.ray.org_z[k] = r.origin.z;
      packet.ray.dir_x[k] = r.direction.x;
      packet.ray.dir_y[k] = r.direction.y;
      packet.ray.dir_z[k] = r.direction.z;
      packet.ray.tnear[k] = r.least;
      packet.ray.tfar[k] = r.most;
      packet.ray.mask[k] = ~0u;
      packet.hit.geomID[k] = packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect8(all.data(), scene, &context, &packet);
    for (std::size_t k = 0; k < 8; ++k) {
      const bool isHit = packet.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
      hits[i + k] = isHit ? Hit{static_cast<std::int32_t>(packet.hit.primID[k]), packet.ray.tfar[k],
                                packet.hit.u[k], packet.hit.v[k]}
                          : Hit{};
    }
  }
  traceSingly(scene, rays.subspan(i), hits.subspan(i));
}

struct Compared {
  double rate = 0.0;  ///< millions a second
  std::size_t others = 0, onlyOne = 0;
};

Compared compare(RTCScene scene, bool inPackets, std::span<const Ray> rays, std::span<const Hit> ours,
                 int calls) {
  std::vector<Hit> hits(rays.size());
  const sk::Device processor = sk::Device::native();
  double best = HUGE_VAL;
  for (int i = 0; i < calls; ++i) {
    best = std::min(best, milliseconds(processor, [&] {
                      if (inPackets)
                        traceInPackets(scene, rays, hits);
                      else
                        traceSingly(scene, rays, hits);
                    }));
  }
  Compared compared{double(rays.size()) / best / 1e3};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].id == ours[i].id) continue;
    ++(hits[i].id < 0 || ours[i].id < 0 ? compared.onlyOne : compared.others);
  }
  return compared;
}

}  // namespace

Findings studyEmbree(sk::Device& device, bool isSmall) {
  const Model model = speedModel(isSmall);
  const int side = isSmall ? 48 : 512;
  const std::unique_ptr<Engine> engine = makeBvhEngine(device, model, {});
  const std::vector<Ray> primary = primaryRays(model.camera, side, side);
  const std::vector<Hit> hits = hitsOf(*engine, primary);
  const std::vector<Ray> diffuse = diffuseRays(model, primary, hits, primary.size());
  const std::vector<Hit> diffuseHits = hitsOf(*engine, diffuse);

  examples::Table table({"tracer", "rays", "primary, M/s", "diffuse, M/s", "other ids", "hits of one alone"});
  examples::Verification same("hits that Embree or this program has alone, of a million", 100.0,
                              "Embree's packets and default scenes are not watertight");
  const int calls = isSmall ? 1 : 5;
  table.add({"this program", "a kernel", fmt::format("{:.2f}", closestRate(device, model, primary, calls)),
             fmt::format("{:.2f}", closestRate(device, model, diffuse, calls)), "-", "-"});
  const Owned<RTCDevice> embree(rtcNewDevice("threads=1"));
  for (const bool isRobust : {false, true}) {
    const Owned<RTCScene> scene =
        embreeScene(embree.get(), model, isRobust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    for (const bool inPackets : {false, true}) {
      const Compared first = compare(scene.get(), inPackets, primary, hits, calls);
      const Compared second = compare(scene.get(), inPackets, diffuse, diffuseHits, calls);
      same.note(isRobust,
                1e6 * double(first.onlyOne + second.onlyOne) / double(primary.size() + diffuse.size()));
      table.add({isRobust ? "Embree, robust" : "Embree, default", inPackets ? "packets of 8" : "single",
                 fmt::format("{:.2f}", first.rate), fmt::format("{:.2f}", second.rate),
                 fmt::format("{}", first.others + second.others),
                 fmt::format("{}", first.onlyOne + second.onlyOne)});
    }
  }
  return {table.markdown(), {same}};
}

}  // namespace rays
