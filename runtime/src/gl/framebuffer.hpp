// SPDX-License-Identifier: MIT
//
// A framebuffer of whole textures, or of one layer of each. Each texture is a colour attachment and a draw
// buffer.
#pragma once

#include <span>
#include <vector>

#include "gl/format.hpp"
#include "gl/object_name.hpp"

namespace sk::gl {

void deleteFramebuffer(BoundState& bound, GLuint name);

class Framebuffer {
 public:
  Framebuffer() = default;
  /// Attaches one or more `textures` in order: either 2-D textures, or the first layers of array textures.
  Framebuffer(BoundState& bound, std::span<const GLuint> textures, bool isLayered);

  /// Attaches another layer of all textures, which must be array textures.
  void selectLayer(BoundState& bound, GLint layer);

  GLuint name() const { return name_.get(); }
  explicit operator bool() const { return static_cast<bool>(name_); }
  /// Whether the driver can draw to it. It must be the framebuffer created or bound last.
  static bool isComplete() { return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE; }
  /// Reads a rectangle of texels from its first texture, row by row without gaps. Waits for the device.
  void read(BoundState& bound, const Transfer& transfer, GLint x, GLint y, GLsizei width, GLsizei height,
            void* texels) const;
  /// Whether an ES driver can read its first texture with this transfer, in addition to the wide one.
  bool readsOnEs(BoundState& bound, const Transfer& transfer) const;

 private:
  ObjectName<deleteFramebuffer> name_;
  std::vector<GLuint> layered_;   ///< textures whose layers are attached
  GLint layer_ = 0;
};

}  // namespace sk::gl
