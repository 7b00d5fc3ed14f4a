// SPDX-License-Identifier: MIT
//
// A stable new order of a stream's elements, which a device may carry out itself (DeviceState::reorder).
#pragma once

#include <cstdint>
#include <span>

#include "sk/stream.hpp"

namespace sk {

struct Reordering {
  enum class By : std::uint8_t {
    Keys,  ///< sorted by keys
    DescendingKeys,
    Changes,  ///< keys that differ from the one before come first (sk::unique)
    Flags,  ///< elements whose flag is true, or not 0, come first
  };

  By by;
  StreamRegion keys;  ///< or flags; at least one
  std::span<const StreamRegion> moved = {};  ///< of the same shape, in different streams; may include `keys`
  const StreamRegion* places = nullptr;  ///< gets the number that each element had, of type int; or null

  bool choosesFirst() const { return by == By::Changes || by == By::Flags; }
};

}  // namespace sk
