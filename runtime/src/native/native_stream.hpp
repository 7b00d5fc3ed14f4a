// SPDX-License-Identifier: MIT
//
// A stream in host memory.
#pragma once

#include <utility>

#include "device/stream_state.hpp"
#include "native/call.hpp"
#include "native/components.hpp"

namespace sk {

class NativeDevice;

class NativeStream final : public StreamState {
 public:
  /// Throws sk::Error if there is not enough memory.
  NativeStream(NativeDevice& device, const program::Element& element, const Shape& shape, Storage storage);

  ~NativeStream() override;

  void settle() override {}
  void write(const StreamRegion& region, const std::byte* elements) override;
  void read(const StreamRegion& region, std::byte* elements) override;
  void readReals(const StreamRegion& region, double* values) override;
  void writeReals(const StreamRegion& region, const double* values) override;
  void fill(const StreamRegion& region, const std::byte* value) override;
  void permute(const StreamRegion& region, std::span<const std::int32_t> sources) override;
  bool copyFrom(const StreamRegion& from, const StreamRegion& to) override;
  void exchangeElements(StreamState& other) noexcept override;
  /// Writes the scalar that is `offset` bytes from the start of each element in host memory; `values` have
  /// the type of the arrays.
  void writeScalars(const StreamRegion& region, std::size_t offset, const std::byte* values);
  StreamTexture texture(int plane) override;
  void fillBuffer(std::uint32_t buffer, std::int64_t byteOffset, int plane) override;

  /// Converts what a kernel has pushed, with floats in type `real`, to the types of this stream. Throws
  /// sk::Error if it is too much.
  Components heldOf(native::Pushed pushed, RealType real) const;
  /// Replaces the elements by `count` elements that were pushed; the shape becomes {count}.
  void replaceElements(Components&& pushed, std::int64_t count, std::int64_t capacity) noexcept;
  /// Arrays for a call to push to, which held the stream's elements before the last call that pushed; none if there are none.
  native::Pushed takeRoom() { return std::exchange(room_, {}); }

  /// Rounds the floats of a region to half precision if that is the stream's storage. Must follow every write to it.
  void keepStorage(const StreamRegion& region);

  /// Arrays for a call to write to while it reads the stream's own. They are uninitialised at first, and kept
  /// for later calls.
  Components& spare();
  /// Exchanges the stream's own arrays for the spare ones.
  void exchange() {
    std::swap(components, spare_);
    capacity_ = 0;
  }
  /// Frees all arrays.
  void empty() {
    components = {};
    spare_ = {};
    room_ = {};
    capacity_ = 0;
  }

  Components components;

 private:
  NativeDevice& owner() const;
  void countBytes() noexcept;

  Components spare_;
  native::Pushed room_;
  std::int64_t capacity_ = 0;  ///< elements that `components` have room for; 0: as many as there are
  std::int64_t bytes_ = 0;  ///< as counted for the trace
};

/// The stream of an argument of a call on a native device.
inline NativeStream& nativeStream(const StreamRegion& region) {
  return static_cast<NativeStream&>(*region.stream);
}

/// An operand with the extent, stride and first element of a region. Missing dimensions have extent 1. The operand of a
/// placed region has the whole's extents, and a first element that it may not hold.
native::Operand operandOf(const StreamRegion& region);

}  // namespace sk
