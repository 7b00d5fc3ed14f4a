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
};

/// Returns nullopt if the descriptor sets no limit in this dimension, where 0 is x.
std::optional<HaloLimits> haloLimits(const program::Parameter& gather, int dimension,
                                     const assemble::SpecValues& specs);

/// Whether the limits of gather number `gather` hold for a call: it, and what they depend on, have the domain's shape.
bool areLimitsValid(const program::Kernel& kernel, std::span<const Argument> arguments, std::size_t gather,
                    const Shape& domain);

}  // namespace sk
