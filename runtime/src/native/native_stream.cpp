// SPDX-License-Identifier: MIT
#include "native/native_stream.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "native/native_device.hpp"
#include "sk/error.hpp"
#include "sk/limits.hpp"
#include "sk/native/parallel.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

/// Calls visit(first element in the stream, number in the region, length) for every run of neighbours.
template <class Visit>
void forEachRun(const StreamRegion& region, Visit&& visit) {
  const native::Operand place = operandOf(region);
  const native::Extents& extent = place.extent;
  std::int64_t number = 0;
  for (std::int64_t w = 0; w < extent[3]; ++w) {
    for (std::int64_t z = 0; z < extent[2]; ++z) {
      for (std::int64_t y = 0; y < extent[1]; ++y, number += extent[0]) {
        visit(place.first + y * place.stride[1] + z * place.stride[2] + w * place.stride[3], number,
              extent[0]);
      }
    }
  }
}

}  // namespace

native::Operand operandOf(const StreamRegion& region) {
  native::Operand operand;
  const Shape& whole = region.stream->shape;
  std::int64_t stride = 1;
  for (int d = whole.rank() - 1; d >= 0; --d) {
    const auto fromFastest = static_cast<std::size_t>(whole.rank() - 1 - d);
    operand.extent[fromFastest] = region.shape[d];
    operand.stride[fromFastest] = stride;
    operand.first += region.begin[d] * stride;
    stride *= whole[d];
  }
  return operand;
}

NativeStream::NativeStream(NativeDevice& on, const program::Element& type, const Shape& extents, Storage as)
    : StreamState(on, type, extents, as) {
  try {
    const RealType least = storage >= Storage::Extended ? RealType::Double : RealType::Float;
    components = Components(type, std::max(least, on.real()), extents.size());
  } catch (const NoMemory& error) {
    throw Error(fmt::format("'{}' has no memory for a stream of {} of shape {}: an array of {} bytes",
                            on.name(), type.name, toString(extents), error.bytes()),
                Error::Kind::Memory);
  }
  countBytes();
}

NativeStream::~NativeStream() {
  if (device != nullptr) owner().countBytes(-bytes_);
}

void NativeStream::countBytes() noexcept {
  const std::int64_t before = bytes_;
  bytes_ = 0;
  for (const Components* all : {&components, &spare_}) {
    for (const ComponentType& component : all->types()) {
      bytes_ += shape.size() * static_cast<std::int64_t>(component.storedBytes);
    }
  }
  for (const ComponentType& component : components.types()) {
    bytes_ += room_.count * static_cast<std::int64_t>(component.storedBytes);
  }
  owner().countBytes(bytes_ - before);
}

NativeDevice& NativeStream::owner() const { return static_cast<NativeDevice&>(*device); }

void NativeStream::write(const StreamRegion& region, const std::byte* elements) {
  isBroken = false;  // from here on nothing throws
  forEachRun(region, [&](std::int64_t first, std::int64_t number, std::int64_t count) {
    components.write(first, count, elements + static_cast<std::size_t>(number) * element->size,
                     element->size);
  });
  keepStorage();
}

void NativeStream::read(const StreamRegion& region, std::byte* elements) {
  forEachRun(region, [&](std::int64_t first, std::int64_t number, std::int64_t count) {
    components.read(first, count, elements + static_cast<std::size_t>(number) * element->size, element->size);
  });
}

void NativeStream::readReals(const StreamRegion& region, double* values) {
  forEachRun(region, [&](std::int64_t first, std::int64_t number, std::int64_t count) {
    components.readReals(first, count,
                         values + static_cast<std::size_t>(number) * components.arrays().size());
  });
}

void NativeStream::writeReals(const StreamRegion& region, const double* values) {
  isBroken = false;  // from here on nothing throws
  forEachRun(region, [&](std::int64_t first, std::int64_t number, std::int64_t count) {
    components.writeReals(first, count,
                          values + static_cast<std::size_t>(number) * components.arrays().size());
  });
  keepStorage();
}

void NativeStream::fill(const StreamRegion& region, const std::byte* value) {
  isBroken = false;  // from here on nothing throws
  forEachRun(region, [&](std::int64_t first, std::int64_t, std::int64_t count) {
    components.fill(first, count, value);
  });
  keepStorage();
}

void NativeStream::exchangeElements(StreamState& other) noexcept {
  auto& with = static_cast<NativeStream&>(other);
  std::swap(components, with.components);
  std::swap(spare_, with.spare_);
  std::swap(room_, with.room_);
  std::swap(capacity_, with.capacity_);
  std::swap(bytes_, with.bytes_);
  std::swap(isBroken, with.isBroken);
}

