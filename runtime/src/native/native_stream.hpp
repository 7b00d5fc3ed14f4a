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
  /// Throws sk::Error where there is no room.
  NativeStream(NativeDevice& device, const program::Element& element, const Shape& shape, Storage storage);

  ~NativeStream() override;

  void settle() override {}
  void write(const StreamRegion& region, const std::byte* elements) override;
  void read(const StreamRegion& region, std::byte* elements) override;
  void readReals(const StreamRegion& region, double* values) override;
  void writeReals(const StreamRegion& region, const double* values) override;
  void fill(const StreamRegion& region, const std::byte* value) override;
  bool copyFrom(const StreamRegion& from, const StreamRegion& to) override;
  /// The scalar that is `offset` bytes from the start of each element in host memory: values as the arrays hold them.
  void writeScalars(const StreamRegion& region, std::size_t offset, const std::byte* values);
  StreamTexture texture(int plane) override;
  void fillBuffer(std::uint32_t buffer, std::int64_t byteOffset, int plane) override;

  /// What a kernel has pushed, which has floats as `real`, as this stream holds it. Throws sk::Error where it is too much.
  Components heldOf(native::Pushed pushed, RealType real) const;
  /// Takes so many elements for its own.
  void become(Components&& pushed, std::int64_t count) noexcept;

  /// After kernels have written to it: floats that are held as halves are rounded to these.
  void keepStorage();

  /// Arrays for what a call writes while it reads the stream's own, uninitialised when they are asked for first. They stay for the
  /// calls to come.
  Components& spare();
  /// The spare arrays become the stream's own, and those the spare ones.
  void exchange() { std::swap(components, spare_); }
  /// Frees all arrays.
  void empty() {
    components = {};
    spare_ = {};
  }

  Components components;

 private:
  NativeDevice& owner() const;
  void countBytes() noexcept;

  Components spare_;
  std::int64_t bytes_ = 0;  ///< as the trace knows them
};

/// The stream of an argument of a call on a native device.
inline NativeStream& nativeStream(const StreamRegion& region) {
  return static_cast<NativeStream&>(*region.stream);
}

/// An operand's extent, stride and first element, from those of a region. Missing dimensions have extent 1.
native::Operand operandOf(const StreamRegion& region);

}  // namespace sk
