// SPDX-License-Identifier: MIT
//
// Buffers of a driver: those that programs read and write, and those through which texels are transferred.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "gl/bound_state.hpp"
#include "gl/errors.hpp"
#include "gl/object_name.hpp"

namespace sk::gl {

void deleteBuffer(BoundState& bound, GLuint name);

/// Reads the first bytes of the buffer that is bound to `target`. If the driver fails, it reports an error.
void readBuffer(const BoundState& bound, GLenum target, std::span<std::byte> bytes);

/// A buffer that programs read and write, at binding 0. It is created on first use and grows when needed. The context must
/// be current in all calls.
class StorageBuffer {
 public:
  enum class Use : std::uint8_t {
    Scratch,  ///< dispatches of one call work on it
    Persistent,  ///< its bytes are 0 at first and stay between calls, so that a log may bind it again
    Values,  ///< a dispatch leaves values in it for the host. A GPU transfers bytes of a buffer in a fraction of the time that
    ///< reading a texel takes, because texels go through its graphics pipeline
    HostReads,  ///< the host sees its bytes at any time (GL_ARB_buffer_storage), and reads them
    HostWrites,  ///< likewise, and writes them
  };

  explicit StorageBuffer(Use use) : use_(use) {}

  /// Makes room for `bytes` bytes, which are undefined if it grows, unless it is Persistent; false if memory is exhausted. The
  /// device must have finished with a buffer that the host sees.
  bool reserve(BoundState& bound, std::size_t bytes);
  /// Binds it at binding 0.
  void bind(BoundState& bound);
  /// Both.
  bool bind(BoundState& bound, std::size_t bytes);
  /// Sets the first bytes of the bound buffer, a multiple of 4, to 0.
  static void clear(const BoundState& bound, std::size_t bytes);
  /// Reads what programs have written to its beginning; waits for them.
  void read(BoundState& bound, std::span<std::byte> values) const;
  /// What the host sees. What a program has written is there once a fence after finishMapped() is reached; what the host has
  /// written is there for all later commands.
  std::byte* bytes() const { return bytes_; }
  /// Releases it if it is larger than `keptBytes` and nothing has used it for a number of calls. Must be called once per call.
  void trim(std::size_t keptBytes);

 private:
  static constexpr int keptCalls = 16;

  bool isMapped() const { return use_ == Use::HostReads || use_ == Use::HostWrites; }

  Use use_;
  ObjectName<deleteBuffer> name_;  ///< its end unmaps it
  std::byte* bytes_ = nullptr;
  std::size_t size_ = 0;
  int idle_ = 0;  ///< calls since the last use
};

/// Makes what programs have written to mapped buffers visible to the host, once a later fence is reached.
inline void finishMapped(BoundState& bound) {
  bound.spoil();
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
}

/// A buffer for transferring texels to or from host memory without waiting.
class PixelBuffer {
 public:
  PixelBuffer() = default;
  explicit PixelBuffer(Deletions& deletions) : name_(deletions, [] { return generated(glGenBuffers); }) {}

  GLuint name() const { return name_.get(); }
  explicit operator bool() const { return static_cast<bool>(name_); }

 private:
  ObjectName<deleteBuffer> name_;
};

/// Binds a buffer as the source or target of texel transfers as long as this object lives: addresses of
/// texels are then offsets in the buffer.
class BoundPixels {
 public:
  enum class Way : GLenum { Read = GL_PIXEL_PACK_BUFFER, Write = GL_PIXEL_UNPACK_BUFFER };

  BoundPixels(const PixelBuffer& buffer, Way way) : BoundPixels(buffer.name(), way) {}
  BoundPixels(GLuint buffer, Way way) : target_(static_cast<GLenum>(way)) { glBindBuffer(target_, buffer); }
  ~BoundPixels() { glBindBuffer(target_, 0); }
  BoundPixels(const BoundPixels&) = delete;
  BoundPixels& operator=(const BoundPixels&) = delete;

  /// Allocates new, undefined bytes; pending commands keep the old ones. False if memory is exhausted.
  bool allocate(Errors& errors, std::size_t bytes) const;
  /// Maps all bytes until unmap(): for reading after a read, else for overwriting everything. Null if the
  /// driver fails.
  std::byte* map(std::size_t bytes) const;
  /// Its size in bytes; 0 if there is no buffer.
  std::size_t size(Errors& errors) const;
  /// False if the driver has lost the written data.
  bool unmap() const { return glUnmapBuffer(target_) == GL_TRUE; }

 private:
  GLenum target_;
};

}  // namespace sk::gl
