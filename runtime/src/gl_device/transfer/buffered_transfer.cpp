// SPDX-License-Identifier: MIT
#include "gl_device/transfer/buffered_transfer.hpp"

#include <algorithm>
#include <cstring>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/memory/element_packing.hpp"
#include "gl_device/transfer/transfer.hpp"
#include "sk/error.hpp"
#include "support/checked_size.hpp"
#include "support/convert_elements.hpp"

namespace sk {

namespace {

using assemble::RegionLayout;
using program::Element;

/// The alignment of a block in the buffer. GL requires a multiple of the size of a channel.
constexpr std::size_t alignment = 16;

std::size_t aligned(std::size_t bytes) { return (bytes + alignment - 1) / alignment * alignment; }

[[noreturn]] void failForMemory(GlDevice& device, std::size_t bytes) {
  device.context().failForMemory(
      fmt::format("a transfer of {}", bytesText(static_cast<std::int64_t>(bytes))));
}

}  // namespace

BufferedRead::BufferedRead(GlDevice& device) : device_(device), lease_(device.memory().transferBuffers()) {}

std::size_t BufferedRead::add(const Element& element, std::span<RenderTarget> planes,
                              const RegionLayout& region) {
  parts_.push_back({&element, region, blocks_.size()});
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const gl::Format& format = planes[i].texture.format();
    const gl::Transfer transfer = readTransferOf(device_.context(), planes[i]);
    forEachCopyRegion(region, readsByRows(device_.traits, region, format.texelBytes()),
                      [&](const CopyRegion& place) {
                        blocks_.push_back({i, &planes[i], &format, transfer, place, bytes_});
                        bytes_ += aligned(place.texels() * transfer.texelBytes());
                      });
  }
  return parts_.size() - 1;
}

void BufferedRead::begin() {
  {
    const gl::BoundPixels bound(lease_.held.buffer, gl::BoundPixels::Way::Read);
    if (!bound.allocate(device_.bound().errors, bytes_)) failForMemory(device_, bytes_);
    lease_.held.bytes = bytes_;
    for (const Block& block : blocks_) {
      readTexels(device_.bound(), *block.target, block.place.rect, block.transfer, atOffset(block.offset));
    }
  }
  device_.bound().errors.setAside();
  lease_.held.fence = gl::Fence::insert(device_.bound().deletions);
  if (!lease_.held.fence) {
    static_cast<void>(device_.bound().errors.takeNew());
    failForMemory(device_, bytes_);
  }
}

void BufferedRead::take(std::size_t part, std::byte* elements) {
  wait();
  const gl::BoundPixels bound(lease_.held.buffer, gl::BoundPixels::Way::Read);
  device_.bound().errors.setAside();
  const std::byte* texels = bound.map(bytes_);
  if (texels == nullptr) {
    static_cast<void>(device_.bound().errors.takeNew());
    failForMemory(device_, bytes_);
  }
  const std::size_t end = part + 1 < parts_.size() ? parts_[part + 1].firstBlock : blocks_.size();
  for (std::size_t i = parts_[part].firstBlock; i < end; ++i) {
    unpack(parts_[part], blocks_[i], texels + blocks_[i].offset, elements);
  }
  if (!bound.unmap()) failForMemory(device_, bytes_);
}

void BufferedRead::unpack(const Part& part, const Block& block, const std::byte* texels,
                          std::byte* elements) {
  std::vector<std::byte> narrowed;
  if (!(block.transfer == block.format->tight)) {
    resizeChecked(narrowed, block.place.texels() * block.format->texelBytes());
    narrowTexels(*block.format, texels, block.place.texels(), narrowed.data());
    texels = narrowed.data();
  }
  const PlaneOfElements plane{*part.element, part.element->fields[block.plane], *block.format, part.region};
  plane.unpack(block.place, texels, elements);
}

void readToBuffer(GlDevice& device, RenderTarget& plane, const RegionLayout& region, GLuint buffer,
                  std::size_t offset) {
  const gl::Transfer transfer = plane.texture.format().tight;
  if (!(readTransferOf(device.context(), plane) == transfer)) {
    throw Error(
        fmt::format("fillBuffer: '{}' does not read texels of {} as they are; use a stream of vectors of 4",
                    device.name(), plane.texture.format().name));
  }
  const gl::BoundPixels bound(buffer, gl::BoundPixels::Way::Read);
  const std::size_t texelBytes = transfer.texelBytes();
  const std::size_t needed =
      offset + static_cast<std::size_t>(assemble::elements(region.extent)) * texelBytes;
  if (bound.size(device.bound().errors) < needed) {
    throw Error(fmt::format(
        "fillBuffer: the buffer {} has {} bytes, but {} are needed; allocate it by glBufferData first",
        buffer, bound.size(device.bound().errors), needed));
  }
  forEachCopyRegion(region, [&](const CopyRegion& part) {
    readTexels(device.bound(), plane, part.rect, transfer,
               atOffset(offset + static_cast<std::size_t>(part.first) * texelBytes));
  });
}

void writeBuffered(GlDevice& device, const Element& element, std::span<RenderTarget> planes,
                   const RegionLayout& region, const std::byte* elements, WriteScope& writes) {
  const auto count = static_cast<std::size_t>(assemble::elements(region.extent));
  std::size_t bytes = 0;
  for (const RenderTarget& plane : planes) bytes += aligned(count * plane.texture.format().texelBytes());
  TransferBufferLease lease(device.memory().transferBuffers());
  const gl::BoundPixels bound(lease.held.buffer, gl::BoundPixels::Way::Write);
  gl::Errors& errors = device.bound().errors;
  std::byte* const texels = bound.allocate(errors, bytes) ? bound.map(bytes) : nullptr;
  if (texels == nullptr) {
    static_cast<void>(errors.takeNew());
    failForMemory(device, bytes);
  }
  lease.held.bytes = bytes;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    packTexels(element, element.fields[i], elements, count, texels + offset);
    offset += aligned(count * planes[i].texture.format().texelBytes());
  }
  if (!bound.unmap()) failForMemory(device, bytes);
  writes.begin();
  offset = 0;
  for (RenderTarget& plane : planes) {
    const std::size_t texelBytes = plane.texture.format().texelBytes();
    forEachCopyRegion(region, [&](const CopyRegion& part) {
      writeTexels(device.bound(), plane, part.rect,
                  atOffset(offset + static_cast<std::size_t>(part.first) * texelBytes));
    });
    offset += aligned(count * texelBytes);
  }
}

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

TransferBuffer TransferBuffers::acquire() {
  const std::lock_guard lock(mutex_);
  idle_.reserve(idle_.size() + acquired_ + 1);
  TransferBuffer acquired;
  if (idle_.empty()) {
    acquired.buffer = gl::PixelBuffer(deletions_);
  } else {
    acquired = std::move(idle_.back().buffer);
    idle_.pop_back();
    bytes_ -= acquired.bytes;
    acquired.fence = {};
  }
  ++acquired_;
  return acquired;
}

void TransferBuffers::release(TransferBuffer&& buffer) noexcept {
  const std::lock_guard lock(mutex_);
  bytes_ += buffer.bytes;
  idle_.push_back({std::move(buffer), clock_});
  --acquired_;
  countIdle();
}

void TransferBuffers::deleteUnused() {
  const std::lock_guard lock(mutex_);
  const std::int64_t time = clock_ - keptCalls;
  std::erase_if(idle_, [&](const Idle& idle) {
    if (idle.since >= time) return false;
    bytes_ -= idle.buffer.bytes;
    return true;
  });
  countIdle();
}

}  // namespace sk
