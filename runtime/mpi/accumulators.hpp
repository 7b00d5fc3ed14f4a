// SPDX-License-Identifier: MIT
//
// The accumulators of a reduction in streams, one element for each part of a domain, and their bytes as ranks send them.
// Combines many results of a fold with earlier ones, element by element: natively by the reduction's own code, on GL devices
// by a reduction over blocks of two.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "call/resolved_call.hpp"
#include "device/device_state.hpp"
#include "device/stream_state.hpp"
#include "domain_state.hpp"
#include "strips.hpp"

namespace sk::mpi {

using Bytes = std::vector<std::byte>;

inline bool hasFloats(const program::Element& element) {
  return std::ranges::any_of(
      element.fields, [](const program::Field& field) { return field.scalar == program::Scalar::Float; });
}

class Accumulators {
 public:
  /// One stream of this shape for each accumulator. `inDoubles`: native code folds floats in doubles.
  Accumulators(DeviceState& device, const program::Reduction& reduction, const Shape& shape, bool inDoubles) {
    for (const program::Parameter& parameter : reduction.fold.parameters) {
      if (parameter.role != program::Role::Accumulator) continue;
      const Storage storage = inDoubles && hasFloats(*parameter.element) ? Storage::Double : Storage::Single;
      streams_.emplace_back(device.createStream(*parameter.element, shape, storage).release());
      regions.push_back(detail::wholeRegion(streams_.back().get()));
    }
  }

  std::vector<StreamRegion> regions;

  /// The arguments of a call, with these streams for its accumulators.
  std::vector<Argument> in(const program::Reduction& reduction, std::span<const Argument> arguments) const {
    std::vector<Argument> all(arguments.begin(), arguments.end());
    all.resize(reduction.fold.parameters.size());
    std::size_t next = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (reduction.fold.parameters[i].role == program::Role::Accumulator)
        all[i] = {.region = regions[next++]};
    }
    return all;
  }

  /// The bytes of one element of all accumulators.
  std::size_t elementBytes() const {
    std::size_t bytes = 0;
    for (const StreamRegion& region : regions) bytes += bytesOf(region) / elements();
    return bytes;
  }
  std::size_t elements() const { return static_cast<std::size_t>(regions.front().shape.size()); }

  /// Element by element.
  Bytes read() const {
    Bytes bytes(elements() * elementBytes());
    forEachPart([&](const StreamRegion& region, std::size_t offset) {
      const std::size_t size = bytesOf(region) / elements();
      const Bytes own = readAll(region);
      for (std::size_t k = 0; k < elements(); ++k)
        std::memcpy(bytes.data() + k * elementBytes() + offset, own.data() + k * size, size);
    });
    return bytes;
  }
  void write(const Bytes& bytes) {
    forEachPart([&](const StreamRegion& region, std::size_t offset) {
      const std::size_t size = bytesOf(region) / elements();
      Bytes own(elements() * size);
      for (std::size_t k = 0; k < elements(); ++k)
        std::memcpy(own.data() + k * size, bytes.data() + k * elementBytes() + offset, size);
      writeAll(region, own);
    });
  }

 private:
  template <class Visit>
  void forEachPart(Visit&& visit) const {
    std::size_t offset = 0;
    for (const StreamRegion& region : regions) {
      visit(region, offset);
      offset += bytesOf(region) / elements();
    }
  }

  /// The scalars of native streams as they are stored, so that doubles stay doubles; else elements. One after the other.
  Bytes readAll(const StreamRegion& region) const {
    Bytes bytes(bytesOf(region));
    if (!isInMemory(region)) {
      region.stream->read(region, bytes.data());
      return bytes;
    }
    std::byte* to = bytes.data();
    for (std::size_t k = 0; k < elements(); ++k) {
      for (const Span& span : scalarsAt(region, k)) {
        std::memcpy(to, span.bytes, span.count);
        to += span.count;
      }
    }
    return bytes;
  }
  void writeAll(const StreamRegion& region, const Bytes& bytes) {
    if (!isInMemory(region)) return region.stream->write(region, bytes.data());
    const std::byte* from = bytes.data();
    for (std::size_t k = 0; k < elements(); ++k) {
      for (const Span& span : scalarsAt(region, k)) {
        std::memcpy(span.bytes, from, span.count);
        from += span.count;
      }
    }
  }
  static std::vector<Span> scalarsAt(const StreamRegion& region, std::size_t k) {
    StreamRegion element = detail::reshaped(region, Shape{region.shape.size()});
    const auto at = static_cast<std::int64_t>(k);
    element = detail::partOf(element, {at}, {at + 1});
    return spansOf(element);
  }

  std::vector<detail::StreamOwner> streams_;
};

/// Which earlier result an element follows: number (k / (inner * length)) * inner + k % inner for element k. So lines along a
/// dimension of extent `length`, with `inner` elements after it, each have one.
struct LinesOf {
  std::int64_t length = 1, inner = 1;

  std::int64_t lineOf(std::int64_t element) const {
    return element / (inner * length) * inner + element % inner;
  }
};

/// Folds blocks of partial results of the call's reduction, in order: `parts` and `results` have one region for each
/// accumulator.
void combineAsReduction(DomainState& domain, const ResolvedReduction& call,
                        std::span<const StreamRegion> parts, std::span<const StreamRegion> results);

/// Folds each element of `later` into the earlier result that it follows, and stores the result in its place. Both have one
/// dimension. `call` gives the reduction, its arguments other than streams, and options.
void combineEach(DomainState& domain, const ResolvedReduction& call, const Accumulators& earlier,
                 Accumulators& later, const LinesOf& lines);

}  // namespace sk::mpi
