// SPDX-License-Identifier: MIT
//
// The implementation of a Stream on any device: its type, its shape, and its device as long as that exists; and of a Future,
// a transfer of its elements.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/unwritten_elements.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"
#include "sk/stream.hpp"

namespace sk {

class TransferState {
 public:
  TransferState() = default;
  virtual ~TransferState() = default;
  TransferState(const TransferState&) = delete;
  TransferState& operator=(const TransferState&) = delete;

  virtual bool isReady() = 0;
  virtual void wait() = 0;
  /// Copies the elements to host memory; called once. Throws sk::Error if the driver has failed.
  virtual void take(std::byte* elements) = 0;
};

/// A transfer of elements that are already in host memory.
class ReadyTransfer final : public TransferState {
 public:
  explicit ReadyTransfer(std::vector<std::byte>&& elements) : elements_(std::move(elements)) {}

  bool isReady() override { return true; }
  void wait() override {}
  void take(std::byte* elements) override {
    if (!elements_.empty()) std::memcpy(elements, elements_.data(), elements_.size());
  }

 private:
  std::vector<std::byte> elements_;
};

class DeviceState;

class StreamState {
 public:
  virtual ~StreamState();
  StreamState(const StreamState&) = delete;
  StreamState& operator=(const StreamState&) = delete;

  /// The stream that calls of the device's underlying() one use.
  virtual StreamState& underlying() { return *this; }
  /// Somebody has written the underlying stream.
  virtual void noteUnderlyingWritten() {}
  /// Determines the number of elements if it is not known, which waits for the device. No scope of the device
  /// may be open.
  virtual void settle() = 0;
  /// The host has asked for the shape, which a kernel that pushes changes.
  virtual void noteCountRead() {}
  /// The region is in bounds and not empty; `elements` has as many elements, laid out as the Element says.
  virtual void write(const StreamRegion& region, const std::byte* elements) = 0;
  virtual void read(const StreamRegion& region, std::byte* elements) = 0;
  /// Starts reading. The default reads immediately, which is as fast if elements are in host memory.
  virtual std::unique_ptr<TransferState> readAsync(const StreamRegion& region);
  /// Like write(), but does not wait for earlier work; the caller may change the elements afterwards.
  virtual void writeAsync(const StreamRegion& region, const std::byte* elements) { write(region, elements); }
  /// `values` has room for every component of every element; all are floats.
  virtual void readReals(const StreamRegion& region, double* values) = 0;
  virtual void writeReals(const StreamRegion& region, const double* values) = 0;
  /// `value` is laid out as the Element says.
  virtual void fill(const StreamRegion& region, const std::byte* value) = 0;
  /// Copies a region of the same shape from a stream of the same element type on the same device, which may
  /// be this stream. Returns false, without any effect, if the device cannot copy the elements as they are
  /// stored.
  virtual bool copyFrom(const StreamRegion& from, const StreamRegion& to) = 0;
  /// Exchanges all elements with a stream of the same device, element type, shape and storage. Both are settled.
  virtual void exchangeElements(StreamState& other) noexcept = 0;
  /// Element i of the region, in row-major order, becomes what element number sources[i] was. The region is not
  /// empty. The default goes through host memory.
  virtual void permute(const StreamRegion& region, std::span<const std::int32_t> sources);
  /// Throws sk::Error if the device has no textures.
  virtual StreamTexture texture(int plane) = 0;
  /// The plane exists, the offset is valid for it, and the stream is not empty. Throws sk::Error if the
  /// device has no buffers.
  virtual void fillBuffer(std::uint32_t buffer, std::int64_t byteOffset, int plane) = 0;

  /// Its elements are lost, because an operation failed while writing them. The next operation must overwrite
  /// all of them.
  bool isLost() const { return isLost_; }
  /// Operations call neither of these, but have a WriteScope (device/write_scope.hpp).
  void markLost() noexcept { isLost_ = true; }
  /// A write has succeeded: the elements are those that were to be written.
  virtual void setWritten() noexcept { isLost_ = false; }

  /// The name shown by debuggers and in the trace.
  virtual void setName(std::string_view given) { name = given; }

  /// The next stream in the device's list.
  StreamState* next() const { return next_; }
  /// Removes the stream from its device's list and clears `device`.
  void leave() noexcept;

  DeviceState* device;  ///< null after the device has ended
  const program::Element* const element;
  const Storage storage;
  Shape shape;  ///< valid once the stream is settled
  std::string name;  ///< may be empty
  std::uint32_t resultNumber =
      0;  ///< by which SK_RESULTS names it; 0: nothing that the host reads of it is a result
  /// With SK_CHECK=written, its elements that nothing has written since the application created it; null if there are none.
  std::unique_ptr<UnwrittenElements> unwritten;
  detail::StreamOwner* holder = nullptr;  ///< the application's handle, or null

 protected:
  void exchangeMarks(StreamState& other) noexcept {
    std::swap(isLost_, other.isLost_);
    std::swap(unwritten, other.unwritten);
  }
  /// Adds the stream to its device's list.
  StreamState(DeviceState& owner, const program::Element& type, const Shape& extents, Storage as);

 private:
  bool isLost_ = false;
  StreamState* previous_ = nullptr;
  StreamState* next_ = nullptr;
};

/// Throws sk::Error, with `context` in front, if the stream of a region was moved from, or if its device has ended.
void checkExists(const StreamRegion& region, std::string_view context);

/// The settled stream of a region. Throws sk::Error, with `context` in front, if it was moved from, if its
/// device has ended, or if a kernel has left it fewer elements than the region has.
StreamState& liveStream(const StreamRegion& region, std::string_view context);

/// Throws sk::Error, with `context` in front, if the elements of a stream are lost, unless the operation
/// writes (`isWritten`) all of them.
void checkNotLost(const StreamRegion& region, bool isWritten, std::string_view context);

/// Likewise, and with SK_CHECK=written, if the operation reads elements that nothing has written.
void checkElementsOf(const StreamRegion& region, bool isWritten, std::string_view context);

/// Whether a region is in bounds of its stream, which must be settled: a kernel that pushes changes the size.
bool isInside(const StreamRegion& region);

}  // namespace sk
