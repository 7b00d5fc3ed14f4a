// SPDX-License-Identifier: MIT
//
// The buffer in which a dispatch leaves a value for the host. A GPU transfers bytes of a buffer in a fraction
// of the time that reading a texel takes, because texels go through its graphics pipeline.
#pragma once

#include <cstddef>
#include <span>

#include "gl/bound_state.hpp"
#include "gl/object_name.hpp"
#include "gl/pixel_buffer.hpp"

namespace sk::gl {

class ValueBuffer {
 public:
  /// The bytes of a plane: four components of 32 bits.
  static constexpr std::size_t planeBytes = 16;
  static constexpr std::size_t bytes = planeBytes * maxImageUnits;

  /// Binds it as the buffer that programs write (binding 0); false if memory is exhausted. The context must
  /// be current.
  bool bind(BoundState& bound);
  /// Reads what programs have written to its beginning, at most `bytes` bytes; waits for them.
  void read(BoundState& bound, std::span<std::byte> values) const;

 private:
  ObjectName<deleteBuffer> name_;  ///< created on first use
};

}  // namespace sk::gl
