// SPDX-License-Identifier: MIT
//
// A stream on a GL device: its planes, and the layout of its elements in them.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/elements/planes.hpp"
#include "device/stream_state.hpp"
#include "gl_device/memory/layout.hpp"
#include "gl_device/memory/render_target.hpp"

namespace sk {

class GlDevice;

class GlStream final : public StreamState {
 public:
  /// A DeviceScope must be open. Throws sk::Error if memory is exhausted or no texture is large enough.
  GlStream(GlDevice& device, const program::Element& element, const Shape& shape, Storage storage);
  ~GlStream() override;

  void settle() override;
  void write(const StreamRegion& region, const std::byte* elements) override;
  void read(const StreamRegion& region, std::byte* elements) override;
  std::unique_ptr<TransferState> readAsync(const StreamRegion& region) override;
  void writeAsync(const StreamRegion& region, const std::byte* elements) override;
  void readReals(const StreamRegion& region, double* values) override;
  void writeReals(const StreamRegion& region, const double* values) override;
  void fill(const StreamRegion& region, const std::byte* value) override;
  bool copyFrom(const StreamRegion& from, const StreamRegion& to) override;
  void exchangeElements(StreamState& other) noexcept override;
  StreamTexture texture(int plane) override;
  void fillBuffer(std::uint32_t buffer, std::int64_t byteOffset, int plane) override;
  void setName(std::string_view given) override;

  /// The element type that the planes hold, which differs from `element` if the storage is not Single.
  const program::Element& held() const { return held_ ? held_->element : *element; }

  /// Whether the stream can be packed: four elements per texel.
  bool canPack() const { return assemble::mayPack(held()) && mayPack(shape); }
  /// Converts a packed stream to one element per texel, which it stays until a kernel writes all of it. A
  /// DeviceScope must be open.
  void unpack();

  /// A region in the units of its transfers to and from host memory: elements of type held(), or packed
  /// texels.
  struct TransferRegion {
    const program::Element* element;
    Shape shape;  ///< in these units
    assemble::RegionLayout place;
  };
  /// Unpacks the stream if the region does not consist of whole texels.
  TransferRegion transferRegion(const StreamRegion& region);

  Layout layout;  ///< valid once the stream is settled
  std::vector<RenderTarget> planes;  ///< one per field of held(); none if the stream is empty

  /// Labels the planes for debuggers; must be called after they have been replaced.
  void labelPlanes() const noexcept;

  /// Swaps its planes for `elements`, the list that a kernel has pushed, of layout `list`. If their number is
  /// not known yet, `total` is HistoPyramid::totalTexture(), which is moved from, and the list has room for
  /// the largest possible number; otherwise `total` is null.
  void replaceElements(std::vector<RenderTarget>& elements, Layout&& list, RenderTarget* total) noexcept;
  /// The layout of the first `count` elements of a list.
  static Layout withSize(Layout list, std::int32_t count);

  void setWritten() noexcept override;
  bool wasWrittenSince(std::int64_t period) const { return period_ >= period; }

 private:
  friend class GlDevice;
  GlDevice& owner() const;
  void throwLoopReport();
  bool writesThroughBuffer(const StreamRegion& region) const;
  /// Transfer all elements of a region, of type held(), from and to host memory.
  void uploadHeld(const StreamRegion& region, const std::byte* elements, bool isBuffered);
  void downloadHeld(const StreamRegion& region, std::byte* elements);
  /// Transfers all elements of a region, of type *element, from host memory.
  void writeDeclared(const StreamRegion& region, const std::byte* elements, bool isBuffered);
  std::vector<RenderTarget> acquirePlanesFor(const Layout& planned);

  std::unique_ptr<assemble::HeldElement> held_;  ///< null if the storage is Single
  std::int64_t period_ = 0;  ///< of the device (GlContext::period()), in which it was last written
  RenderTarget total_;  ///< holds the number of elements until settle() reads it
};

/// The stream of a region on a GL device.
inline GlStream& glStream(const StreamRegion& region) { return static_cast<GlStream&>(*region.stream); }

}  // namespace sk
