// SPDX-License-Identifier: MIT
//
// The buffer in which work groups leave what they have folded (assemble/reduce/group_fold.hpp). Its first word is 0 between
// dispatches, which set it back themselves, so that a loop may repeat them.
#pragma once

#include <cstddef>

#include "gl/bound_state.hpp"
#include "gl/object_name.hpp"
#include "gl/pixel_buffer.hpp"

namespace sk::gl {

class FoldBuffer {
 public:
  /// Binds it at binding 0, with room for `bytes` bytes; false if memory is exhausted. The context must be current.
  bool bind(BoundState& bound, std::size_t bytes);

 private:
  ObjectName<deleteBuffer> name_;  ///< created on first use
  std::size_t bytes_ = 0;
};

}  // namespace sk::gl
