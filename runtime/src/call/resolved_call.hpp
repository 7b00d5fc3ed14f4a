// SPDX-License-Identifier: MIT
//
// What every step of a kernel's call needs to know beside its arguments, found once after these have been checked.
#pragma once

#include <cstdint>
#include <span>

#include "assemble/condition.hpp"
#include "sk/call.hpp"
#include "sk/device.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"

namespace sk {

struct ResolvedCall {
  const program::Kernel& kernel;
  std::span<const Argument> arguments;
  CallOptions options;
  assemble::SpecValues specs;
  Shape domain;
  const program::Plan* plan;  ///< its passes; null where one will do

  /// The same call of a variant of the kernel, which has the same parameters in another precision.
  ResolvedCall of(const program::Kernel& variant, const DeviceLimits& limits) const;
};

/// The arguments have been checked, or are right by construction.
ResolvedCall resolveCall(const program::Kernel& kernel, std::span<const Argument> arguments,
                         const DeviceLimits& limits, const CallOptions& options = {});

/// The 32 bits of a Spec parameter's value, as assemble::SpecValues holds them.
std::uint32_t specBits(const program::Parameter& parameter, const void* value);

/// The values of the Spec parameters. Only their arguments are looked at, which are not null.
assemble::SpecValues specsOf(const program::Kernel& kernel, std::span<const Argument> arguments);

/// The shape that a kernel runs over: that of its outputs, or, where it has only variable and scatter outputs,
/// of its inputs without those that repeat, and iterators that have one.
Shape domainOf(const program::Kernel& kernel, std::span<const Argument> arguments,
               const assemble::SpecValues& specs);

/// The plan by which a kernel runs on a device with these limits; null where one pass will do, and where there is no
/// plan within the limits.
const program::Plan* planFor(const program::Kernel& kernel, const DeviceLimits& limits);

}  // namespace sk
