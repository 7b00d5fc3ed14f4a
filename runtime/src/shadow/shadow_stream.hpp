// SPDX-License-Identifier: MIT
//
// A stream of a shadowed device: the elements of the device that runs the program, and the same on the reference device.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/stream_state.hpp"
#include "native/native_stream.hpp"
#include "shadow/shares.hpp"

namespace sk {

class ShadowDevice;

/// What is known of the elements of a stream.
struct StreamErrors {
  double relative = 0;  ///< their error, relative to the root mean square of the reference's
  shadow::Shares shares;  ///< whose error it is
  bool hasNan = false, hasInfinity = false;  ///< on the device
  int exception = -1;  ///< number of the record of the NaN or infinity that they come from
  bool isEstimated = false;  ///< calls that were not compared have written some: `relative` is expected
  int unseen = shadow::notCompared;  ///< the kernel of these calls, if it is one

  /// Estimated errors have been measured: what the estimate does not explain is of calls that were not compared.
  void measure(double measured);
};

/// Adds what the list lacks.
inline void addNew(std::vector<int>& list, const std::vector<int>& others) {
  for (const int each : others) {
    if (std::ranges::find(list, each) == list.end()) list.push_back(each);
  }
}

/// Who wrote the elements last, and how many of them have been read since.
struct LastWrite {
  int kernel = shadow::writtenByHost;
  std::string output = {};
  double seconds = 0;
  std::int64_t elements = 0;
  bool isByHost = false;  ///< the host has written elements, itself or by copying such a stream
  int given = -1;  ///< number of the record of what the host has given (shadow/given.hpp)
  bool isRead = false, isReadWhole = false;
  Index readBegin = {}, readEnd = {};  ///< a box around what was read
  std::optional<std::int64_t> pushed =
      {};  ///< how many elements the reference has pushed, until the host asks
};

class ShadowStream final : public StreamState {
 public:
  ShadowStream(ShadowDevice& device, std::unique_ptr<StreamState> inner);
  ~ShadowStream() override;

  StreamState& inner() const { return *inner_; }
  /// A region of this stream, as a region of the device's own.
  StreamRegion innerOf(const StreamRegion& region) const;

  /// The reference's elements; null if there is no memory for them. Holds the device's elements if it held none.
  NativeStream* reference();
  /// The reference's elements are no longer those that the program would have in double: it takes over the device's when it is
  /// needed next. `isCounted`: the report counts it.
  void goStale(bool isCounted);
  bool isStale() const { return isStale_; }
  /// Takes over the integers and booleans of the device's elements in a region.
  void takeIntegers(const StreamRegion& region, const NativeStream& device);
  /// All elements are about to be written: stale ones need not be replaced before.
  void becomeFresh() { isStale_ = false; }
  NativeStream* held() const { return reference_.get(); }
  /// Makes room for the reference without elements; null if there is no memory.
  NativeStream* room();

  /// A stream of doubles with all elements of the device: the reference's if they are the same and nothing is about to write those
  /// (`isOverwritten`), else a copy that is kept until the device writes the elements. Null if there is none, and either `mayConvert`
  /// is false or there is no memory to keep one. The reference is not stale.
  NativeStream* deviceElements(bool mayConvert, bool isOverwritten);
  /// Whether the elements of the device and of the reference are known to be the same, bit by bit.
  bool isSame() const { return isSame_; }
  void setSame(bool isSame) { isSame_ = isSame; }
  /// The copy that is kept; null if there is none.
  NativeStream* converted() const { return converted_.get(); }
  std::unique_ptr<NativeStream> takeConverted();
  /// Keeps a copy of the device's elements, which are not the reference's, if memory allows it.
  void keepConverted(std::unique_ptr<NativeStream> copy);

  StreamState& underlying() override { return *inner_; }
  void noteUnderlyingWritten() override {
    mirrorMarks();
    goStale(false);
  }
  void settle() override;
  void noteCountRead() override;
  void write(const StreamRegion& region, const std::byte* elements) override;
  void writeAsync(const StreamRegion& region, const std::byte* elements) override;
  void read(const StreamRegion& region, std::byte* elements) override;
  std::unique_ptr<TransferState> readAsync(const StreamRegion& region) override;
  void readReals(const StreamRegion& region, double* values) override;
  void writeReals(const StreamRegion& region, const double* values) override;
  void fill(const StreamRegion& region, const std::byte* value) override;
  bool copyFrom(const StreamRegion& from, const StreamRegion& to) override;
  void exchangeElements(StreamState& other) noexcept override;
  StreamTexture texture(int plane) override;
  void fillBuffer(std::uint32_t buffer, std::int64_t byteOffset, int plane) override;
  void setName(std::string_view given) override;

  /// The device has written elements. Takes over from the inner stream whether they are lost.
  void mirrorMarks() noexcept;
  /// The device has written elements of a stream whose texture the application has: what differs from them later, it has drawn.
  void refreshExposure();
  /// Elements were read; the region is in bounds.
  void noteRead(const StreamRegion& region);
  /// Elements are about to be replaced by others: counts those that nothing has read.
  void endWrite();
  /// Frees everything: its device ends.
  void empty() noexcept;

  /// For the report: the name, or what wrote it last, or its number.
  std::string describe() const;

  StreamErrors errors;
  LastWrite last;
  std::vector<int> origins;  ///< kernels that the elements come from, without inputs of these
  std::int64_t resyncs = 0;

 private:
  ShadowDevice& owner() const;
  std::size_t hash();
  template <class Change>
  void change(const StreamRegion& region, Change&& change);
  void dropConverted() noexcept;

  std::unique_ptr<StreamState> inner_;
  std::unique_ptr<NativeStream> reference_;
  std::unique_ptr<NativeStream>
      converted_;  ///< the device's elements, from the device's TemporaryStreams; may be null
  bool isSame_ = false;
  bool isStale_ = true;  ///< at first, both have undefined elements, which need not be equal
  bool isRefused_ = false;  ///< there was no memory for the reference
  std::optional<std::size_t> exposed_;  ///< hash of the elements, if the application has a texture of them
  std::int64_t bytes_ = 0;
  const std::int64_t number_;
};

inline ShadowStream& shadowStream(const StreamRegion& region) {
  return static_cast<ShadowStream&>(*region.stream);
}

}  // namespace sk
