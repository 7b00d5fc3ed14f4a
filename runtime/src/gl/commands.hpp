// SPDX-License-Identifier: MIT
//
// What a context is told to do with what is bound.
#pragma once

#include "gl/bound_state.hpp"

namespace sk::gl {

/// Draws the triangle that covers the viewport.
inline void drawTriangle() { glDrawArrays(GL_TRIANGLES, 0, 3); }

/// Waits until everything is done.
inline void finish() { glFinish(); }

struct Corner {
  GLint x, y;
};

/// Copies width x height texels of the first texture of one framebuffer to that of another, of the
/// same format, bit for bit.
inline void blit(BoundState& bound, GLuint from, Corner source, GLuint to, Corner target, GLsizei width,
                 GLsizei height) {
  bound.readFramebuffer(from);
  bound.drawFramebuffer(to);
  glBlitFramebuffer(source.x, source.y, source.x + width, source.y + height, target.x, target.y,
                    target.x + width, target.y + height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace sk::gl
