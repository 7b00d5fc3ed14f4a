// SPDX-License-Identifier: MIT
#include "strips.hpp"

#include <cstring>

#include "device/region.hpp"
#include "native/native_device.hpp"
#include "native/native_stream.hpp"

namespace sk::mpi {

bool isInMemory(const StreamRegion& region) {
  return dynamic_cast<const NativeStream*>(region.stream) != nullptr;
}

std::vector<Span> spansOf(const StreamRegion& region) {
  const Components& components = nativeStream(region).components;
  const AffineRegion all = affine(region);
  std::vector<Span> spans;
  for (std::size_t c = 0; c < components.arrays().size(); ++c) {
    const std::size_t size = components.types()[c].storedBytes;
    auto* const array = static_cast<std::byte*>(components.arrays()[c]);
    for (std::int64_t w = 0; w < all.extent[3]; ++w) {
      for (std::int64_t z = 0; z < all.extent[2]; ++z) {
        for (std::int64_t y = 0; y < all.extent[1]; ++y) {
          const std::int64_t first = all.first + y * all.stride[1] + z * all.stride[2] + w * all.stride[3];
          std::byte* const row = array + static_cast<std::size_t>(first) * size;
          const std::size_t count = static_cast<std::size_t>(all.extent[0]) * size;
          if (!spans.empty() && spans.back().bytes + spans.back().count == row) {
            spans.back().count += count;
          } else {
            spans.push_back({row, count});
          }
        }
      }
    }
  }
  return spans;
}

bool holdsReals(const StreamRegion& region) {
  return !isInMemory(region) && region.stream->storage >= Storage::Extended;
}

std::size_t bytesOf(const StreamRegion& region) {
  const auto elements = static_cast<std::size_t>(region.shape.size());
  if (holdsReals(region)) {
    std::size_t components = 0;
    for (const program::Field& field : region.stream->element->fields) components += field.width;
    return elements * components * sizeof(double);
  }
  if (!isInMemory(region)) return elements * region.stream->element->size;
  std::size_t bytes = 0;
  for (const ComponentType& type : nativeStream(region).components.types()) bytes += type.storedBytes;
  return elements * bytes;
}

void readBytes(const StreamRegion& region, std::byte* to) {
  if (isInMemory(region)) return pack(spansOf(region), to);
  if (!holdsReals(region)) return detail::read(region, to, static_cast<std::size_t>(region.shape.size()));
  const std::vector<double> values = detail::readReals(region);
  std::memcpy(to, values.data(), bytesOf(region));
}

void writeBytes(const StreamRegion& region, const std::byte* from) {
  if (isInMemory(region)) return unpack(from, spansOf(region));
  if (!holdsReals(region))
    return detail::writeAsync(region, from, static_cast<std::size_t>(region.shape.size()));
  std::vector<double> values(bytesOf(region) / sizeof(double));
  std::memcpy(values.data(), from, bytesOf(region));
  detail::writeReals(region, values);
}

void pack(std::span<const Span> from, std::byte* to) {
  for (const Span& span : from) {
    std::memcpy(to, span.bytes, span.count);
    to += span.count;
  }
}

void unpack(const std::byte* from, std::span<const Span> to) {
  for (const Span& span : to) {
    std::memcpy(span.bytes, from, span.count);
    from += span.count;
  }
}

}  // namespace sk::mpi
