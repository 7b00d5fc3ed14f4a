// SPDX-License-Identifier: MIT
//
// Embree 3 (I. Wald and others, "Embree: a kernel framework for efficient CPU ray tracing", 2014) on all cores: one ray at a time as it is by
// default and with RTC_SCENE_FLAG_ROBUST, which is watertight as ours are, and in packets of eight.
#include <embree3/rtcore.h>

#include <cstring>
#include <memory>
#include <vector>

#include "contender.hpp"
#include "rays_layout.hpp"

namespace race {
namespace {

class EmbreeHits final : public Task {
 public:
  EmbreeHits(const Problem& p, RTCSceneFlags flags, bool inPackets)
      : p_(p), inPackets_(inPackets), result_(static_cast<std::size_t>(2 * p.size())) {
    device_ = rtcNewDevice(nullptr);
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, flags);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    const std::vector<float>& corners = p.floats[rayCorners];
    const std::size_t points = corners.size() / 3;
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, points),
                corners.data(), corners.size() * sizeof(float));
    auto* faces = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, points / 3));
    for (std::size_t i = 0; i < points; ++i) faces[i] = static_cast<unsigned>(i);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeHits() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  void run(int times) override {
    constexpr std::int64_t chunk = 1024;
    const std::int64_t n = p_.size();
    for (int i = 0; i < times; ++i) {
#pragma omp parallel for schedule(dynamic)
      for (std::int64_t first = 0; first < n; first += chunk) {
        for (std::int64_t at = first; at < n && at < first + chunk;)
          at += inPackets_ && at + 8 <= n ? eight(at) : one(at);
      }
    }
  }

  std::vector<float> result() override { return result_; }

 private:
  const float* origin(std::int64_t i) const {
    return &p_.floats[rayOrigins][static_cast<std::size_t>(4 * i)];
  }
  const float* direction(std::int64_t i) const {
    return &p_.floats[rayDirections][static_cast<std::size_t>(4 * i)];
  }

  void note(std::int64_t i, unsigned geometry, unsigned triangle, float t) {
    const bool isHit = geometry != RTC_INVALID_GEOMETRY_ID;
    result_[static_cast<std::size_t>(i)] = isHit ? static_cast<float>(triangle) : -1.0f;
    result_[static_cast<std::size_t>(p_.size() + i)] = isHit ? t : -1.0f;
  }

  std::int64_t one(std::int64_t i) {
    const float *o = origin(i), *d = direction(i);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    ray.ray = {o[0], o[1], o[2], o[3], d[0], d[1], d[2], 0, d[3], ~0u, 0, 0};
    ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &ray);
    note(i, ray.hit.geomID, ray.hit.primID, ray.ray.tfar);
    return 1;
  }

  std::int64_t eight(std::int64_t first) {
    alignas(32) static constexpr int all[8] = {-1, -1, -1, -1, -1, -1, -1, -1};
    alignas(64) RTCRayHit8 packet{};
    for (int k = 0; k < 8; ++k) {
      const float *o = origin(first + k), *d = direction(first + k);
      packet.ray.org_x[k] = o[0];
      packet.ray.org_y[k] = o[1];
      packet.ray.org_z[k] = o[2];
      packet.ray.tnear[k] = o[3];
      packet.ray.dir_x[k] = d[0];
      packet.ray.dir_y[k] = d[1];
      packet.ray.dir_z[k] = d[2];
      packet.ray.tfar[k] = d[3];
      packet.ray.mask[k] = ~0u;
      packet.hit.geomID[k] = packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect8(all, scene_, &context, &packet);
    for (int k = 0; k < 8; ++k)
      note(first + k, packet.hit.geomID[k], packet.hit.primID[k], packet.ray.tfar[k]);
    return 8;
  }

  const Problem& p_;
  bool inPackets_;
  std::vector<float> result_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

}  // namespace
}  // namespace race

RACE_ADD_PEERS(std::vector<race::Contender>& contenders) {
  using namespace race;
  const auto add = [&](const char* program, const char* name, RTCSceneFlags flags, bool inPackets) {
    contenders.push_back(
        {program, name, [=](const Problem& p) { return std::make_unique<EmbreeHits>(p, flags, inPackets); }});
  };
  for (const char* program : rayPrograms) {
    add(program, "Embree", RTC_SCENE_FLAG_NONE, false);
    add(program, "Embree packets", RTC_SCENE_FLAG_NONE, true);
    add(program, "Embree robust", RTC_SCENE_FLAG_ROBUST, false);
  }
}
