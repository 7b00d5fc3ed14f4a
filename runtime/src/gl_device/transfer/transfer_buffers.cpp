// SPDX-License-Identifier: MIT
#include "gl_device/transfer/transfer_buffers.hpp"

#include <utility>

namespace sk {

TransferBuffer TransferBuffers::acquire() {
  const std::lock_guard lock(mutex_);
  idle_.reserve(idle_.size() + acquired_ + 1);
  TransferBuffer acquired;
  if (idle_.empty()) {
    acquired.buffer = gl::PixelBuffer(deletions_);
  } else {
    acquired = std::move(idle_.back().buffer);
    idle_.pop_back();
    bytes_ -= acquired.bytes;
    acquired.fence = {};
  }
  ++acquired_;
  return acquired;
}

void TransferBuffers::release(TransferBuffer&& buffer) noexcept {
  const std::lock_guard lock(mutex_);
  bytes_ += buffer.bytes;
  idle_.push_back({std::move(buffer), clock_});
  --acquired_;
  countIdle();
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

}  // namespace sk
