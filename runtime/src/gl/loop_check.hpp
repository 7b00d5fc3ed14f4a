// SPDX-License-Identifier: MIT
//
// The buffer in which programs report that the driver has ended their loops early (assemble/glsl/loop_check.glsl).
#pragma once

#include <cstdint>
#include <optional>

#include "gl/bound_state.hpp"
#include "gl/buffer.hpp"
#include "gl/object_name.hpp"

namespace sk::gl {

/// Requires Capabilities::storesFromDraws. The context must be current in all calls.
class LoopCheck {
 public:
  /// Binds the buffer at binding 1; creates it on first use.
  void bind(BoundState& bound);
  /// What the programs have reported since the last call: the number of one of those that were cut short, or 0. Waits for them.
  /// Nullopt if the driver does not map the buffer.
  std::optional<std::int32_t> take(BoundState& bound);

 private:
  ObjectName<deleteBuffer> buffer_;
};

}  // namespace sk::gl
