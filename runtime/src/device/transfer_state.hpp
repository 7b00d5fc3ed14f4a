// SPDX-License-Identifier: MIT
//
// The implementation of a Future on any device.
#pragma once

#include <cstddef>
#include <cstring>
#include <vector>

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

}  // namespace sk
