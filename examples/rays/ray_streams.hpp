// SPDX-License-Identifier: MIT
//
// Rays of the host as streams, in the layout that kernels take them in.
#pragma once

#include <span>

#include <sk/sk.hpp>

#include "model.hpp"

namespace rays {

struct RayStreams {
  sk::Stream<sk::float4> from;   ///< origin, least distance
  sk::Stream<sk::float4> along;  ///< direction, greatest distance
};

RayStreams uploadRays(sk::Device& device, std::span<const Ray> rays);

}  // namespace rays
