// SPDX-License-Identifier: MIT
//
// Commands that use the current bindings, and the vertex array without attributes, which every draw requires and none reads.
#pragma once

#include "gl/bound_state.hpp"
#include "gl/object_name.hpp"

namespace sk::gl {

/// The vertices of a strip of four corners, which a vertex program computes from gl_VertexID.
inline constexpr GLsizei cornersOfViewport = 4;

/// Draws the viewport.
inline void drawViewport(BoundState& bound) {
  bound.note({.kind = Command::Kind::Draw});
  glDrawArrays(GL_TRIANGLE_STRIP, 0, cornersOfViewport);
}
/// Draws the viewport as often as the counts at `offset` in the buffer of indirect draws say.
inline void drawViewportIndirect(GLintptr offset) {
  glDrawArraysIndirect(GL_TRIANGLE_STRIP, reinterpret_cast<const void*>(offset));
}

/// Makes the writes of a dispatch visible to all later commands.
inline void finishDispatch() {
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                  GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT |
                  GL_SHADER_STORAGE_BARRIER_BIT);
}
/// Runs work groups of the compute program.
inline void dispatch(BoundState& bound, GLsizei groupsInX, GLsizei groupsInY) {
  bound.note({.kind = Command::Kind::Dispatch, .numbers = {groupsInX, groupsInY}});
  glDispatchCompute(static_cast<GLuint>(groupsInX), static_cast<GLuint>(groupsInY), 1);
  finishDispatch();
}
/// Runs as many work groups as the counts at `offset` in the buffer of indirect dispatches say.
inline void dispatchIndirect(GLintptr offset) {
  glDispatchComputeIndirect(offset);
  finishDispatch();
}

/// Orders dispatches after draws that read what they write.
inline void finishDraws(BoundState& bound) {
  bound.note({.kind = Command::Kind::FinishDraws});
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

/// Makes what programs have written to a buffer visible to later programs and commands.
inline void finishStorage(BoundState& bound) {
  bound.spoil();
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

/// Hands all commands to the device.
inline void flush() { glFlush(); }

/// Waits until the device has finished all commands.
inline void finish() { glFinish(); }

struct Corner {
  GLint x, y;
};

/// Copies width x height texels from the first texture of one framebuffer to that of another, which has the
/// same format, bit for bit.
inline void blit(BoundState& bound, GLuint from, Corner source, GLuint to, Corner target, GLsizei width,
                 GLsizei height) {
  bound.spoil();
  bound.readFramebuffer(from);
  bound.drawFramebuffer(to);
  glBlitFramebuffer(source.x, source.y, source.x + width, source.y + height, target.x, target.y,
                    target.x + width, target.y + height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

inline void deleteVertexArray(BoundState&, GLuint name) { glDeleteVertexArrays(1, &name); }

class VertexArray {
 public:
  VertexArray() = default;
  explicit VertexArray(Deletions& deletions)
      : name_(deletions, [] { return generated(glGenVertexArrays); }) {}

  GLuint name() const { return name_.get(); }

 private:
  ObjectName<deleteVertexArray> name_;
};

}  // namespace sk::gl
