// SPDX-License-Identifier: MIT
//
// Buffers of the driver's that transfers share, and the futures that have some. Any thread may destroy a future, while another one
// uses the device, or ends it: what both touch is behind a lock, and GL is called by the device's thread alone.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "gl/fence.hpp"
#include "gl/pixel_buffer.hpp"

namespace sk {

class PendingRead;

/// A buffer, and when the device is done with it; kept for the next transfer.
struct TransferBuffer {
  gl::PixelBuffer buffer;
  gl::Fence fence;
  std::size_t bytes = 0;  ///< that were allocated last
};

/// The buffers that nobody uses. They wait here to be used again, or to be deleted with the context current.
class TransferBuffers {
 public:
  explicit TransferBuffers(gl::Deletions& deletions) : deletions_(deletions) {}

  /// One that nobody uses; its fence is none. The context is current.
  TransferBuffer take();
  /// Of a buffer that was taken. Any thread may call this: it touches no GL and allocates nothing.
  void give(TransferBuffer&& buffer) noexcept;

  /// Deletes those that have lain unused for a while, where they take much. Once a call, with the context current.
  void trim() {
    clock_.store(clock_.load(std::memory_order_relaxed) + 1,
                 std::memory_order_relaxed);  // no other thread changes it
    if (hasMany_.load(std::memory_order_relaxed)) deleteUnused();
  }

 private:
  struct Idle {
    TransferBuffer buffer;
    std::int64_t since;
  };
  static constexpr std::size_t keptBytes = std::size_t{64} << 20;
  static constexpr std::size_t keptBuffers = 64;
  static constexpr std::int64_t keptCalls = 16;

  void deleteUnused();
  void countIdle() { hasMany_ = bytes_ > keptBytes || idle_.size() > keptBuffers; }

  gl::Deletions& deletions_;
  std::mutex mutex_;
  std::vector<Idle> idle_;  ///< with room for those that were taken
  std::size_t taken_ = 0;
  std::size_t bytes_ = 0;
  std::atomic<std::int64_t> clock_ = 0;
  std::atomic<bool> hasMany_ = false;  ///< so that no call takes the lock where there are few
};

/// The futures that a device notifies before it ends. Device and futures share this list, since either may end first. Hold the
/// lock to add or remove a future, and while the device ends.
struct PendingReads {
  std::mutex mutex;
  std::vector<PendingRead*> list;
};

}  // namespace sk
