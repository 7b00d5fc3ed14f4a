// SPDX-License-Identifier: MIT
//
// The buffer in which the work groups of a dispatch tell each other their results.
#pragma once

#include <cstddef>

#include "gl/bound_state.hpp"
#include "gl/object_name.hpp"
#include "gl/pixel_buffer.hpp"

namespace sk::gl {

class ChainBuffer {
 public:
  /// Binds it at binding 0, with `bytes` bytes, a multiple of 4, that are 0; false if memory is exhausted. The context
  /// must be current.
  bool bindCleared(BoundState& bound, std::size_t bytes);

 private:
  ObjectName<deleteBuffer> name_;  ///< created on first use
  std::size_t bytes_ = 0;
};

}  // namespace sk::gl
