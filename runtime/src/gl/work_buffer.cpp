// SPDX-License-Identifier: MIT
#include "gl/work_buffer.hpp"

#include <utility>

namespace sk::gl {

bool WorkBuffer::bind(BoundState& bound, std::size_t bytes) {
  bound.spoil();
  idle_ = 0;
  if (bytes > bytes_) {
    ObjectName<deleteBuffer> buffer(bound.deletions, [] { return generated(glGenBuffers); });
    bound.storage(buffer.get());
    bound.errors.setAside();
    glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_COPY);
    if (bound.errors.takeNew() != GL_NO_ERROR) return false;
    name_ = std::move(buffer);
    bytes_ = bytes;
  }
  bound.storage(name_.get());
  return true;
}

void WorkBuffer::clear(std::size_t bytes) {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
  glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, static_cast<GLsizeiptr>(bytes), GL_RED_INTEGER,
                       GL_UNSIGNED_INT, nullptr);
}

void WorkBuffer::trim() {
  if (bytes_ == 0 || ++idle_ <= keptCalls) return;
  name_ = {};
  bytes_ = 0;
}

}  // namespace sk::gl
