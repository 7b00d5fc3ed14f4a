// SPDX-License-Identifier: MIT
//
// A 2-D texture of one of our formats, without filtering, without mipmaps.
#pragma once

#include "gl/format.hpp"
#include "gl/object_name.hpp"

namespace sk::gl {

class BoundState;

GLuint newTexture();
void deleteTexture(GLuint name);
/// One level, no filter, for the texture that is bound to a target.
void setNearest(GLenum target);

class Texture {
 public:
  Texture() = default;
  /// Undefined texels. Afterwards name() is 0 where the driver had no memory.
  Texture(BoundState& bound, const Format& format, GLsizei width, GLsizei height);

  /// Writes a rectangle of texels (format().tight), row by row without gaps.
  void write(BoundState& bound, GLint x, GLint y, GLsizei width, GLsizei height, const void* texels);

  GLuint name() const { return name_.get(); }
  const Format& format() const { return *format_; }
  GLsizei width() const { return width_; }
  GLsizei height() const { return height_; }
  std::size_t bytes() const;
  void forget() noexcept { name_.forget(); }

 private:
  ObjectName<deleteTexture> name_;
  const Format* format_ = nullptr;
  GLsizei width_ = 0;
  GLsizei height_ = 0;
};

}  // namespace sk::gl
