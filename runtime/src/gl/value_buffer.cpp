// SPDX-License-Identifier: MIT
#include "gl/value_buffer.hpp"

namespace sk::gl {

void ValueBuffer::bind(BoundState& bound) {
  if (name_) return bound.storage(name_.get());
  GLuint name = 0;
  glGenBuffers(1, &name);
  name_ = ObjectName<deleteBuffer>(name);
  bound.storage(name);
  glBufferData(GL_SHADER_STORAGE_BUFFER, bytes, nullptr, GL_STREAM_READ);
}

void ValueBuffer::read(BoundState& bound, std::span<std::byte> values) const {
  bound.storage(name_.get());
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(values.size()), values.data());
}

}  // namespace sk::gl
