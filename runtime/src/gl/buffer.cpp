// SPDX-License-Identifier: MIT
#include "gl/buffer.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

namespace sk::gl {

void deleteBuffer(BoundState& bound, GLuint name) {
  glDeleteBuffers(1, &name);
  bound.forgetStorage(name);
}

// ES has neither glGetBufferSubData nor glClearBufferSubData.
void readBuffer(const BoundState& bound, GLenum target, std::span<std::byte> bytes) {
  const auto size = static_cast<GLsizeiptr>(bytes.size());
  if (!bound.isEs()) return glGetBufferSubData(target, 0, size, bytes.data());
  const void* const mapped = glMapBufferRange(target, 0, size, GL_MAP_READ_BIT);
  if (mapped == nullptr) return;
  std::memcpy(bytes.data(), mapped, bytes.size());
  glUnmapBuffer(target);
}

bool StorageBuffer::reserve(BoundState& bound, std::size_t bytes) {
  idle_ = 0;
  if (bytes <= size_) return true;
  std::optional<UnloggedScope> unlogged;
  if (use_ == Use::Persistent) unlogged.emplace(bound);
  const std::size_t room = isMapped() ? std::max(bytes, 2 * size_) : bytes;
  const auto size = static_cast<GLsizeiptr>(room);
  ObjectName<deleteBuffer> buffer(bound.deletions, [] { return generated(glGenBuffers); });
  const std::vector<std::byte> zeros(use_ == Use::Persistent ? room : 0);
  bound.storage(buffer.get());
  bound.errors.setAside();
  void* mapped = nullptr;
  if (isMapped()) {
    const GLbitfield access = use_ == Use::HostReads ? GL_MAP_READ_BIT : GL_MAP_WRITE_BIT;
    const GLbitfield flags = access | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    glBufferStorage(GL_SHADER_STORAGE_BUFFER, size, nullptr, flags);
    mapped = glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, size, flags);
  } else {
    // NVIDIA's driver places a DYNAMIC buffer in host memory at first: the first pass over 256 MiB takes 200 ms, in place of 9.
    glBufferData(GL_SHADER_STORAGE_BUFFER, size, zeros.empty() ? nullptr : zeros.data(),
                 use_ == Use::Values ? GL_STREAM_READ : GL_STATIC_COPY);
  }
  if (bound.errors.takeNew() != GL_NO_ERROR || (isMapped() && mapped == nullptr)) return false;
  name_ = std::move(buffer);
  bytes_ = static_cast<std::byte*>(mapped);
  size_ = room;
  return true;
}

void StorageBuffer::bind(BoundState& bound) {
  if (use_ == Use::Persistent) {
    bound.keptStorage(name_.get());
  } else {
    bound.storage(name_.get());
  }
}

bool StorageBuffer::bind(BoundState& bound, std::size_t bytes) {
  if (!reserve(bound, bytes)) return false;
  bind(bound);
  return true;
}

void StorageBuffer::clear(const BoundState& bound, std::size_t bytes) {
  const auto size = static_cast<GLsizeiptr>(bytes);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
  if (!bound.isEs()) {
    return glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, size, GL_RED_INTEGER, GL_UNSIGNED_INT,
                                nullptr);
  }
  void* const mapped =
      glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, size, GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_RANGE_BIT);
  if (mapped == nullptr) return;
  std::memset(mapped, 0, bytes);
  glUnmapBuffer(GL_SHADER_STORAGE_BUFFER);
}

void StorageBuffer::read(BoundState& bound, std::span<std::byte> values) const {
  bound.storage(name_.get());
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  readBuffer(bound, GL_SHADER_STORAGE_BUFFER, values);
}

void StorageBuffer::trim(std::size_t keptBytes) {
  if (size_ <= keptBytes || ++idle_ <= keptCalls) return;
  name_ = {};
  size_ = 0;
}

bool BoundPixels::allocate(Errors& errors, std::size_t bytes) const {
  const bool isRead = target_ == GL_PIXEL_PACK_BUFFER;
  errors.setAside();
  glBufferData(target_, static_cast<GLsizeiptr>(bytes), nullptr, isRead ? GL_STREAM_READ : GL_STREAM_DRAW);
  return errors.takeNew() == GL_NO_ERROR;
}

std::byte* BoundPixels::map(std::size_t bytes) const {
  const bool isRead = target_ == GL_PIXEL_PACK_BUFFER;
  const GLbitfield access = isRead ? GL_MAP_READ_BIT : GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT;
  return static_cast<std::byte*>(glMapBufferRange(target_, 0, static_cast<GLsizeiptr>(bytes), access));
}

std::size_t BoundPixels::size(Errors& errors) const {
  GLint64 bytes = 0;
  errors.setAside();
  glGetBufferParameteri64v(target_, GL_BUFFER_SIZE, &bytes);
  return errors.takeNew() == GL_NO_ERROR ? static_cast<std::size_t>(bytes) : 0;
}

}  // namespace sk::gl
