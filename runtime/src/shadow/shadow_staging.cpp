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

/// Copies the arrays of a stream to memory, one after the other. Returns the end.
std::byte* pack(const NativeStream& stream, std::byte* to) {
  for (std::size_t c = 0; c < stream.components.types().size(); ++c) {
    const std::size_t bytes =
        static_cast<std::size_t>(stream.shape.size()) * stream.components.types()[c].storedBytes;
    std::memcpy(to, stream.components.arrays()[c], bytes);
    to += wholeWords(bytes);
  }
  return to;
}

const std::byte* unpack(const std::byte* from, NativeStream& stream) {
  for (std::size_t c = 0; c < stream.components.types().size(); ++c) {
    const std::size_t bytes =
        static_cast<std::size_t>(stream.shape.size()) * stream.components.types()[c].storedBytes;
    std::memcpy(stream.components.arrays()[c], from, bytes);
    from += wholeWords(bytes);
  }
  return from;
}

}  // namespace

/// The device's elements, then the reference's, both in the types that the reference holds: a device may hold doubles for floats.
std::size_t ShadowStaging::bytesOf(const StreamRegion& box) const {
  std::size_t bytes = 0;
  for (const ComponentType& component : componentsOf(*box.stream->element, RealType::Double))
    bytes += 2 * wholeWords(static_cast<std::size_t>(box.shape.size()) * component.storedBytes);
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
  stream.noteRead(copy.box);
  StreamRegion reference = copy.box;
  reference.stream = stream.reference();
  std::unique_ptr<NativeStream> dense = device_.temporaries().take(*stream.element, copy.box.shape);
  copyElements(stream.innerOf(copy.box), detail::wholeRegion(dense.get()));
  std::byte* const next = pack(*dense, memory_.data() + copy.offset);
  if (reference.stream != nullptr) copyElements(reference, detail::wholeRegion(dense.get()));
  pack(*dense, next);
  device_.temporaries().giveBack(std::move(dense));
}

void ShadowStaging::bring(const Copy& copy) {
  ShadowStream& stream = shadowStream(copy.box);
  StreamRegion reference = copy.box;
  reference.stream = stream.reference();
  std::unique_ptr<NativeStream> dense = device_.temporaries().take(*stream.element, copy.box.shape);
  const std::byte* const next = unpack(memory_.data() + copy.offset, *dense);
  copyToDevice(*dense, stream.innerOf(copy.box));
  stream.mirrorMarks();
  unpack(next, *dense);
  if (reference.stream != nullptr) copyElements(detail::wholeRegion(dense.get()), reference);
  device_.temporaries().giveBack(std::move(dense));
}

}  // namespace sk
