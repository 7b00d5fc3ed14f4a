// SPDX-License-Identifier: MIT
#include "call/halo_limits.hpp"

#include <algorithm>

#include "device/region.hpp"

namespace sk {

using program::Boundary;
using program::Parameter;

namespace {

std::int64_t valueOf(const program::Distance& distance, const assemble::SpecValues& specs) {
  std::int64_t value = distance.constant;
  for (std::size_t s = 0; s < distance.perSpec.size(); ++s)
    value += std::int64_t{distance.perSpec[s]} * static_cast<std::int32_t>(specs[s]);
  return std::max<std::int64_t>(value, 0);
}

/// Whether what is known of a gather's reach holds: all that it depends on has the domain's shape.
bool holdsKnownReach(const Parameter& gather, std::span<const Argument> arguments, const Shape& domain) {
  for (std::size_t i = 0; i < arguments.size() && i < 64; ++i) {
    if ((gather.haloShapes >> i & 1) != 0 && seenShape(arguments[i].region) != domain) return false;
  }
  return true;
}

/// The index from which the limits of an element count.
std::int64_t centerOf(std::int64_t element, const HaloLimits& limits, const GatherDimension& dimension) {
  if (!limits.isPromised || dimension.extent == dimension.domainExtent) return element;
  return (2 * element + 1) * dimension.extent / (2 * dimension.domainExtent);
}

}  // namespace

GatherDimension gatherDimension(const Shape& gather, int d, const Shape& domain) {
  const int other = domain.rank() - gather.rank() + d;
  return {gather[d], other, other < 0 ? 1 : domain[other]};
}

std::optional<HaloLimits> haloLimits(const program::Kernel& kernel, std::span<const Argument> arguments,
                                     std::size_t gather, int d, const assemble::SpecValues& specs,
                                     const Shape& domain) {
  const Parameter& parameter = kernel.parameters[gather];
  const int number = seenShape(arguments[gather].region).rank() - 1 - d;
  std::optional<HaloLimits> limits;
  for (const program::Reach& reach : parameter.halo) {
    if (reach.dimension != number) continue;
    if (reach.kind != program::Reach::Kind::Near) return std::nullopt;
    if (!limits) limits.emplace();
    limits->below = std::max(limits->below, valueOf(reach.below, specs));
    limits->above = std::max(limits->above, valueOf(reach.above, specs));
    limits->isPromised = reach.isPromised;
  }
  if (!limits) return std::nullopt;
  const bool holds =
      limits->isPromised ? number < domain.rank() : holdsKnownReach(parameter, arguments, domain);
  return holds ? limits : std::nullopt;
}

IndexRange readBy(const IndexRange& elements, const HaloLimits& limits, const GatherDimension& dimension) {
  return {centerOf(elements.begin, limits, dimension) - limits.below,
          centerOf(elements.end - 1, limits, dimension) + limits.above + 1};
}

IndexRange readBy(const Box& box, const HaloLimits& limits, const GatherDimension& dimension) {
  const int d = dimension.domainDimension;
  return readBy(d < 0 ? IndexRange{0, 1} : IndexRange{box.begin[d], box.end[d]}, limits, dimension);
}

IndexRange broughtInside(Boundary boundary, const IndexRange& read, std::int64_t extent) {
  IndexRange inside{std::clamp<std::int64_t>(read.begin, 0, extent - 1),
                    std::clamp<std::int64_t>(read.end, 1, extent)};
  if (boundary != Boundary::Mirror) return inside;
  if (read.begin < -extent || read.end > 2 * extent) return {0, extent};
  if (read.begin < 0) inside.end = std::max(inside.end, -read.begin);
  if (read.end > extent) inside.begin = std::min(inside.begin, 2 * extent - read.end);
  return inside;
}

}  // namespace sk
