// SPDX-License-Identifier: MIT
//
// An asynchronous read of a GL stream's elements, through a pixel buffer.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "assemble/elements/storage.hpp"
#include "device/stream_state.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/transfer/buffered_transfer.hpp"

namespace sk {

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
