// SPDX-License-Identifier: MIT
#include "shadow/shadow_staging.hpp"

#include <cstring>

#include "native/components.hpp"
#include "shadow/copies.hpp"
#include "shadow/shadow_device.hpp"
#include "shadow/shadow_stream.hpp"

namespace sk {

namespace {

std::size_t wholeWords(std::size_t bytes) { return (bytes + 7) / 8 * 8; }

std::size_t deviceBytes(const StreamRegion& box) {
  return wholeWords(static_cast<std::size_t>(box.shape.size()) * box.stream->element->size);
}

}  // namespace

/// The device's elements as in host memory, then the reference's, component by component.
std::size_t ShadowStaging::bytesOf(const StreamRegion& box) const {
  std::size_t bytes = deviceBytes(box);
  for (const ComponentType& component : componentsOf(*box.stream->element, RealType::Double))
    bytes += wholeWords(static_cast<std::size_t>(box.shape.size()) * component.storedBytes);
  return bytes;
}

std::byte* ShadowStaging::room(std::size_t bytes) {
  memory_.resize(bytes);
  return memory_.data();
}

void ShadowStaging::copy(const StreamRegion& box, std::size_t offset) { copies_.push_back({box, offset}); }

void ShadowStaging::flush() {
  for (const Copy& copy : copies_) way_ == Way::ToHost ? take(copy) : bring(copy);
  copies_.clear();
}

void ShadowStaging::take(const Copy& copy) {
  ShadowStream& stream = shadowStream(copy.box);
  const auto count = static_cast<std::size_t>(copy.box.shape.size());
  std::byte* to = memory_.data() + copy.offset;
  detail::read(stream.innerOf(copy.box), to, count);
  stream.noteRead(copy.box);
  to += deviceBytes(copy.box);
  std::unique_ptr<NativeStream> dense = device_.temporaries().take(*stream.element, copy.box.shape);
  StreamRegion from = copy.box;
  from.stream = stream.reference();
  copyElements(from.stream != nullptr ? from : stream.innerOf(copy.box), detail::wholeRegion(dense.get()));
  for (std::size_t c = 0; c < dense->components.types().size(); ++c) {
    const std::size_t bytes = count * dense->components.types()[c].storedBytes;
    std::memcpy(to, dense->components.arrays()[c], bytes);
    to += wholeWords(bytes);
  }
  device_.temporaries().giveBack(std::move(dense));
}

void ShadowStaging::bring(const Copy& copy) {
  ShadowStream& stream = shadowStream(copy.box);
  const auto count = static_cast<std::size_t>(copy.box.shape.size());
  NativeStream* const reference = stream.reference();
  const std::byte* from = memory_.data() + copy.offset;
  detail::write(stream.innerOf(copy.box), from, count);
  stream.mirrorMarks();
  if (reference == nullptr) return;
  from += deviceBytes(copy.box);
  std::unique_ptr<NativeStream> dense = device_.temporaries().take(*stream.element, copy.box.shape);
  for (std::size_t c = 0; c < dense->components.types().size(); ++c) {
    const std::size_t bytes = count * dense->components.types()[c].storedBytes;
    std::memcpy(dense->components.arrays()[c], from, bytes);
    from += wholeWords(bytes);
  }
  StreamRegion to = copy.box;
  to.stream = reference;
  copyElements(detail::wholeRegion(dense.get()), to);
  device_.temporaries().giveBack(std::move(dense));
}

}  // namespace sk
