// SPDX-License-Identifier: MIT
//
// A buffer whose memory the host and programs of the device reach at any time (GL_ARB_buffer_storage).
#pragma once

#include <cstddef>

#include "gl/bound_state.hpp"
#include "gl/object_name.hpp"
#include "gl/pixel_buffer.hpp"

namespace sk::gl {

class MappedBuffer {
 public:
  enum class Access : GLbitfield { HostReads = GL_MAP_READ_BIT, HostWrites = GL_MAP_WRITE_BIT };

  explicit MappedBuffer(Access access) : access_(static_cast<GLbitfield>(access)) {}

  /// Makes room for `bytes` bytes, which are undefined if it grows; false if memory is exhausted. The device must have
  /// finished with the buffer, and the context must be current.
  bool reserve(BoundState& bound, std::size_t bytes);
  /// Binds it at binding 0, where programs read and write it.
  void bind(BoundState& bound) const { bound.storage(name_.get()); }
  /// The host's view. What a program has written is there once a fence after finishMapped() is reached; what the host has
  /// written is there for all later commands.
  std::byte* bytes() const { return bytes_; }

 private:
  GLbitfield access_;
  ObjectName<deleteBuffer> name_;  ///< created on first use; its end unmaps it
  std::byte* bytes_ = nullptr;
  std::size_t size_ = 0;
};

/// Makes what programs have written to mapped buffers visible to the host, once a later fence is reached.
inline void finishMapped(BoundState& bound) {
  bound.spoil();
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
}

}  // namespace sk::gl
