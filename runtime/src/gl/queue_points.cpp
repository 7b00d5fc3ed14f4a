// SPDX-License-Identifier: MIT
#include "gl/queue_points.hpp"

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

bool hasTimestamps(const Capabilities& capabilities) {
  if (capabilities.api != Api::Gl) return false;
  GLint bits = 0;
  glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &bits);
  return bits > 0;
}

std::int64_t timestampNow() {
  GLint64 now = 0;
  glGetInteger64v(GL_TIMESTAMP, &now);
  return now;
}

std::optional<std::int64_t> Timestamp::result() const {
  GLuint isAvailable = GL_FALSE;
  glGetQueryObjectuiv(name_.get(), GL_QUERY_RESULT_AVAILABLE, &isAvailable);
  if (isAvailable == GL_FALSE) return std::nullopt;
  GLuint64 time = 0;
  glGetQueryObjectui64v(name_.get(), GL_QUERY_RESULT, &time);
  return static_cast<std::int64_t>(time);
}

}  // namespace sk::gl
