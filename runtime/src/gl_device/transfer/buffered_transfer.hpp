// SPDX-License-Identifier: MIT
//
// Transfers elements between regions of streams and host memory through a pixel buffer, which holds all planes, so that a
// transfer waits for the device at most once. A PendingRead is the future of one stream's elements. A DeviceScope must be
// open.
//
// The pool of pixel buffers for transfers, and the list of pending futures, which hold such buffers. A future
// may be destroyed on any thread while another thread uses or destroys the device: locks protect what both
// access, and only the device's thread calls GL.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "assemble/elements/planes.hpp"
#include "assemble/region_layout.hpp"
#include "device/stream_state.hpp"
#include "device/write_scope.hpp"
#include "gl/buffer.hpp"
#include "gl/queue_points.hpp"
#include "gl_device/memory/render_target.hpp"
#include "gl_device/transfer/copy_regions.hpp"
#include "sk/program.hpp"

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

class GlDevice;

/// Reads one or more regions: add() them, begin() once, then take() each part.
class BufferedRead {
 public:
  explicit BufferedRead(GlDevice& device);
  /// Returns the buffer to the device; does not call GL.
  BufferedRead(const BufferedRead&) = delete;
  BufferedRead& operator=(const BufferedRead&) = delete;

  /// Adds all elements of a region, and returns the number of the part. `element` must outlive this object,
  /// and the planes the call of begin().
  std::size_t add(const program::Element& element, std::span<RenderTarget> planes,
                  const assemble::RegionLayout& region);
  /// Queues the reads: later writes to the planes do not affect them. Throws sk::Error if memory is
  /// exhausted.
  void begin();

  bool isReady() const { return lease_.held.fence.isReached(); }
  void wait() const { lease_.held.fence.wait(); }
  /// Waits, and copies the elements of a part, row-major. Throws sk::Error if the driver fails.
  void take(std::size_t part, std::byte* elements);

 private:
  struct Part {
    const program::Element* element;
    assemble::RegionLayout region;
    std::size_t firstBlock;
  };
  /// A rectangle of a plane's texels, which the buffer holds row by row.
  struct Block {
    std::size_t plane;
    RenderTarget* target;
    const gl::Format* format;
    gl::Transfer transfer;  ///< the layout of the texels in the buffer
    CopyRegion place;
    std::size_t offset;  ///< of its first texel in the buffer, in bytes
  };

  static void unpack(const Part& part, const Block& block, const std::byte* texels, std::byte* elements);

  GlDevice& device_;
  TransferBufferLease lease_;
  std::vector<Part> parts_;
  std::vector<Block> blocks_;
  std::size_t bytes_ = 0;
};

/// Copies all texels of a region of a plane, row-major, to the application's GL buffer, from byte `offset`
/// on. Throws sk::Error if the buffer is too small, or if the driver cannot read these texels as
/// Format::tight.
void readToBuffer(GlDevice& device, RenderTarget& plane, const assemble::RegionLayout& region, GLuint buffer,
                  std::size_t offset);

/// Copies all elements of a region, row-major in host memory, to its planes, without waiting for the device.
/// The caller may change `elements` afterwards. Throws sk::Error if memory is exhausted. Begins `writes` before
/// the planes change.
void writeBuffered(GlDevice& device, const program::Element& element, std::span<RenderTarget> planes,
                   const assemble::RegionLayout& region, const std::byte* elements, WriteScope& writes);

class GlStream;

class PendingRead final : public TransferState {
 public:
  /// Starts reading a region, which is not empty. A DeviceScope must be open. Throws sk::Error if memory is
  /// exhausted.
  PendingRead(GlDevice& device, GlStream& stream, const StreamRegion& region);
  ~PendingRead() override;

  bool isReady() override;
  void wait() override;
  void take(std::byte* elements) override;

  /// Copies the elements to host memory because the device is being destroyed. Its context must be current,
  /// and the lock of the list must be held.
  void land() noexcept;
  /// Makes take() fail because the device is being destroyed and its context cannot be made current. The lock
  /// of the list must be held.
  void abandon() noexcept;

 private:
  void copy(std::byte* elements);
  void fail(const char* why) noexcept;
  void leave() noexcept;

  const std::shared_ptr<PendingReads> all_;
  GlDevice* device_;  ///< null after the device has been destroyed
  const program::Element& element_;
  std::unique_ptr<assemble::HeldElement> held_;  ///< the element type of the planes; null if it is element_
  std::size_t count_;
  std::optional<BufferedRead> read_;
  std::vector<std::byte> landed_;
  bool hasFailed_ = false;
  std::string failure_;  ///< may be empty even so, if memory was exhausted
};

}  // namespace sk
