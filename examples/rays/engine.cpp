// SPDX-License-Identifier: MIT
#include "engine.hpp"

#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "bvh_engine.hpp"
#include "exposure.hpp"
#include "ray_engine.hpp"
#include "streaming_engine.hpp"

namespace rays {

std::span<const EngineKind> engineKinds() {
  static constexpr std::array kinds = {
      EngineKind{"bvh", "a hierarchy of boxes, all in one kernel", readBvhEngine},
      EngineKind{"streaming", "a uniform grid in streams (Purcell and others, 2002)", readStreamingEngine},
      EngineKind{"ray_engine", "buckets of rays that the host sends (Carr and others, 2002)", readRayEngine},
  };
  return kinds;
}

void refuseDivided(const Picture& picture, std::string_view what) {
  if (picture.grid == nullptr) return;
  throw std::runtime_error(
      fmt::format("{} keeps lists of all rays on one device, but the pixels are divided over ranks; take "
                  "--engine bvh, or "
                  "start it without mpirun",
                  what));
}

std::vector<sk::float3> Renderer::image() { return exposure().image(); }

std::vector<sk::float3> Renderer::variance() { return exposure().variance(); }

}  // namespace rays
