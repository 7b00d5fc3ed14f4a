// SPDX-License-Identifier: MIT
#include "shadow/shadow_stream.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "call/placed.hpp"
#include "device/region.hpp"
#include "shadow/copies.hpp"
#include "shadow/errors.hpp"
#include "shadow/results.hpp"
#include "shadow/shadow_device.hpp"
#include "sk/error.hpp"
#include "sk/host_vector.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

/// The bytes of a stream's elements on a reference device.
std::int64_t referenceBytes(const program::Element& element, std::int64_t count) {
  std::int64_t bytes = 0;
  for (const ComponentType& component : componentsOf(element, RealType::Double))
    bytes += static_cast<std::int64_t>(component.storedBytes);
  return bytes * count;
}

StreamRegion on(const StreamRegion& region, StreamState& stream) {
  StreamRegion other = region;
  other.stream = &stream;
  return other;
}

}  // namespace

ShadowStream::ShadowStream(ShadowDevice& on, std::unique_ptr<StreamState> inner)
    : StreamState(on, *inner->element, inner->shape, inner->storage),
      inner_(std::move(inner)),
      number_(on.nextStream()) {}

ShadowStream::~ShadowStream() {
  if (device == nullptr) return;
  endWrite();
  dropConverted();
  owner().freeMemory(bytes_);
}

ShadowDevice& ShadowStream::owner() const { return static_cast<ShadowDevice&>(*device); }

StreamRegion ShadowStream::innerOf(const StreamRegion& region) const { return on(region, *inner_); }

NativeStream* ShadowStream::room() {
  if (!owner().isFollowing() || isRefused_) return nullptr;
  if (reference_ && reference_->shape == shape) return reference_.get();
  reference_.reset();
  owner().freeMemory(std::exchange(bytes_, 0));
  const std::int64_t bytes = referenceBytes(*element, shape.size());
  try {
    if (owner().takeMemory(bytes)) {
      bytes_ = bytes;
      reference_ = std::make_unique<NativeStream>(owner().reference(), *element, shape, Storage::Single);
      return reference_.get();
    }
  } catch (const Error&) {
    owner().freeMemory(std::exchange(bytes_, 0));
  }
  isRefused_ = true;
  owner().recorder().note(
      fmt::format("{} is not followed: its reference takes {} bytes, and there is no memory for them "
                  "(SK_SHADOW=...,memory=8G allows more)",
                  describe(), bytes));
  return nullptr;
}

NativeStream* ShadowStream::reference() {
  settle();
  NativeStream* const held = room();
  if (held == nullptr) return nullptr;
  if (exposed_ && hash() != *exposed_) {
    goStale(true);
    refreshExposure();
  }
  if (!isStale_) return held;
  if (!inner_->isLost()) copyElements(detail::wholeRegion(inner_.get()), detail::wholeRegion(held));
  isStale_ = false;
  isSame_ = !inner_->isLost();
  return held;
}

NativeStream* ShadowStream::deviceElements(bool mayConvert, bool isOverwritten) {
  if (exposed_ || reference_ == nullptr || isStale_ || inner_->isLost()) return nullptr;
  if (isSame_ && !isOverwritten) return reference_.get();
  if (converted_ != nullptr) return converted_.get();
  if (!mayConvert || !owner().hasRoomForCopy(bytesOf(*reference_))) return nullptr;
  std::unique_ptr<NativeStream> copy = owner().temporaries().take(*element, shape);
  copyElements(detail::wholeRegion(inner_.get()), detail::wholeRegion(copy.get()));
  isSame_ = isSame_ || (errors.relative == 0 && shadow::haveSameBits(*copy, *reference_));
  if (isSame_ && !isOverwritten) {
    owner().temporaries().giveBack(std::move(copy));
    return reference_.get();
  }
  keepConverted(std::move(copy));
  return converted_.get();
}

std::unique_ptr<NativeStream> ShadowStream::takeConverted() {
  if (converted_ != nullptr) owner().takeKept(bytesOf(*converted_));
  return std::move(converted_);
}

void ShadowStream::keepConverted(std::unique_ptr<NativeStream> copy) {
  if (std::unique_ptr<NativeStream> old = takeConverted()) owner().temporaries().giveBack(std::move(old));
  if (exposed_ || !owner().hasRoomForCopy(bytesOf(*copy)))
    return owner().temporaries().giveBack(std::move(copy));
  owner().keep(bytesOf(*copy));
  converted_ = std::move(copy);
}

