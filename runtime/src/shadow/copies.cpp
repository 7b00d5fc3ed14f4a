// SPDX-License-Identifier: MIT
#include "shadow/copies.hpp"

#include <algorithm>
#include <vector>

#include "device/region.hpp"
#include "sk/host_vector.hpp"
#include "sk/native/parallel.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

/// Elements of two native streams, run by run, on several threads. The first may hold floats and the second doubles.
void copyNative(const NativeStream& source, const AffineRegion& from, NativeStream& target,
                const AffineRegion& to) {
  constexpr std::int64_t longest = 1 << 15;
  const std::int64_t columns = from.extent[0], pieces = (columns + longest - 1) / longest;
  const std::int64_t rows = from.extent[1] * from.extent[2] * from.extent[3];
  const auto runOf = [&](const AffineRegion& region, std::int64_t row) {
    const std::int64_t y = row % from.extent[1], z = row / from.extent[1] % from.extent[2],
                       w = row / from.extent[1] / from.extent[2];
    return Run{region.first + y * region.stride[1] + z * region.stride[2] + w * region.stride[3], columns,
               region.stride[0]};
  };
  native::inParallel(
      rows * pieces, std::min(columns, longest), native::Deal::Evenly, [&](native::Range range) {
        for (std::int64_t i = range.begin; i < range.end; ++i) {
          const std::int64_t begin = i % pieces * longest, end = std::min(columns, begin + longest);
          target.components.copy(source.components, runOf(from, i / pieces).part(begin, end),
                                 runOf(to, i / pieces).part(begin, end));
        }
      });
}

/// Elements in order from number `first` on, with the extents of a region.
AffineRegion denseLike(const AffineRegion& shape, std::int64_t first) {
  AffineRegion dense = shape;
  dense.first = first;
  std::int64_t stride = 1;
  for (std::size_t d = 0; d < dense.extent.size(); ++d) {
    dense.stride[d] = stride;
    stride *= dense.extent[d];
  }
  return dense;
}

}  // namespace

bool holdsOnlyFloats(const program::Element& element) {
  return std::ranges::all_of(
      element.fields, [](const program::Field& field) { return field.scalar == program::Scalar::Float; });
}

std::int64_t bytesOf(const NativeStream& stream) {
  std::int64_t bytes = 0;
  for (const ComponentType& component : stream.components.types())
    bytes += stream.shape.size() * static_cast<std::int64_t>(component.storedBytes);
  return bytes;
}

bool isAllInOrder(const StreamRegion& region) {
  if (region.shape.size() != region.stream->shape.size()) return false;
  const AffineRegion all = affine(region), dense = denseLike(all, 0);
  for (std::size_t d = 0; d < all.extent.size(); ++d) {
    if (all.extent[d] > 1 && all.stride[d] != dense.stride[d]) return false;
  }
  return true;
}

void copyToDevice(NativeStream& from, const StreamRegion& to) {
  const StreamRegion all = detail::wholeRegion(&from);
  if (to.shape.size() == 0) return;
  if (dynamic_cast<const NativeStream*>(to.stream) != nullptr) return copyElements(all, to);
  if (holdsOnlyFloats(*from.element)) return detail::writeReals(to, detail::readReals(all));
  auto elements = detail::hostVector<std::byte>(bytesOf(to.shape.size(), from.element->size));
  detail::read(all, elements.data(), static_cast<std::size_t>(to.shape.size()));
  detail::write(to, elements.data(), static_cast<std::size_t>(to.shape.size()));
}

void copyElements(const StreamRegion& from, const StreamRegion& to) {
  if (from.shape.size() == 0) return;
  auto& target = static_cast<NativeStream&>(*to.stream);
  if (const auto* const source = dynamic_cast<const NativeStream*>(from.stream)) {
    const AffineRegion there = affine(from), here = affine(to);
    // regions of different ranks: the target has all elements in order
    copyNative(*source, there, target, there.extent == here.extent ? here : denseLike(there, here.first));
    target.setWritten();
    return;
  }
  if (holdsOnlyFloats(*target.element)) {
    target.writeReals(to, detail::readReals(from).data());
    return;
  }
  auto elements = detail::hostVector<std::byte>(bytesOf(from.shape.size(), target.element->size));
  detail::read(from, elements.data(), static_cast<std::size_t>(from.shape.size()));
  target.write(to, elements.data());
}

}  // namespace sk
