// SPDX-License-Identifier: MIT
#include "pending_read.hpp"

#include <algorithm>
#include <cstring>
#include <new>
#include <utility>

#include "convert_elements.hpp"
#include "copy_kernel.hpp"
#include "gl_stream.hpp"
#include "pass.hpp"
#include "sk/error.hpp"
#include "transfer.hpp"

namespace sk {

namespace {

std::unique_ptr<assemble::HeldElement> heldOf(const StreamState& stream) {
  if (stream.storage == Storage::Single) return nullptr;
  return std::make_unique<assemble::HeldElement>(*stream.element, stream.storage);
}

}  // namespace

PendingRead::PendingRead(GlDevice& device, GlStream& stream, const StreamRegion& region)
    : device_(&device),
      element_(*stream.element),
      held_(heldOf(stream)),
      count_(static_cast<std::size_t>(region.shape.size())) {
  device.pendingReads.push_back(this);
  try {
    begin(stream, region);
  } catch (...) {
    leave();
    throw;
  }
}

PendingRead::~PendingRead() {
  if (device_ != nullptr) leave();
}

void PendingRead::begin(GlStream& stream, const StreamRegion& region) {
  const GlStream::Travelling what = stream.travelling(region);
  // the stream's own element may end before this does
  texel_ = what.element != &stream.held() ? what.element : held_ ? &held_->element : &element_;
  if (!device_->capabilities.isSoftware || !drawsKeepBits(*texel_)) {
    packed_.emplace(*device_).add(*texel_, stream.planes, what.place);
    packed_->begin();
    return;
  }
  device_->pastFences.clear();
  layout_ = layoutOf(what.shape, device_->textureLimits());
  drawn_.emplace(*device_).planes =
      device_->takePlanes(*texel_, layout_.texture, "elements that are read later");
  drawRegion(*device_, *texel_, stream.planes, what.place, drawn_->planes, layout_.whole);
  fence_ = gl::Fence::insert();
}

bool PendingRead::isReady() {
  if (device_ == nullptr) return true;
  const DeviceScope scope(*device_);
  return isThere();
}

void PendingRead::wait() {
  if (device_ == nullptr) return;
  const TraceScope traced(device_->trace.get(), "wait", "readAsync: wait");
  const DeviceScope scope(*device_);
  packed_ ? packed_->wait() : fence_.wait();
}

void PendingRead::take(std::byte* elements) {
  if (!failure_.empty()) throw Error(failure_);
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
  std::vector<std::byte> texels;
  if (held_) texels.resize(count_ * held_->element.size);
  std::byte* const to = held_ ? texels.data() : elements;
  if (packed_) {
    packed_->take(0, to);
  } else {
    download(*device_, *texel_, drawn_->planes, layout_.whole, to);
  }
  if (held_) convertElements(held_->element, texels.data(), element_, elements, count_);
}

void PendingRead::land() noexcept {
  try {
    const DeviceScope scope(*device_);
    landed_.resize(count_ * element_.size);
    copy(landed_.data());
  } catch (const std::exception& error) {
    failure_ = error.what();
  }
  leave();
}

void PendingRead::abandon() noexcept {
  if (packed_) packed_->forget();
  fence_.forget();
  if (drawn_) {
    for (Surface& plane : drawn_->planes) plane.forget();
    drawn_->planes.clear();
  }
  try {
    failure_ =
        "readAsync: the device has ended on a thread that could not use it, before the elements were there; "
        "get() them before the device ends";
  } catch (const std::bad_alloc&) {
    landed_.clear();
  }
  leave();
}

// Touches no GL: a future may be destroyed where the context is not current.
void PendingRead::leave() noexcept {
  std::erase(device_->pendingReads, this);
  try {
    device_->pastFences.reserve(device_->pastFences.size() + 1);
    device_->pastFences.push_back(std::move(fence_));
  } catch (const std::bad_alloc&) {
    fence_.forget();  // it is deleted with its context
  }
  drawn_.reset();
  packed_.reset();
  device_ = nullptr;
}

}  // namespace sk
