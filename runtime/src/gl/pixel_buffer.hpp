// SPDX-License-Identifier: MIT
//
// A driver's buffer for transferring texels to or from host memory without waiting.
#pragma once

#include <cstddef>

#include "gl/errors.hpp"
#include "gl/object_name.hpp"

namespace sk::gl {

void deleteBuffer(BoundState& bound, GLuint name);

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
