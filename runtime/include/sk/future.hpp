// SPDX-License-Identifier: MIT
//
// Elements on their way from a device: what Stream::readAsync and View::readAsync give.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "sk/host_vector.hpp"
#include "sk/owner.hpp"

namespace sk {

class TransferState;  // the runtime's own

namespace detail {

struct TransferDeleter {
  void operator()(TransferState* state) const noexcept;
};
using TransferOwner = Owner<TransferState, TransferDeleter>;

bool isReady(const TransferOwner& transfer);
void wait(const TransferOwner& transfer);
void take(TransferOwner transfer, void* elements);

}  // namespace detail

/// The elements that a stream or view had when they were asked for: whatever is written to the stream since, and also
/// where the stream or the device has ended. E is the stream's type, or std::uint8_t for bool. Move-only. It uses
/// the device: everything but destroying it is for the thread that does. Where nobody asks for the elements, nobody waits for them.
template <class E>
class Future {
 public:
  /// Of nothing.
  Future() = default;
  Future(detail::TransferOwner transfer, std::size_t size) : transfer_(std::move(transfer)), size_(size) {}

  /// Whether there are elements to get.
  bool valid() const noexcept { return static_cast<bool>(transfer_); }
  /// Whether get() would return without waiting for the device. This and what follows throw sk::Error where the future is
  /// not valid, or the driver has failed.
  bool ready() const { return detail::isReady(transfer_); }
  /// Waits for these elements, and for nothing that was called later.
  void wait() const { detail::wait(transfer_); }
  /// The elements, row-major; waits for them. The future is no longer valid then, also where this throws.
  std::vector<E> get() {
    std::vector<E> elements = detail::hostVector<E>(size_);
    detail::take(std::move(transfer_), elements.data());
    return elements;
  }

 private:
  detail::TransferOwner transfer_;
  std::size_t size_ = 0;
};

}  // namespace sk
