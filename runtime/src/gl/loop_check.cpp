// SPDX-License-Identifier: MIT
#include "gl/loop_check.hpp"

#include <utility>

namespace sk::gl {

void LoopCheck::bind(BoundState& bound) {
  if (!buffer_) {
    constexpr std::int32_t none = 0;
    buffer_ = ObjectName<deleteBuffer>(bound.deletions, [] { return generated(glGenBuffers); });
    bound.withSelected(buffer_.get(),
                       [&] { glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof none, &none, GL_DYNAMIC_READ); });
  }
  bound.loopStorage(buffer_.get());
}

std::int32_t LoopCheck::take(BoundState& bound) {
  std::int32_t number = 0;
  if (!buffer_) return number;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  bound.withSelected(buffer_.get(), [&] {
    void* const reported =
        glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, sizeof number, GL_MAP_READ_BIT | GL_MAP_WRITE_BIT);
    if (reported == nullptr) return;  // the driver's error says why
    number = std::exchange(*static_cast<std::int32_t*>(reported), 0);
    glUnmapBuffer(GL_SHADER_STORAGE_BUFFER);
  });
  return number;
}

}  // namespace sk::gl
