// SPDX-License-Identifier: MIT
#include "gl/chain_buffer.hpp"

#include <utility>

namespace sk::gl {

bool ChainBuffer::bindCleared(BoundState& bound, std::size_t bytes) {
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
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
  glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, static_cast<GLsizeiptr>(bytes), GL_RED_INTEGER,
                       GL_UNSIGNED_INT, nullptr);
  return true;
}

}  // namespace sk::gl
