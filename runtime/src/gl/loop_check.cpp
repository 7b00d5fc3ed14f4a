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

std::optional<std::int32_t> LoopCheck::take(BoundState& bound) {
  std::optional<std::int32_t> number;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  bound.withSelected(buffer_.get(), [&] {
    void* const reported = glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, sizeof(std::int32_t),
                                            GL_MAP_READ_BIT | GL_MAP_WRITE_BIT);
    if (reported == nullptr) return;
    number = std::exchange(*static_cast<std::int32_t*>(reported), 0);
    glUnmapBuffer(GL_SHADER_STORAGE_BUFFER);
  });
  if (!number) buffer_ = {};  // perhaps it has never had its bytes; bind() creates another
  return number;
}

}  // namespace sk::gl
