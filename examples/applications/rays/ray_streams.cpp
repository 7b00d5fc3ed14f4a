// SPDX-License-Identifier: MIT
#include "ray_streams.hpp"

#include <cstdint>
#include <vector>

namespace rays {

RayStreams uploadRays(sk::Device& device, std::span<const Ray> rays) {
  std::vector<sk::float4> from, along;
  from.reserve(rays.size());
  along.reserve(rays.size());
  for (const Ray& r : rays) {
    from.push_back({r.origin.x, r.origin.y, r.origin.z, r.least});
    along.push_back({r.direction.x, r.direction.y, r.direction.z, r.most});
  }
  const sk::Shape shape{static_cast<std::int64_t>(rays.size())};
  RayStreams streams{device.stream<sk::float4>(shape), device.stream<sk::float4>(shape)};
  streams.from.write(from);
  streams.along.write(along);
  return streams;
}

}  // namespace rays