bool NativeStream::copyFrom(const StreamRegion& from, const StreamRegion& to) {
  const NativeStream& source = nativeStream(from);
  std::vector<std::int64_t> starts;
  forEachRun(from, [&](std::int64_t first, std::int64_t, std::int64_t) { starts.push_back(first); });
  Components before;  // overlapping elements are read with their old values
  if (&source == this) before = components.clone(shape.size(), components.real());
  isBroken = false;  // from here on nothing throws
  auto start = starts.begin();
  forEachRun(to, [&](std::int64_t first, std::int64_t, std::int64_t count) {
    components.copy(&source == this ? before : source.components, *start++, first, count);
  });
  keepStorage();
  return true;
}

namespace {

/// Values of one array; __float128 is two of 64 bits.
template <class T, std::size_t Count = 1>
struct Bits {
  T bits[Count];
};

template <class T>
void permuteValues(const void* from, void* to, std::span<const std::int32_t> sources,
                   std::span<const std::int64_t> places) {
  const T* const before = static_cast<const T*>(from);
  T* const after = static_cast<T*>(to);
  native::inParallel(static_cast<std::int64_t>(sources.size()), 2, native::Deal::Evenly,
                     [&](native::Range range) {
                       for (auto i = static_cast<std::size_t>(range.begin);
                            i < static_cast<std::size_t>(range.end); ++i) {
                         const auto source = static_cast<std::size_t>(sources[i]);
                         if (places.empty()) {
                           after[i] = before[source];
                         } else {
                           after[places[i]] = before[places[source]];
                         }
                       }
                     });
}

}  // namespace

void NativeStream::permute(const StreamRegion& region, std::span<const std::int32_t> sources) {
  Components& to = spare();
  std::vector<std::int64_t> places;  // empty if the region is the whole stream
  if (region.shape != shape) {
    to.assign(components, shape.size());
    forEachRun(region, [&](std::int64_t first, std::int64_t, std::int64_t count) {
      for (std::int64_t i = 0; i < count; ++i) places.push_back(first + i);
    });
  }
  for (std::size_t c = 0; c < components.arrays().size(); ++c) {
    const void* const before = components.arrays()[c];
    void* const after = to.arrays()[c];
    switch (components.types()[c].storedBytes) {
      case 1: permuteValues<Bits<std::uint8_t>>(before, after, sources, places); break;
      case 2: permuteValues<Bits<std::uint16_t>>(before, after, sources, places); break;
      case 4: permuteValues<Bits<std::uint32_t>>(before, after, sources, places); break;
      case 8: permuteValues<Bits<std::uint64_t>>(before, after, sources, places); break;
      default: permuteValues<Bits<std::uint64_t, 2>>(before, after, sources, places); break;
    }
  }
  exchange();
}

void NativeStream::writeScalars(const StreamRegion& region, std::size_t offset, const std::byte* values) {
  const std::span<const ComponentType> types = components.types();
  const auto component =
      static_cast<std::size_t>(std::ranges::find(types, offset, &ComponentType::offset) - types.begin());
  const std::size_t bytes = types[component].storedBytes;
  forEachRun(region, [&](std::int64_t first, std::int64_t number, std::int64_t count) {
    components.writeScalars(component, first, count, values + static_cast<std::size_t>(number) * bytes);
  });
}

// A reference rounds nothing, because storage is measured against it.
void NativeStream::keepStorage() {
  if (storage == Storage::Half && components.real() == RealType::Float) {
    components.roundToHalf(shape.size());
  }
}

Components& NativeStream::spare() {
  if (spare_.arrays().empty()) {
    spare_ = Components(*element, components.real(), shape.size());
    countBytes();
  }
  return spare_;
}

StreamTexture NativeStream::texture(int) {
  throw Error(
      fmt::format("texture: '{}' has no textures; read() the stream, or use a device with GL (SK_DEVICE=gl)",
                  owner().name()),
      Error::Kind::Device);
}

void NativeStream::fillBuffer(std::uint32_t, std::int64_t, int) {
  throw Error(fmt::format("fillBuffer: '{}' has no GL; read() the stream and upload it, or use a device with "
                          "GL (SK_DEVICE=gl)",
                          owner().name()),
              Error::Kind::Device);
}

Components NativeStream::heldOf(native::Pushed pushed, RealType real) const {
  const std::int64_t count = pushed.count;
  if (count > mostExtent) {
    throw Error(
        fmt::format(
            "a kernel has pushed {} values to a stream, which holds {} in one dimension; divide the domain",
            count, mostExtent),
        Error::Kind::Shape);
  }
  Components given = pushed.arrays.empty() ? Components(*element, real, 0)
                                           : Components(*element, real, std::move(pushed.arrays));
  return real == components.real() ? std::move(given) : given.clone(count, components.real());
}

void NativeStream::replaceElements(Components&& pushed, std::int64_t count, std::int64_t capacity) noexcept {
  const std::int64_t before = std::max(capacity_, shape.size());
  room_ = {.arrays = components.release(), .count = shape.size(), .capacity = before};
  components = std::move(pushed);
  capacity_ = std::max(capacity, count);
  spare_ = {};
  shape = Shape(count);
  isBroken = false;
  countBytes();
}

}  // namespace sk
