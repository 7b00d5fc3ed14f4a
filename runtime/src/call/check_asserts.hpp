// SPDX-License-Identifier: MIT
//
// SK_CHECK=asserts: evaluates the assertions of a kernel or a fold before it runs. A kernel of its own (program::AssertionCheck)
// writes for each element the number of the first assertion that fails. Must not depend on the kind of device.
#pragma once

#include <optional>
#include <span>

#include "call/check_written.hpp"
#include "device/device_state.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"

namespace sk {

/// While it lives, calls on the device evaluate no assertions and check no ranges, since those of the call whose parts they are have been
/// checked. Does nothing unless SK_CHECK asks for assertions or ranges.
class AssertionsEvaluated {
 public:
  explicit AssertionsEvaluated(DeviceState& device) {
    if (checksAsserts() || checksRanges()) steps_.emplace(device);
  }

 private:
  std::optional<UncheckedSteps> steps_;
};

/// Throws sk::Error if an assertion fails for an element of the domain, or of the box of it in the options, and names the first
/// such element in row-major order. Does nothing unless SK_CHECK asks for it. If the device records, the loop checks it
/// each time that it comes here. The arguments have passed the checks of the call; the options are resolved.
void checkAssertions(DeviceState& device, const program::Kernel& kernel, std::span<const Argument> arguments,
                     const Shape& domain, const CallOptions& options);

/// Likewise for a fold, whose domain is that of its inputs or outputs. `box`: the elements that it folds; all if it is whole.
void checkFoldAssertions(DeviceState& device, const program::Kernel& fold,
                         std::span<const Argument> arguments, const Box& box, const CallOptions& options);

}  // namespace sk
