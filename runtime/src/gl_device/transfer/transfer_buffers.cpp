// SPDX-License-Identifier: MIT
#include "gl_device/transfer/transfer_buffers.hpp"

#include <new>
#include <utility>

namespace sk {

void TransferBuffer::forget() noexcept {
  buffer.forget();
  fence.forget();
}

TransferBuffer TransferBuffers::take() {
  TransferBuffer taken;
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      taken = std::move(idle_.back().buffer);
      idle_.pop_back();
      bytes_ -= taken.bytes;
    }
  }
  if (!taken.buffer) taken.buffer = gl::PixelBuffer::create();
  taken.fence = {};
  return taken;
}

// Where the host has no memory for the list, the buffer is deleted with its context.
void TransferBuffers::give(TransferBuffer&& buffer) noexcept {
  const std::lock_guard lock(mutex_);
  try {
    const std::size_t bytes = buffer.bytes;
    idle_.reserve(idle_.size() + 1);
    idle_.push_back({std::move(buffer), clock_});
    bytes_ += bytes;
    countIdle();
  } catch (const std::bad_alloc&) {
    buffer.forget();
  }
}

void TransferBuffers::deleteUnused() {
  const std::lock_guard lock(mutex_);
  const std::int64_t time = clock_ - keptCalls;
  std::erase_if(idle_, [&](const Idle& idle) {
    if (idle.since >= time) return false;
    bytes_ -= idle.buffer.bytes;
    return true;
  });
  countIdle();
}

void TransferBuffers::clear() {
  const std::lock_guard lock(mutex_);
  idle_.clear();
  bytes_ = 0;
}

void TransferBuffers::forget() noexcept {
  const std::lock_guard lock(mutex_);
  for (Idle& idle : idle_) idle.buffer.forget();
}

}  // namespace sk
