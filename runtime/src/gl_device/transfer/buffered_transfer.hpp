// SPDX-License-Identifier: MIT
//
// Transfers elements between regions of streams and host memory through a pixel buffer, which holds all
// planes, so that a transfer waits for the device at most once. A DeviceScope must be open.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "assemble/region_layout.hpp"
#include "device/write_scope.hpp"
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

}  // namespace sk
