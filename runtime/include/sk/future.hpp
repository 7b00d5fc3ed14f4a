// SPDX-License-Identifier: MIT
//
// The result of an asynchronous read: what Stream::readAsync and View::readAsync return.
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

/// The elements that a stream or view had when readAsync() was called, even if the stream was written or
/// destroyed since, or the device has ended. E is the stream's type, or std::uint8_t for bool. Move-only.
/// Only the thread that uses the device may call its functions; any thread may destroy it, which does not
/// wait.
template <class E>
class Future {
 public:
  /// Creates an invalid future.
  Future() = default;
  Future(detail::TransferOwner transfer, std::size_t size) : transfer_(std::move(transfer)), size_(size) {}

  /// Whether there are elements to get.
  bool valid() const noexcept { return static_cast<bool>(transfer_); }
  /// Whether get() would return without waiting for the device. Like wait() and get(), throws sk::Error if
  /// the future is not valid or the driver has failed.
  bool ready() const { return detail::isReady(transfer_); }
  /// Waits for these elements, not for later calls.
  void wait() const { detail::wait(transfer_); }
  /// Waits for the elements and returns them, row-major. Invalidates the future, even if it throws.
  std::vector<E> get() {
    std::vector<E> elements = detail::hostVector<E>(size_, "readAsync");
    detail::take(std::move(transfer_), elements.data());
    return elements;
  }

 private:
  detail::TransferOwner transfer_;
  std::size_t size_ = 0;
};

}  // namespace sk
