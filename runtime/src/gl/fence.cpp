// SPDX-License-Identifier: MIT
#include "gl/fence.hpp"

namespace sk::gl {

namespace {

constexpr GLuint64 second = 1'000'000'000;

}  // namespace

Fence Fence::insert(Deletions& deletions) {
  deletions.makeRoom();
  Fence fence;
  fence.deletions_ = &deletions;
  fence.sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  if (fence.sync_ != nullptr) deletions.expect();
  glFlush();
  return fence;
}

Fence::~Fence() {
  if (sync_ == nullptr) return;
  deletions_->add([](BoundState&, std::uintptr_t sync) { glDeleteSync(reinterpret_cast<GLsync>(sync)); },
                  reinterpret_cast<std::uintptr_t>(sync_));
}

bool Fence::isReached() const { return glClientWaitSync(sync_, 0, 0) != GL_TIMEOUT_EXPIRED; }

void Fence::wait() const {
  while (glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, second) == GL_TIMEOUT_EXPIRED) {
  }
}

}  // namespace sk::gl
