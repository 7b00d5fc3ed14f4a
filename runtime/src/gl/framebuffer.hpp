// SPDX-License-Identifier: MIT
//
// A framebuffer over whole textures, one a colour attachment, all of them drawn to.
#pragma once

#include <span>

#include "gl/format.hpp"
#include "gl/object_name.hpp"

namespace sk::gl {

class BoundState;

void deleteFramebuffer(GLuint name);

class Framebuffer {
 public:
  Framebuffer() = default;
  /// Attaches `textures` in order, 1 or more.
  Framebuffer(BoundState& bound, std::span<const GLuint> textures);

  GLuint name() const { return name_.get(); }
  explicit operator bool() const { return static_cast<bool>(name_); }
  /// Whether the driver can draw to it; it must have been made or bound last.
  static bool isComplete() { return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE; }
  /// Reads a rectangle of its first texture's texels, row by row without gaps. Waits for the device.
  void read(BoundState& bound, const Transfer& transfer, GLint x, GLint y, GLsizei width, GLsizei height,
            void* texels) const;
  /// Whether an ES driver reads its first texture in these texels beside the wide ones.
  bool readsOnEs(BoundState& bound, const Transfer& transfer) const;
  void forget() noexcept { name_.forget(); }

 private:
  ObjectName<deleteFramebuffer> name_;
};

}  // namespace sk::gl
