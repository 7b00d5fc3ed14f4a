// SPDX-License-Identifier: MIT
//
// Stable orders of elements (sk/algorithm.hpp), computed on the host's cores from keys that a device hands over. The streams then
// bring their elements into them (StreamState::permute). Must not depend on the kind of device.
#pragma once

#include <cstdint>
#include <vector>

#include "device/device_state.hpp"

namespace sk {

struct HostOrder {
  std::vector<std::int32_t> sources;  ///< element i becomes what number sources[i] was, in row-major order
  std::int64_t first = 0;  ///< how many elements come first, if the order chooses them
};

/// The order that keys, or flags, ask for: at least one, and at most 2^31 - 1. NaNs come last. It does not depend on the number of
/// threads.
HostOrder hostOrder(Reordering::By by, const StreamRegion& keys);

/// Brings the streams of a reordering into an order, and writes its places. Throws what the streams throw; those that have moved
/// are lost then.
void bringInto(const Reordering& order, const HostOrder& found);

}  // namespace sk
