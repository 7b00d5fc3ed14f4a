// SPDX-License-Identifier: MIT
//
// Rays that are on the device already, through a grid, by either machine.
#pragma once

#include <cstdint>

#include <sk/sk.hpp>

#include "grid_scene.hpp"
#include "pass_meter.hpp"
#include "stream_tracer.hpp"

namespace rays {

enum class Machine : std::uint8_t { Branching, Multipass };

/// What paths do, as in segment.sk.
enum class Use : std::uint8_t { Paths, Whitted, ShadowCasting, RayCasting };

struct StreamingSettings {
  Machine machine = Machine::Branching;
  Use use = Use::Paths;
  HowToIntersect intersection = HowToIntersect::Watertight;
  GridSettings grid{};
  int tests = 4;          ///< shapes that a multipass call tests a ray against
  int rounds = 8;         ///< of both multipass kernels, until rays are counted
  double compact = 0.75;  ///< multipass: rays are compacted when at most this part is on its way
};

class GridTracer : public StreamTracer {
 public:
  /// The scene and the meter must outlive it.
  GridTracer(GridScene& scene, const StreamingSettings& settings, PassMeter* meter = nullptr)
      : scene_(scene), settings_(settings), meter_(meter) {}

  void find(bool anyHit, const sk::Stream<sk::float4>& from, const sk::Stream<sk::float4>& along,
            sk::Stream<kernels::Found>& found) override;

 private:
  void findByPasses(bool anyHit, const sk::Stream<sk::float4>& from, const sk::Stream<sk::float4>& along,
                    sk::Stream<kernels::Found>& found);
  void round(bool anyHit, const sk::Stream<sk::float4>& from, const sk::Stream<sk::float4>& along,
             sk::Stream<kernels::Travel>& travel);

  GridScene& scene_;
  StreamingSettings settings_;
  PassMeter* meter_;
};

}  // namespace rays