void ShadowStream::dropConverted() noexcept {
  if (converted_ != nullptr) owner().dropKept(bytesOf(*converted_));
  converted_.reset();
}

void ShadowStream::goStale(bool isCounted) {
  if (isCounted && !isStale_) ++resyncs;
  isStale_ = true;
  isSame_ = false;
  dropConverted();
  errors = {};
}

void ShadowStream::takeIntegers(const StreamRegion& region, const NativeStream& device) {
  const auto isReal = [](const ComponentType& type) {
    return type.scalar == program::Scalar::Float || type.scalar == program::Scalar::Double;
  };
  const std::span<const ComponentType> types = reference_->components.types();
  if (std::ranges::none_of(types, isReal)) {
    StreamState& elements = const_cast<NativeStream&>(device);
    return copyElements(detail::wholeRegion(&elements), on(region, *reference_));
  }
  if (!isAllInOrder(on(region, *reference_))) return goStale(true);
  for (std::size_t c = 0; c < types.size(); ++c) {
    if (isReal(types[c])) continue;
    std::memcpy(reference_->components.arrays()[c], device.components.arrays()[c],
                static_cast<std::size_t>(shape.size()) * types[c].storedBytes);
  }
}

void ShadowStream::settle() {
  inner_->settle();
  shape = inner_->shape;
}

void ShadowStream::mirrorMarks() noexcept {
  inner_->isLost() ? markLost() : setWritten();
  isSame_ = false;
  dropConverted();
}

std::size_t ShadowStream::hash() {
  auto elements = detail::hostVector<std::byte>(bytesOf(shape.size(), element->size));
  detail::read(detail::wholeRegion(inner_.get()), elements.data(), static_cast<std::size_t>(shape.size()));
  return std::hash<std::string_view>()({reinterpret_cast<const char*>(elements.data()), elements.size()});
}

void ShadowStream::refreshExposure() {
  if (exposed_ && !inner_->isLost()) exposed_ = hash();
}

/// Makes a change by the host to the device's elements, then to the reference's.
template <class Change>
void ShadowStream::change(const StreamRegion& region, Change&& change) {
  const bool isAll = isWhole(region);
  NativeStream* const held = isAll ? room() : reference();
  endWrite();
  try {
    change(innerOf(region));
  } catch (...) {
    mirrorMarks();
    goStale(false);
    throw;
  }
  mirrorMarks();
  refreshExposure();
  last = {.elements = region.shape.size(), .isByHost = true};
  if (isAll) origins.clear();
  if (held == nullptr) return;
  change(on(region, *held));
  isStale_ = false;
  if (isAll) errors = {};
}

void ShadowStream::write(const StreamRegion& region, const std::byte* elements) {
  change(region, [&](const StreamRegion& target) {
    detail::write(target, elements, static_cast<std::size_t>(target.shape.size()));
  });
}

void ShadowStream::writeAsync(const StreamRegion& region, const std::byte* elements) {
  change(region, [&](const StreamRegion& target) {
    detail::writeAsync(target, elements, static_cast<std::size_t>(target.shape.size()));
  });
}

void ShadowStream::writeReals(const StreamRegion& region, const double* values) {
  std::size_t width = 0;
  for (const program::Field& field : element->fields) width += field.width;
  change(region, [&](const StreamRegion& target) {
    detail::writeReals(target, {values, static_cast<std::size_t>(target.shape.size()) * width});
  });
}

void ShadowStream::fill(const StreamRegion& region, const std::byte* value) {
  change(region, [&](const StreamRegion& target) { detail::fill(target, value); });
}

void ShadowStream::read(const StreamRegion& region, std::byte* elements) {
  detail::read(innerOf(region), elements, static_cast<std::size_t>(region.shape.size()));
  recordRead(*this, region);
}

std::unique_ptr<TransferState> ShadowStream::readAsync(const StreamRegion& region) {
  recordRead(*this, region);
  const DenseRegion dense(innerOf(region), /*isRead=*/true);
  return dense.get().stream->readAsync(dense.get());
}

void ShadowStream::readReals(const StreamRegion& region, double* values) {
  std::ranges::copy(detail::readReals(innerOf(region)), values);
  recordRead(*this, region);
}

