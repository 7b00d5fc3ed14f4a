// SPDX-License-Identifier: MIT
//
// A kernel's call after its arguments have been checked: what every later step needs, computed once.
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
  const program::Plan* plan;  ///< its passes; null if one pass is enough
  /// The domain is a part of a whole, of which the kernel speaks: the index there of its first element, and the whole.
  Placement place = {};

  /// The same call of a variant of the kernel, which has the same parameters in another precision.
  ResolvedCall of(const program::Kernel& variant, const DeviceLimits& limits) const;
};

/// The variant of a kernel for these values of its Spec parameters, or the kernel itself.
const program::Kernel& unrolledVariant(const program::Kernel& kernel, const assemble::SpecValues& specs);

/// `arguments` must have been checked, or be correct by construction.
ResolvedCall resolveCall(const program::Kernel& kernel, std::span<const Argument> arguments,
                         const DeviceLimits& limits, const CallOptions& options = {});

/// The 32 bits of a Spec parameter's value, as assemble::SpecValues holds them.
std::uint32_t specBits(const program::Parameter& parameter, const void* value);

/// The values of the Spec parameters. Ignores all other arguments, which may be missing; values must not be
/// null.
assemble::SpecValues specsOf(const program::Kernel& kernel, std::span<const Argument> arguments);

/// The shape of a kernel's domain: the shape of its outputs or, if it has only variable and scatter outputs,
/// of its inputs that are not broadcast and of iterators that have a shape.
Shape domainOf(const program::Kernel& kernel, std::span<const Argument> arguments,
               const assemble::SpecValues& specs);

/// The plan for running a kernel with these values of its Spec parameters on a device with these limits; null if one
/// pass is enough, or if no plan fits the limits.
const program::Plan* planFor(const program::Kernel& kernel, const assemble::SpecValues& specs,
                             const DeviceLimits& limits);

}  // namespace sk
