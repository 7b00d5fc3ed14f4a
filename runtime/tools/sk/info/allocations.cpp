// SPDX-License-Identifier: MIT
//
// The memory that a driver provides, beyond what it guarantees: creates the largest possible stream, then
// writes and reads its last element. Each attempt has its own device, so that all memory is released.
#include <cstdint>
#include <vector>

#include "info/device_info.hpp"
#include "sk/error.hpp"

namespace sk_tool {

namespace {

template <class T>
bool fits(const sk::DeviceOptions& options, const sk::Shape& shape, const T& value) {
  try {
    sk::Device device(options);
    auto stream = device.stream<T>(shape);
    sk::Index last = sk::Index::origin(shape.rank());
    sk::Index end = last;
    for (int d = 0; d < shape.rank(); ++d) {
      last[d] = shape[d] - 1;
      end[d] = shape[d];
    }
    const std::vector<T> given(1, value);
    auto element = stream.domain(last, end);
    element.write(given);
    return element.read() == given;
  } catch (const sk::Error&) {
    return false;
  }
}

/// The largest of `most`, three quarters of it, half of it, ... that fits; 0 if none does.
template <class Fits>
std::int64_t largest(std::int64_t most, const Fits& thatFits) {
  for (std::int64_t size = most; size > 1; size /= 2) {
    if (thatFits(size)) return size;
    if (thatFits(size / 4 * 3)) return size / 4 * 3;
  }
  return 0;
}

}  // namespace

Json probeAllocations(sk::Device& device) {
  const sk::DeviceOptions options = optionsOf(device);
  const std::int64_t side = device.limits().textureSize;
  const std::int64_t wide = largest(
      side, [&](std::int64_t n) { return fits(options, {1, n}, 42.0F) && fits(options, {n, 1}, 42.0F); });
  const std::int64_t rows =
      largest(side, [&](std::int64_t n) { return fits(options, {n, wide}, sk::float4{1, 2, 3, 4}); });
  sk::DeviceOptions small = options;
  small.textureLimit = 16;  // a layer has 256 elements
  const std::int64_t layers =
      largest(device.limits().textureLayers, [&](std::int64_t n) { return fits(small, {256 * n}, 42.0F); });
  return {{"texture_side", wide},
          {"texture_layers", layers},
          {"texture_bytes", rows * wide * static_cast<std::int64_t>(sizeof(sk::float4))}};
}

}  // namespace sk_tool
