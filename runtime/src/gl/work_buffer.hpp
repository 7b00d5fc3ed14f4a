// SPDX-License-Identifier: MIT
//
// A buffer that dispatches work on, kept for later ones as long as it is used.
#pragma once

#include <cstddef>

#include "gl/bound_state.hpp"
#include "gl/object_name.hpp"
#include "gl/pixel_buffer.hpp"

namespace sk::gl {

class WorkBuffer {
 public:
  /// Binds it at binding 0, with room for `bytes` undefined bytes; false if memory is exhausted. The context must be
  /// current.
  bool bind(BoundState& bound, std::size_t bytes);
  /// Sets its first bytes, a multiple of 4, to 0. It must be bound.
  static void clear(std::size_t bytes);
  /// Releases it if no dispatch has used it for a number of calls. Must be called once per call.
  void trim();

 private:
  static constexpr int keptCalls = 16;

  ObjectName<deleteBuffer> name_;  ///< created on first use
  std::size_t bytes_ = 0;
  int idle_ = 0;  ///< calls since the last use
};

}  // namespace sk::gl
