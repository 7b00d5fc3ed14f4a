// SPDX-License-Identifier: MIT
#include "gl/value_buffer.hpp"

#include <utility>

namespace sk::gl {

bool ValueBuffer::bind(BoundState& bound) {
  if (name_) {
    bound.storage(name_.get());
    return true;
  }
  ObjectName<deleteBuffer> buffer(bound.deletions, [] { return generated(glGenBuffers); });
  bound.storage(buffer.get());
  bound.errors.setAside();
  glBufferData(GL_SHADER_STORAGE_BUFFER, bytes, nullptr, GL_STREAM_READ);
  if (bound.errors.takeNew() != GL_NO_ERROR) return false;
  name_ = std::move(buffer);
  return true;
}

void ValueBuffer::read(BoundState& bound, std::span<std::byte> values) const {
  bound.storage(name_.get());
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(values.size()), values.data());
}

}  // namespace sk::gl
