// SPDX-License-Identifier: MIT
//
// Rays that are on the device already, through a grid, by either machine.
#pragma once

#include <cstdint>

#include <sk/sk.hpp>

#include "grid_scene.hpp"
#include "stream_tracer.hpp"

namespace rays {

enum class Machine : std::uint8_t { Branching, Multipass };

/// What paths do, as in segment.sk.
enum class Use : std::uint8_t { Paths, Whitted, ShadowCasting, RayCasting };

struct StreamingSettings {
  Machine machine = Machine::Branching;
  Use use = Use::Paths;
  HowToIntersect intersection = HowToIntersect::Watertight;
  GridSettings grid;
  int tests = 4;          ///< shapes that a multipass call tests a ray against
  int rounds = 8;         ///< of both multipass kernels, until rays are counted
  double compact = 0.75;  ///< multipass: rays are compacted when at most this part is on its way
};

/// What a multipass trace took.
struct RoundCount {
  std::int64_t rounds = 0;
  std::int64_t compactions = 0;
  std::int64_t slots = 0;  ///< elements of all rounds, whether their rays were on their way or not
};

class GridTracer : public StreamTracer {
 public:
  /// `scene` must outlive it.
  GridTracer(GridScene& scene, const StreamingSettings& settings) : scene_(scene), settings_(settings) {}

  void find(bool anyHit, const sk::Stream<sk::float4>& from, const sk::Stream<sk::float4>& along,
            sk::Stream<kernels::Found>& found) override;

  /// Since the beginning, of the multipass machine.
  const RoundCount& count() const { return count_; }

 private:
  void findByPasses(bool anyHit, const sk::Stream<sk::float4>& from, const sk::Stream<sk::float4>& along,
                    sk::Stream<kernels::Found>& found);
  void round(bool anyHit, const sk::Stream<sk::float4>& from, const sk::Stream<sk::float4>& along,
             sk::Stream<kernels::Travel>& travel);

  GridScene& scene_;
  StreamingSettings settings_;
  RoundCount count_;
};

}  // namespace rays
