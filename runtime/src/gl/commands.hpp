// SPDX-License-Identifier: MIT
//
// What a context is told to do with what is bound.
#pragma once

#include "gl/bound_state.hpp"

namespace sk::gl {

/// Draws the four corners of the viewport that a vertex program makes of gl_VertexID.
inline void drawViewport() { glDrawArrays(GL_TRIANGLE_STRIP, 0, 4); }

/// Runs so many work groups of the compute program, then lets everything that follows see what they wrote.
inline void dispatch(GLsizei groupsInX, GLsizei groupsInY) {
  glDispatchCompute(static_cast<GLuint>(groupsInX), static_cast<GLuint>(groupsInY), 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                  GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT);
}

/// Lets dispatches write what draws before them have read.
inline void finishDraws() { glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT); }

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
