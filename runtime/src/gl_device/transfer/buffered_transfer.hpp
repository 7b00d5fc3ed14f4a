// SPDX-License-Identifier: MIT
//
// Transfers elements between regions of streams and host memory through a pixel buffer, which holds all planes, so that a
// transfer waits for the device at most once. A PendingRead is the future of one stream's elements. A DeviceScope must be
// open.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "assemble/elements/storage.hpp"
#include "assemble/region_layout.hpp"
#include "device/stream_state.hpp"
#include "device/write_scope.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/memory/render_target.hpp"
#include "gl_device/transfer/copy_regions.hpp"
#include "gl_device/transfer/transfer_buffers.hpp"
#include "sk/program.hpp"

namespace sk {

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
