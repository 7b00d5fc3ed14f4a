// SPDX-License-Identifier: MIT
//
// A stream on a GL device: its planes, and where its elements lie in them.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/elements/storage.hpp"
#include "device/stream_state.hpp"
#include "gl_device/memory/layout.hpp"
#include "gl_device/memory/render_target.hpp"

namespace sk {

class GlDevice;

class GlStream final : public StreamState {
 public:
  /// A scope of the device must be open. Throws sk::Error where there is no room.
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
  StreamTexture texture(int plane) override;
  void fillBuffer(std::uint32_t buffer, std::int64_t byteOffset, int plane) override;
  void setName(std::string_view given) override;

  /// What the planes hold: the element, or another for it.
  const program::Element& held() const { return held_ ? held_->element : *element; }

  /// Whether the stream can lie packed, four elements to a texel.
  bool canPack() const { return assemble::mayPack(held()) && mayPack(shape); }
  /// Makes the stream lie unpacked, as it then does until a kernel writes all of it. A scope of the device is open.
  void unpack();

  /// What goes between a region and host memory: elements as they are held, or packed texels. May unpack the stream.
  struct Travelling {
    const program::Element* element;
    Shape shape;  ///< of such elements
    assemble::RegionLayout place;
  };
  Travelling travelling(const StreamRegion& region);

  Layout layout;  ///< holds once the stream is settled
  std::vector<RenderTarget> planes;  ///< one a field of what is held; none where the stream is empty

  /// For debuggers, where planes have changed.
  void labelPlanes() const noexcept;

  /// Takes what a kernel has pushed for its elements, and gives its planes for it. `total`: where their number
  /// is not known, HistoPyramid::totalTexture(); `list` has then room for all that may be, and is else of the elements.
  void become(std::vector<RenderTarget>& elements, Layout&& list, RenderTarget* total) noexcept;
  /// The layout of the first elements of a list.
  static Layout withSize(Layout list, std::int32_t count);

  /// All that is to be written is.
  void setWritten() noexcept;
  bool wasWrittenIn(std::int64_t period) const { return period_ == period; }

 private:
  friend class GlDevice;
  GlDevice& owner() const;
  bool writesThroughBuffer(const StreamRegion& region) const;
  /// Between all elements of a region, as they are held, and host memory.
  void uploadHeld(const StreamRegion& region, const std::byte* elements);
  void downloadHeld(const StreamRegion& region, std::byte* elements);
  std::vector<RenderTarget> takePlanesFor(const Layout& planned);

  std::unique_ptr<assemble::HeldElement> held_;  ///< where the storage is not Single
  std::int64_t period_ = 0;  ///< of the device, in which it was written last
  RenderTarget total_;  ///< holds the number of elements until somebody asks
};

/// The stream of an argument of a call on a GL device.
inline GlStream& glStream(const StreamRegion& region) { return static_cast<GlStream&>(*region.stream); }

}  // namespace sk
