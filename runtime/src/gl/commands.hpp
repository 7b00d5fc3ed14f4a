// SPDX-License-Identifier: MIT
//
// Commands that use the current bindings.
#pragma once

#include "gl/bound_state.hpp"

namespace sk::gl {

/// Draws the viewport as a strip of four corners, which a vertex program computes from gl_VertexID.
inline void drawViewport() { glDrawArrays(GL_TRIANGLE_STRIP, 0, 4); }

/// Runs work groups of the compute program, and makes their writes visible to all later commands.
inline void dispatch(GLsizei groupsInX, GLsizei groupsInY) {
  glDispatchCompute(static_cast<GLuint>(groupsInX), static_cast<GLuint>(groupsInY), 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                  GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT);
}

/// Orders dispatches after draws that read what they write.
inline void finishDraws() { glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT); }

/// Waits until the device has finished all commands.
inline void finish() { glFinish(); }

struct Corner {
  GLint x, y;
};

/// Copies width x height texels from the first texture of one framebuffer to that of another, which has the
/// same format, bit for bit.
inline void blit(BoundState& bound, GLuint from, Corner source, GLuint to, Corner target, GLsizei width,
                 GLsizei height) {
  bound.readFramebuffer(from);
  bound.drawFramebuffer(to);
  glBlitFramebuffer(source.x, source.y, source.x + width, source.y + height, target.x, target.y,
                    target.x + width, target.y + height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace sk::gl
