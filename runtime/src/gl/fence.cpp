// SPDX-License-Identifier: MIT
#include "gl/fence.hpp"

namespace sk::gl {

namespace {

constexpr GLuint64 second = 1'000'000'000;

}  // namespace

Fence Fence::insert() {
  Fence fence(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
  glFlush();
  return fence;
}

bool Fence::isReached() const { return glClientWaitSync(sync_, 0, 0) != GL_TIMEOUT_EXPIRED; }

void Fence::wait() const {
  while (glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, second) == GL_TIMEOUT_EXPIRED) {
  }
}

}  // namespace sk::gl
