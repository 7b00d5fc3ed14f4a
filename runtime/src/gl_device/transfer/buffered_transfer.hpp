// SPDX-License-Identifier: MIT
//
// Elements between regions of streams and host memory through a buffer of the driver's, all planes in one, so that the
// device is waited for once, or not at all. A scope of the device must be open.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "assemble/region_layout.hpp"
#include "gl_device/memory/render_target.hpp"
#include "gl_device/transfer/transfer_buffers.hpp"
#include "sk/program.hpp"

namespace sk {

class GlDevice;

/// First what is to be read is added, then all of it begun, then taken part by part.
class BufferedRead {
 public:
  explicit BufferedRead(GlDevice& device);
  /// Gives the buffer back; touches no GL.
  ~BufferedRead();
  BufferedRead(const BufferedRead&) = delete;
  BufferedRead& operator=(const BufferedRead&) = delete;

  /// All elements of a region; its number as a part. `element` must outlive this, the planes begin().
  std::size_t add(const program::Element& element, std::span<RenderTarget> planes,
                  const assemble::RegionLayout& region);
  /// Queues the reading. What is written to the planes later is not read. Throws sk::Error where there is no memory.
  void begin();

  bool isReady() const { return held_.fence.isReached(); }
  void wait() const { held_.fence.wait(); }
  /// The elements of a part, row-major. Waits for them. Throws sk::Error where the driver fails.
  void take(std::size_t part, std::byte* elements);

 private:
  struct Part {
    const program::Element* element;
    assemble::RegionLayout region;
    std::size_t firstBlock;
  };
  /// Texels of a plane that are read in one piece.
  struct Block {
    RenderTarget* plane;
    const gl::Format* format;
    const program::Field* field;
    gl::Transfer transfer;  ///< how the texels lie in the buffer
    assemble::Rect rect;  ///< rows are those of all layers
    std::int64_t
        first;  ///< its first element in the region; wholeRows: it is all rows that the region lies in
    std::size_t offset;  ///< in the buffer
  };
  static constexpr std::int64_t wholeRows = -1;

  void addBlock(RenderTarget& plane, const program::Field& field, const assemble::Rect& rect,
                std::int64_t first);
  void readBlock(const Block& block);
  static void unpack(const Part& part, const Block& block, const std::byte* texels, std::byte* elements);

  GlDevice& device_;
  TransferBuffer held_;
  std::vector<Part> parts_;
  std::vector<Block> blocks_;
  std::size_t bytes_ = 0;
};

/// Copies all texels of a region of a plane, row-major, to a GL buffer of the application's, from a byte on. Throws sk::Error
/// where the buffer is too small, or the driver reads such texels in another form only.
void readToBuffer(GlDevice& device, RenderTarget& plane, const assemble::RegionLayout& region, GLuint buffer,
                  std::size_t offset);

/// Copies all elements of a region, row-major in host memory, to its planes. The memory may be reused at once; nobody
/// waits for the device. Throws sk::Error where there is no memory. `isTorn` is set when the planes begin to change.
void writeBuffered(GlDevice& device, const program::Element& element, std::span<RenderTarget> planes,
                   const assemble::RegionLayout& region, const std::byte* elements, bool& isTorn);

}  // namespace sk
