// SPDX-License-Identifier: MIT
//
// The pool of pixel buffers for transfers, and the list of pending futures, which hold such buffers. A future
// may be destroyed on any thread while another thread uses or destroys the device: locks protect what both
// access, and only the device's thread calls GL.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include "gl/buffer.hpp"
#include "gl/queue_points.hpp"

namespace sk {

class PendingRead;

/// A pixel buffer, and the fence after the commands that write it.
struct TransferBuffer {
  gl::PixelBuffer buffer;
  gl::Fence fence;
  std::size_t bytes = 0;  ///< its size, as last allocated
};

/// The idle buffers, which are reused, or deleted while the context is current.
class TransferBuffers {
 public:
  explicit TransferBuffers(gl::Deletions& deletions) : deletions_(deletions) {}

  /// Returns an idle buffer or a new one, without a fence. The context must be current.
  TransferBuffer acquire();
  /// Returns a buffer from acquire() to the pool. Thread-safe: it does not call GL, and it never allocates.
  void release(TransferBuffer&& buffer) noexcept;

  /// Deletes the buffers that have been idle for a number of calls, if idle ones are many or large. Must be
  /// called once per call, while the context is current.
  void trim() {
    // no read-modify-write is needed, since only this thread changes it
    clock_.store(clock_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
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
  std::vector<Idle> idle_;  ///< has capacity for the acquired ones as well
  std::size_t acquired_ = 0;
  std::size_t bytes_ = 0;
  std::atomic<std::int64_t> clock_ = 0;
  std::atomic<bool> hasMany_ = false;  ///< spares calls the lock if there are few idle buffers
};

/// Holds a buffer of the pool and releases it when it is destroyed, on any thread.
class TransferBufferLease {
 public:
  explicit TransferBufferLease(TransferBuffers& pool) : held(pool.acquire()), pool_(pool) {}
  ~TransferBufferLease() { pool_.release(std::move(held)); }
  TransferBufferLease(const TransferBufferLease&) = delete;
  TransferBufferLease& operator=(const TransferBufferLease&) = delete;

  TransferBuffer held;

 private:
  TransferBuffers& pool_;
};

/// The futures that a device notifies when it is destroyed. Device and futures share the ownership of this
/// list, because either may be destroyed first. The lock must be held to add or remove a future, and while
/// the device notifies them.
struct PendingReads {
  std::mutex mutex;
  std::vector<PendingRead*> list;
};

}  // namespace sk
