// SPDX-License-Identifier: MIT
//
// SK_CHECK=ranges: whether arguments and results keep the ranges that their parameters declare ([[range(lo, hi)]]). What a call
// reads is checked before it runs. What it writes is found by running it with outputs of our own first, so that a call that fails has
// changed nothing. Must not depend on the kind of device.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "sk/call.hpp"
#include "sk/options.hpp"
#include "sk/program.hpp"

namespace sk {

class DeviceState;

/// A call of a kernel or a reduction that can run with other arguments.
struct RangedCall {
  DeviceState& device;
  const program::Kernel& kernel;  ///< the fold of a reduction
  std::span<const Argument> arguments;
  Box box = {};  ///< what is written of the element outputs
  std::span<void* const> values = {};  ///< of a reduction to values: where they go
  bool checksFolded = true;  ///< false if the accumulators are those of a part of the elements
  /// Runs the same call with other arguments and values.
  std::function<void(std::span<const Argument>, std::span<void* const>)> run = {};
};

/// Throws sk::Error, which names the parameter and the element, if an argument or a result is not in its range. Does nothing unless
/// SK_CHECK asks for it, and for a call that is a step of another. If the device records, the loop checks the call each time that it
/// comes here. The arguments have passed the checks of the call.
void checkRanges(const RangedCall& call);

/// The two parts of checkRanges(), neither of which is recorded: for what is read, and for what is written.
void checkRangesRead(const program::Kernel& kernel, std::span<const Argument> arguments);
void checkRangesWritten(const RangedCall& call);

/// Throws sk::Error unless a result, in host memory or in a stream, is in the range of its parameter, if that has one.
void checkResultRange(const program::Kernel& kernel, const program::Parameter& parameter,
                      const std::byte* value);
void checkResultRange(const program::Kernel& kernel, const program::Parameter& parameter,
                      const StreamRegion& region);

}  // namespace sk
