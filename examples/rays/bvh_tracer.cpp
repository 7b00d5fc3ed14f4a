// SPDX-License-Identifier: MIT
#include "bvh_tracer.hpp"

#include <algorithm>

#include <sk/algorithm.hpp>

#include "wavefront.sk.hpp"

namespace rays {
namespace {

/// Cells along each axis that keys tell apart.
constexpr float cells = 512.0f;

float scaleOf(float least, float most) { return cells / std::max(most - least, 0x1p-60f); }

}  // namespace

sk::Stream<int> BvhTracer::keys(const sk::Stream<sk::float4>& from,
                                const sk::Stream<sk::float4>& along) const {
  const Bounds box = scene_.bvh().nodes[0].bounds;
  sk::Stream<int> keys = scene_.device().stream<int>(from.shape());
  kernels::rayKeys(sort_ == RaySort::Origin ? 0u : 1u, box.least,
                   sk::float3{scaleOf(box.least.x, box.most.x), scaleOf(box.least.y, box.most.y),
                              scaleOf(box.least.z, box.most.z)},
                   from, along, keys);
  return keys;
}

void BvhTracer::find(bool anyHit, const sk::Stream<sk::float4>& from, const sk::Stream<sk::float4>& along,
                     sk::Stream<kernels::Found>& found) {
  if (from.size() == 0) return;
  if (sort_ == RaySort::None || scene_.bvh().nodes.empty())
    scene_.call(kernels::findInHierarchy, anyHit, from, along, found);
  else
    scene_.call(kernels::findInOrder, anyHit, sk::order(keys(from, along)), from, along, found);
}

}  // namespace rays
