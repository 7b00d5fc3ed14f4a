// SPDX-License-Identifier: MIT
//
// The buffer in which the work groups of a dispatch tell each other what they have done.
#pragma once

#include <cstdint>

#include "gl/bound_state.hpp"
#include "gl/object_name.hpp"
#include "gl/pixel_buffer.hpp"

namespace sk::gl {

class StateBuffer {
 public:
  /// Binds it as the buffer that programs read and write (binding 0), with `words` words of 32 bits, all 0; false if
  /// memory is exhausted. Commands before have ended with finishStorage(). The context must be current.
  bool bindZeros(BoundState& bound, std::int64_t words);

 private:
  ObjectName<deleteBuffer> name_;  ///< created on first use
  std::int64_t words_ = 0;
};

}  // namespace sk::gl
