// SPDX-License-Identifier: MIT
//
// SK_CHECK=written for kernels and reductions: whether a result depends on an element that nothing has written. Only a kernel
// itself knows which elements it reads, and which of them it uses, so the call runs several times beforehand, each time with other
// values in the place of all elements that nothing has written, and with outputs of its own. Results that differ show
// a read, and a binary search over the changed elements finds one on which a result depends. Two runs with other old elements
// in a scatter output show which of them the call writes. A call whose arguments have been written as a whole runs just once.
// Must not depend on the kind of device.
#pragma once

#include <functional>
#include <span>

#include "sk/call.hpp"
#include "sk/options.hpp"
#include "sk/program.hpp"

namespace sk {

class DeviceState;

/// A checked call that can run with other arguments.
struct RepeatableCall {
  DeviceState& device;
  const program::Kernel& kernel;  ///< the fold of a reduction
  std::span<const Argument> arguments;
  std::span<void* const> values = {};  ///< of a reduction to values: where they go
  Box box = {};  ///< what is written of the element outputs, in their own indices, or
  bool isBoxOfWhole = false;  ///< in those of the whole that placed outputs are parts of
  /// Runs the same call with other arguments and values.
  std::function<void(std::span<const Argument>, std::span<void* const>)> run = {};
};

/// Has `run` run the call, once it is known that no result depends on an element that nothing has written, and then notes what the
/// call has written. Throws sk::Error, which names such a parameter and element, before anything has run. A call that is a step of
/// another call is not checked.
void runChecked(const RepeatableCall& call, const std::function<void()>& run);

}  // namespace sk
