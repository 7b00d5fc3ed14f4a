// SPDX-License-Identifier: MIT
//
// How far a kernel reads a gather from its own element, by the kernel's descriptor (program::Reach).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "assemble/condition.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"

namespace sk {

/// How far a gather may be read in one dimension: elements before and after the kernel's own.
struct HaloLimits {
  std::int64_t below = 0, above = 0;
  bool isPromised = false;  ///< see program::Reach::isPromised
};

/// Indices from `begin` to `end` (exclusive).
struct IndexRange {
  std::int64_t begin, end;

  bool operator==(const IndexRange&) const = default;
  bool holds(const IndexRange& other) const { return begin <= other.begin && other.end <= end; }
};

/// A dimension of a gather in a call. Dimensions of the gather and of the domain belong together from the fastest on: x and x,
/// y and y.
struct GatherDimension {
  std::int64_t extent;  ///< of the gather
  int domainDimension;  ///< of the domain, rows first; negative if it has no such dimension
  std::int64_t domainExtent;  ///< 1 if it has no such dimension
};
/// `d` counts the dimensions of the gather, rows first.
GatherDimension gatherDimension(const Shape& gather, int d, const Shape& domain);

/// How far gather number `gather` may be read in dimension `d`, rows first, by a call over a domain. Returns nullopt if the
/// descriptor sets no limit, or one that does not hold for the shapes of this call's arguments.
std::optional<HaloLimits> haloLimits(const program::Kernel& kernel, std::span<const Argument> arguments,
                                     std::size_t gather, int d, const assemble::SpecValues& specs,
                                     const Shape& domain);

/// The indices that elements with the indices `elements` of the domain read, before a boundary mode brings them inside.
IndexRange readBy(const IndexRange& elements, const HaloLimits& limits, const GatherDimension& dimension);
/// The same for the elements of a box of the domain.
IndexRange readBy(const Box& box, const HaloLimits& limits, const GatherDimension& dimension);

/// The indices from 0 to `extent` (exclusive) that a boundary mode other than Wrap gives for others.
IndexRange broughtInside(program::Boundary boundary, const IndexRange& read, std::int64_t extent);

}  // namespace sk
