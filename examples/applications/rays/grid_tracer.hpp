// SPDX-License-Identifier: MIT
//
// Rays that are on the device already, through a grid, by either machine.
#pragma once

#include <cstdint>
#include <string>

#include <sk/sk.hpp>

#include "device_scene.hpp"
#include "grid.hpp"
#include "model.hpp"
#include "pass_meter.hpp"
#include "ray_streams.hpp"
#include "streaming.sk.hpp"

namespace rays {

/// A uniform grid and its shapes on a device.
struct GridScene : DeviceShapes {
  GridScene(sk::Device& onDevice, const Model& ofModel, const GridSettings& settings,
            HowToIntersect howToIntersect);

  /// Refers to the streams.
  kernels::Grid grid() const {
    return {.lattice = lattice,
            .cells = cells,
            .lists = lists,
            .intersection = static_cast<unsigned>(intersection)};
  }

  HowToIntersect intersection;
  kernels::Lattice lattice{};
  sk::Stream<int> cells, lists;
  std::string size;  ///< for the report; empty where there are no shapes
};

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
