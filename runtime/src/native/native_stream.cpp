// SPDX-License-Identifier: MIT
#include "native/native_stream.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "device/region.hpp"
#include "native/native_device.hpp"
#include "sk/error.hpp"
#include "sk/limits.hpp"
#include "sk/native/parallel.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

std::int64_t rowsOf(const AffineRegion& region) {
  return region.extent[1] * region.extent[2] * region.extent[3];
}

Run rowOf(const AffineRegion& region, std::int64_t row) {
  const std::int64_t y = row % region.extent[1], plane = row / region.extent[1];
  const std::int64_t z = plane % region.extent[2], w = plane / region.extent[2];
  return {region.first + y * region.stride[1] + z * region.stride[2] + w * region.stride[3], region.extent[0],
          region.stride[0]};
}

/// Calls visit(run, number in the region of its first element) for each row of the region.
template <class Visit>
void forEachRun(const StreamRegion& region, Visit&& visit) {
  const AffineRegion all = affine(region);
  for (std::int64_t row = 0; row < rowsOf(all); ++row) visit(rowOf(all, row), row * all.extent[0]);
}

/// Calls visit(row) for each row of the region, on several threads if there are many elements.
template <class Visit>
void forEachRow(const AffineRegion& region, Visit&& visit) {
  if (rowsOf(region) == 1) return visit(std::int64_t{0});
  native::inParallel(rowsOf(region), region.extent[0], native::Deal::Evenly, [&](native::Range rows) {
    for (std::int64_t row = rows.begin; row < rows.end; ++row) visit(row);
  });
}

}  // namespace

namespace {

void place(native::Operand& operand, const StreamRegion& region) {
  native::HeldIndices& held = operand.held.emplace(native::HeldIndices{{}, operand.extent});
  const int rank = region.shape.rank();
  for (int d = 0; d < rank; ++d) {
    const auto axis = static_cast<std::size_t>(rank - 1 - d);
    const std::int64_t origin = originOf(region, d);
    held.low[axis] = origin;
    held.high[axis] = origin + region.shape[d];
    operand.extent[axis] = seenShape(region)[d];
    operand.first -= origin * operand.stride[axis];
  }
}

}  // namespace

native::Operand operandOf(const StreamRegion& region) {
  const AffineRegion all = affine(region);
  native::Operand operand;
  operand.first = all.first;
  operand.stride = all.stride;
  operand.extent = all.extent;
  if (isPlaced(region)) place(operand, region);
  return operand;
}

NativeStream::NativeStream(NativeDevice& on, const program::Element& type, const Shape& extents, Storage as)
    : StreamState(on, type, extents, as) {
  try {
    const RealType least = storage >= Storage::Extended ? RealType::Double : RealType::Float;
    components = Components(type, std::max(least, on.real()), extents.size());
    if (storage == Storage::Half) components.holdHalves();
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
  setWritten();  // from here on nothing throws
  forEachRun(region, [&](const Run& run, std::int64_t number) {
    components.write(run, elements + static_cast<std::size_t>(number) * element->size, element->size);
  });
  keepStorage(region);
}

void NativeStream::read(const StreamRegion& region, std::byte* elements) {
  forEachRun(region, [&](const Run& run, std::int64_t number) {
    components.read(run, elements + static_cast<std::size_t>(number) * element->size, element->size);
  });
}

void NativeStream::readReals(const StreamRegion& region, double* values) {
  forEachRun(region, [&](const Run& run, std::int64_t number) {
    components.readReals(run, values + static_cast<std::size_t>(number) * components.arrays().size());
  });
}

void NativeStream::writeReals(const StreamRegion& region, const double* values) {
  setWritten();  // from here on nothing throws
  forEachRun(region, [&](const Run& run, std::int64_t number) {
    components.writeReals(run, values + static_cast<std::size_t>(number) * components.arrays().size());
  });
  keepStorage(region);
}

void NativeStream::fill(const StreamRegion& region, const std::byte* value) {
  setWritten();  // from here on nothing throws
  const AffineRegion all = affine(region);
  forEachRow(all, [&](std::int64_t row) { components.fill(rowOf(all, row), value); });
  keepStorage(region);
}

void NativeStream::exchangeElements(StreamState& other) noexcept {
  auto& with = static_cast<NativeStream&>(other);
  std::swap(components, with.components);
  std::swap(spare_, with.spare_);
  std::swap(room_, with.room_);
  std::swap(capacity_, with.capacity_);
  std::swap(bytes_, with.bytes_);
  exchangeMarks(other);
}

bool NativeStream::copyFrom(const StreamRegion& from, const StreamRegion& to) {
  const NativeStream& source = nativeStream(from);
  const AffineRegion here = affine(to), there = affine(from);
  Components before;  // overlapping elements are read with their old values
  if (&source == this) before = components.clone(shape.size(), components.real());
  setWritten();  // from here on nothing throws
  const Components& read = &source == this ? before : source.components;
  forEachRow(here, [&](std::int64_t row) { components.copy(read, rowOf(there, row), rowOf(here, row)); });
  keepStorage(to);
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
  native::inParallel(
      static_cast<std::int64_t>(sources.size()), 2, native::Deal::Evenly, [&](native::Range range) {
        for (auto i = static_cast<std::size_t>(range.begin); i < static_cast<std::size_t>(range.end); ++i) {
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
    forEachRun(region, [&](const Run& run, std::int64_t) {
      for (std::int64_t i = 0; i < run.count; ++i) places.push_back(run.first + i * run.step);
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
  forEachRun(region, [&](const Run& run, std::int64_t number) {
    components.writeScalars(component, run, values + static_cast<std::size_t>(number) * bytes);
  });
}

// A reference rounds nothing, because storage is measured against it.
void NativeStream::keepStorage(const StreamRegion& region) {
  if (storage != Storage::Half || components.real() != RealType::Float || region.shape.size() == 0) return;
  const AffineRegion all = affine(region);
  forEachRow(all, [&](std::int64_t row) { components.roundToHalf(rowOf(all, row)); });
  components.holdHalves();  // they may have been exchanged
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
  setWritten();
  countBytes();
}

}  // namespace sk
