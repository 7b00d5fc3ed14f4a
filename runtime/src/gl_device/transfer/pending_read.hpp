// SPDX-License-Identifier: MIT
//
// Elements of a GL stream on their way to host memory, through a buffer of the driver's.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "assemble/elements/storage.hpp"
#include "device/transfer_state.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/transfer/buffered_transfer.hpp"

namespace sk {

class GlStream;

class PendingRead final : public TransferState {
 public:
  /// Of a region that has elements. A scope of the device must be open. Throws sk::Error where there is no memory.
  PendingRead(GlDevice& device, GlStream& stream, const StreamRegion& region);
  ~PendingRead() override;

  bool isReady() override;
  void wait() override;
  void take(std::byte* elements) override;

  /// The device ends: the elements come to host memory. Its context is current. The lock of the list is held, here and below.
  void land() noexcept;
  /// The device ends, and its context is out of reach.
  void abandon() noexcept;

 private:
  void copy(std::byte* elements);
  void fail(const char* why) noexcept;
  void leave() noexcept;

  const std::shared_ptr<PendingReads> all_;
  GlDevice* device_;  ///< null once it has ended, or the elements are taken
  const program::Element& element_;
  std::unique_ptr<assemble::HeldElement> held_;  ///< where the planes hold another
  std::size_t count_;
  std::optional<BufferedRead> read_;
  std::vector<std::byte> landed_;
  bool hasFailed_ = false;
  std::string failure_;  ///< empty also where there was no memory for it
};

}  // namespace sk
