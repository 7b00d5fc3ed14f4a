// SPDX-License-Identifier: MIT
#include "gl/state_buffer.hpp"

#include <utility>

namespace sk::gl {

bool StateBuffer::bindZeros(BoundState& bound, std::int64_t words) {
  constexpr std::int64_t wordBytes = 4;
  bound.spoil();
  if (words > words_) {
    ObjectName<deleteBuffer> buffer(bound.deletions, [] { return generated(glGenBuffers); });
    bound.storage(buffer.get());
    bound.errors.setAside();
    glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(words * wordBytes), nullptr,
                 GL_STREAM_COPY);
    if (bound.errors.takeNew() != GL_NO_ERROR) return false;
    name_ = std::move(buffer);
    words_ = words;
  }
  bound.storage(name_.get());
  glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, static_cast<GLsizeiptr>(words * wordBytes),
                       GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  return true;
}

}  // namespace sk::gl
