// SPDX-License-Identifier: MIT
//
// Hits of rays that are on the device already, and whose hits stay there.
#pragma once

#include <sk/sk.hpp>

#include "streaming.sk.hpp"

namespace rays {

class StreamTracer {
 public:
  virtual ~StreamTracer() = default;

  /// The nearest hit of each ray, or any. All streams have rank 1 and one size. A ray whose greatest distance is negative hits nothing.
  virtual void find(bool anyHit, const sk::Stream<sk::float4>& from, const sk::Stream<sk::float4>& along,
                    sk::Stream<kernels::Found>& found) = 0;
};

}  // namespace rays
