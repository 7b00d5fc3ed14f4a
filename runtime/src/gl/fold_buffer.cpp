// SPDX-License-Identifier: MIT
#include "gl/fold_buffer.hpp"

#include <utility>
#include <vector>

namespace sk::gl {

bool FoldBuffer::bind(BoundState& bound, std::size_t bytes) {
  if (bytes > bytes_) {
    const UnloggedScope unlogged(bound);  // the buffer stays
    ObjectName<deleteBuffer> buffer(bound.deletions, [] { return generated(glGenBuffers); });
    const std::vector<std::byte> zeros(bytes);
    bound.storage(buffer.get());
    bound.errors.setAside();
    glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(bytes), zeros.data(), GL_DYNAMIC_COPY);
    if (bound.errors.takeNew() != GL_NO_ERROR) return false;
    name_ = std::move(buffer);
    bytes_ = bytes;
  }
  bound.keptStorage(name_.get());
  return true;
}

}  // namespace sk::gl