bool ShadowStream::copyFrom(const StreamRegion& from, const StreamRegion& to) {
  ShadowStream& source = shadowStream(from);
  NativeStream* const read = source.reference();
  const bool isAll = isWhole(to) && &source != this;
  NativeStream* const written = read == nullptr ? nullptr : isAll ? room() : reference();
  endWrite();
  try {
    detail::copy(source.innerOf(from), innerOf(to));
  } catch (...) {
    mirrorMarks();
    goStale(false);
    throw;
  }
  mirrorMarks();
  source.noteRead(from);
  refreshExposure();
  last = {.kernel = source.last.kernel,
          .output = source.last.output,
          .elements = to.shape.size(),
          .isByHost = source.last.isByHost};
  if (isAll) origins.clear();
  addNew(origins, source.origins);
  if (written == nullptr) {
    goStale(false);
    return true;
  }
  written->copyFrom(on(from, *read), on(to, *written));
  isStale_ = false;
  if (isAll || source.errors.relative > errors.relative) errors = source.errors;
  constexpr double halfRounding = 0x1p-12;
  const bool isNarrowed = storage == Storage::Half && source.storage != Storage::Half;
  if (isNarrowed && errors.relative < halfRounding) {  // what the copy rounds is no kernel's
    errors = {};
    errors.relative = halfRounding;
    errors.shares.add(shadow::writtenByHost, 1);
    last.kernel = shadow::writtenByHost;
  }
  return true;
}

void ShadowStream::exchangeElements(StreamState& other) noexcept {
  auto& with = static_cast<ShadowStream&>(other);
  inner_->exchangeElements(*with.inner_);
  // references may differ in what they hold, but not in their type: the streams exchange them whole
  std::swap(reference_, with.reference_);
  std::swap(converted_, with.converted_);
  std::swap(isSame_, with.isSame_);
  std::swap(isStale_, with.isStale_);
  std::swap(isRefused_, with.isRefused_);
  std::swap(bytes_, with.bytes_);
  std::swap(exposed_, with.exposed_);
  std::swap(errors, with.errors);
  std::swap(last, with.last);
  std::swap(origins, with.origins);
  exchangeMarks(other);
}

void ShadowStream::noteCountRead() {
  if (!last.pushed || !owner().isFollowing() || owner().internalWork > 0) return;
  recordCount(*this, fmt::format("{} (number of elements)", describe()), shape.size(),
              *std::exchange(last.pushed, std::nullopt));
}

// The application may draw to the texture. What it has drawn is found when the elements are needed next.
StreamTexture ShadowStream::texture(int plane) {
  noteRead(detail::wholeRegion(this));
  const StreamTexture texture = inner_->texture(plane);
  if (owner().isFollowing()) exposed_ = hash();
  isSame_ = false;
  dropConverted();
  return texture;
}

void ShadowStream::fillBuffer(std::uint32_t buffer, std::int64_t byteOffset, int plane) {
  recordRead(*this, detail::wholeRegion(this));
  inner_->fillBuffer(buffer, byteOffset, plane);
}

void ShadowStream::setName(std::string_view given) {
  StreamState::setName(given);
  inner_->setName(given);
}

std::string ShadowStream::describe() const {
  if (!name.empty()) return name;
  if (device != nullptr && last.kernel >= 0)
    return fmt::format("{} of {}", last.output, owner().recorder().nameOfKernel(last.kernel));
  return fmt::format("stream {}", number_);
}

void ShadowStream::noteRead(const StreamRegion& region) {
  if (last.isReadWhole) return;
  if (!isBox(region) || isWhole(region)) {
    last.isRead = last.isReadWhole = true;
    return;
  }
  const int rank = region.shape.rank();
  if (!last.isRead) last.readBegin = last.readEnd = region.begin;
  for (int d = 0; d < rank; ++d) {
    last.readBegin[d] = std::min(last.readBegin[d], region.begin[d]);
    last.readEnd[d] = std::max(last.readEnd[d], region.begin[d] + region.shape[d]);
  }
  last.isRead = true;
}

void ShadowStream::endWrite() {
  if (device == nullptr || last.elements == 0) return;
  recordLifetime(*this);
  last = {};
}

void ShadowStream::empty() noexcept {
  inner_.reset();
  reference_.reset();
  converted_.reset();
}

}  // namespace sk
