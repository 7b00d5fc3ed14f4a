// SPDX-License-Identifier: MIT
#include "gl/pixel_buffer.hpp"

#include "gl/bound_state.hpp"

namespace sk::gl {

void deleteBuffer(BoundState& bound, GLuint name) {
  glDeleteBuffers(1, &name);
  bound.forgetStorage(name);
}

bool BoundPixels::allocate(Errors& errors, std::size_t bytes) const {
  const bool isRead = target_ == GL_PIXEL_PACK_BUFFER;
  errors.setAside();
  glBufferData(target_, static_cast<GLsizeiptr>(bytes), nullptr, isRead ? GL_STREAM_READ : GL_STREAM_DRAW);
  return errors.takeNew() == GL_NO_ERROR;
}

std::byte* BoundPixels::map(std::size_t bytes) const {
  const bool isRead = target_ == GL_PIXEL_PACK_BUFFER;
  const GLbitfield access = isRead ? GL_MAP_READ_BIT : GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT;
  return static_cast<std::byte*>(glMapBufferRange(target_, 0, static_cast<GLsizeiptr>(bytes), access));
}

std::size_t BoundPixels::size(Errors& errors) const {
  GLint64 bytes = 0;
  errors.setAside();
  glGetBufferParameteri64v(target_, GL_BUFFER_SIZE, &bytes);
  return errors.takeNew() == GL_NO_ERROR ? static_cast<std::size_t>(bytes) : 0;
}

}  // namespace sk::gl
