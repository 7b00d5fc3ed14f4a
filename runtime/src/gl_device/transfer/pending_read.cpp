// SPDX-License-Identifier: MIT
#include "gl_device/transfer/pending_read.hpp"

#include <algorithm>
#include <cstring>
#include <new>
#include <utility>

#include "gl_device/gl_stream.hpp"
#include "sk/error.hpp"
#include "support/convert_elements.hpp"

namespace sk {

namespace {

std::unique_ptr<assemble::HeldElement> heldOf(const StreamState& stream) {
  if (stream.storage == Storage::Single) return nullptr;
  return std::make_unique<assemble::HeldElement>(*stream.element, stream.storage);
}

}  // namespace

PendingRead::PendingRead(GlDevice& device, GlStream& stream, const StreamRegion& region)
    : all_(device.memory().pendingReads()),
      device_(&device),
      element_(*stream.element),
      held_(heldOf(stream)),
      count_(static_cast<std::size_t>(region.shape.size())) {
  {
    const std::lock_guard lock(all_->mutex);
    all_->list.push_back(this);
  }
  try {
    const GlStream::TransferRegion what = stream.transferRegion(region);
    const program::Element& own = held_ ? held_->element : element_;  // the stream's may be destroyed first
    read_.emplace(device).add(what.element == &stream.held() ? own : *what.element, stream.planes,
                              what.place);
    read_->begin();
  } catch (...) {
    const std::lock_guard lock(all_->mutex);
    leave();
    throw;
  }
}

// Runs on any thread. If the device is destroyed at the same time, the lock decides: either it has notified
// this read, or it does not find it in the list.
PendingRead::~PendingRead() {
  const std::lock_guard lock(all_->mutex);
  if (device_ != nullptr) leave();
}

bool PendingRead::isReady() {
  if (device_ == nullptr) return true;
  const DeviceScope scope(*device_);
  return read_->isReady();
}

void PendingRead::wait() {
  if (device_ == nullptr) return;
  const TraceScope traced(device_->trace.get(), "wait", "readAsync: wait");
  const DeviceScope scope(*device_);
  read_->wait();
}

void PendingRead::take(std::byte* elements) {
  if (hasFailed_) throw Error(failure_, Error::Kind::Lost);
  if (device_ == nullptr) {
    std::memcpy(elements, landed_.data(), landed_.size());
    return;
  }
  const TraceScope traced(device_->trace.get(), "transfer", "readAsync: get");
  const DeviceScope scope(*device_);
  copy(elements);
  device_->throwPendingError();
}

void PendingRead::copy(std::byte* elements) {
  readConverted(held_ ? held_->element : element_, element_, count_, elements,
                [&](std::byte* held) { read_->take(0, held); });
}

void PendingRead::land() noexcept {
  try {
    const DeviceScope scope(*device_);
    landed_.resize(count_ * element_.size);
    copy(landed_.data());
  } catch (const std::exception& error) {
    fail(error.what());
  }
  leave();
}

void PendingRead::abandon() noexcept {
  fail(
      "readAsync: the device has ended on a thread that could not use it, before the elements were there; "
      "get() them before the device ends");
  leave();
}

void PendingRead::fail(const char* why) noexcept {
  hasFailed_ = true;
  try {
    failure_ = why;
  } catch (const std::bad_alloc&) {
    failure_.clear();
  }
}

// Does not call GL: a future may be destroyed while the context is not current. The lock must be held.
void PendingRead::leave() noexcept {
  std::erase(all_->list, this);
  read_.reset();
  device_ = nullptr;
}

}  // namespace sk
