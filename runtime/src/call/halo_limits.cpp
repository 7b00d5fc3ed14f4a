// SPDX-License-Identifier: MIT
#include "call/halo_limits.hpp"

#include <algorithm>

#include "device/region.hpp"

namespace sk {

using program::Parameter;

namespace {

std::int64_t valueOf(const program::Distance& distance, const assemble::SpecValues& specs) {
  std::int64_t value = distance.constant;
  for (std::size_t s = 0; s < distance.perSpec.size(); ++s)
    value += std::int64_t{distance.perSpec[s]} * static_cast<std::int32_t>(specs[s]);
  return std::max<std::int64_t>(value, 0);
}

}  // namespace

std::optional<HaloLimits> haloLimits(const Parameter& gather, int dimension,
                                     const assemble::SpecValues& specs) {
  std::optional<HaloLimits> limits;
  for (const program::Reach& reach : gather.halo) {
    if (reach.dimension != dimension) continue;
    if (reach.kind != program::Reach::Kind::Near) return std::nullopt;
    if (!limits) limits.emplace();
    limits->below = std::max(limits->below, valueOf(reach.below, specs));
    limits->above = std::max(limits->above, valueOf(reach.above, specs));
  }
  return limits;
}

bool areLimitsValid(const program::Kernel& kernel, std::span<const Argument> arguments, std::size_t gather,
                    const Shape& domain) {
  const Parameter& parameter = kernel.parameters[gather];
  if (parameter.halo.empty()) return false;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const bool counts = i == gather || (i < 64 && (parameter.haloShapes >> i & 1) != 0);
    if (counts && seenShape(arguments[i].region) != domain) return false;
  }
  return true;
}

}  // namespace sk
