// SPDX-License-Identifier: MIT
//
// A framebuffer over whole textures, or one layer of each, one a colour attachment, all of them drawn to.
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
  /// Attaches `textures` in order, 1 or more: all of them 2-D ones, or the first layers of array textures.
  Framebuffer(BoundState& bound, std::span<const GLuint> textures, bool isLayered);

  /// Attaches another layer of all textures, which have layers.
  void selectLayer(BoundState& bound, GLint layer);

  GLuint name() const { return name_.get(); }
  explicit operator bool() const { return static_cast<bool>(name_); }
  /// Whether the driver can draw to it; it must have been made or bound last.
  static bool isComplete() { return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE; }
  /// Reads a rectangle of its first texture's texels, row by row without gaps. Waits for the device.
  void read(BoundState& bound, const Transfer& transfer, GLint x, GLint y, GLsizei width, GLsizei height,
            void* texels) const;
  /// Whether an ES driver reads its first texture in these texels beside the wide ones.
  bool readsOnEs(BoundState& bound, const Transfer& transfer) const;

 private:
  ObjectName<deleteFramebuffer> name_;
  std::vector<GLuint> layered_;   ///< textures whose layers are attached
  GLint layer_ = 0;
};

}  // namespace sk::gl
