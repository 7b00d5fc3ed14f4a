// SPDX-License-Identifier: MIT
#include "gl/mapped_buffer.hpp"

#include <algorithm>
#include <utility>

namespace sk::gl {

bool MappedBuffer::reserve(BoundState& bound, std::size_t bytes) {
  if (bytes <= size_) return true;
  const std::size_t wanted = std::max(bytes, 2 * size_);
  const auto size = static_cast<GLsizeiptr>(wanted);
  const GLbitfield flags = access_ | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  ObjectName<deleteBuffer> buffer(bound.deletions, [] { return generated(glGenBuffers); });
  bound.storage(buffer.get());
  bound.errors.setAside();
  glBufferStorage(GL_SHADER_STORAGE_BUFFER, size, nullptr, flags);
  void* const mapped = glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, size, flags);
  if (bound.errors.takeNew() != GL_NO_ERROR || mapped == nullptr) return false;
  name_ = std::move(buffer);
  bytes_ = static_cast<std::byte*>(mapped);
  size_ = wanted;
  return true;
}

}  // namespace sk::gl
