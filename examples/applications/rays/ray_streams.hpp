// SPDX-License-Identifier: MIT
//
// Rays on the device: those of the host, in the layout that kernels take them in, and what finds hits that stay there.
#pragma once

#include <span>

#include <sk/sk.hpp>

#include "model.hpp"
#include "streaming.sk.hpp"

namespace rays {

struct RayStreams {
  sk::Stream<sk::float4> from;   ///< origin, least distance
  sk::Stream<sk::float4> along;  ///< direction, greatest distance
};

RayStreams uploadRays(sk::Device& device, std::span<const Ray> rays);

class StreamTracer {
 public:
  virtual ~StreamTracer() = default;

  /// The nearest hit of each ray, or any. All streams have rank 1 and one size. A ray whose greatest distance is negative hits nothing.
  virtual void find(bool anyHit, const sk::Stream<sk::float4>& from, const sk::Stream<sk::float4>& along,
                    sk::Stream<kernels::Found>& found) = 0;
};

}  // namespace rays
