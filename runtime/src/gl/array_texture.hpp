// SPDX-License-Identifier: MIT
//
// A stack of 2-D textures of one format behind one sampler, without filtering, without mipmaps.
#pragma once

#include "gl/format.hpp"
#include "gl/object_name.hpp"
#include "gl/texture.hpp"

namespace sk::gl {

class BoundState;

class ArrayTexture {
 public:
  /// Undefined texels. Afterwards name() is 0 where the driver had no memory.
  ArrayTexture(BoundState& bound, const Format& format, GLsizei width, GLsizei height, GLsizei layers);

  /// Copies the first width x height texels of a framebuffer, whose texture has the same format, to a
  /// layer, bit for bit.
  void copyLayer(BoundState& bound, GLuint framebuffer, GLint layer, GLsizei width, GLsizei height);

  GLuint name() const { return name_.get(); }

 private:
  ObjectName<deleteTexture> name_;
};

}  // namespace sk::gl
