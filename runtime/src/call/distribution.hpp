// SPDX-License-Identifier: MIT
//
// Calls with streams that several processes share are not run here: their Distribution runs them. Nor are those with streams of a
// device that stands in front of others.
#pragma once

#include <optional>
#include <span>

#include "device/device_state.hpp"
#include "device/stream_state.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"

namespace sk {

/// What makes the calls of a device in place of the runtime; null if nothing does.
inline detail::Distribution* interposedIn(std::span<const Argument> arguments,
                                          const std::optional<GivenDomain>& over) {
  for (const Argument& argument : arguments) {
    const StreamState* const stream = argument.region.stream;
    if (stream != nullptr && stream->device != nullptr && stream->device->interposed != nullptr)
      return stream->device->interposed;
  }
  return over && over->device != nullptr ? over->device->interposed : nullptr;
}

/// Whoever runs a call with these arguments in place of the runtime; null if all streams are of this process alone. Streams of
/// several Distributions may meet in one call: outputs decide before element inputs, these before others of the shape that over()
/// gives, and these before all others.
inline detail::Distribution* distributionOf(const program::Kernel& kernel,
                                            std::span<const Argument> arguments,
                                            const std::optional<GivenDomain>& over) {
  detail::DistributedStream* decides = nullptr;
  int least = 4;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i].region.distributed == nullptr) continue;
    const program::Role role =
        i < kernel.parameters.size() ? kernel.parameters[i].role : program::Role::Gather;
    const bool isGiven = over && arguments[i].region.shape == over->shape;
    const int order = role == program::Role::Output ? 0 : role == program::Role::Input ? 1 : isGiven ? 2 : 3;
    if (order >= least) continue;
    least = order;
    decides = arguments[i].region.distributed;
  }
  return decides == nullptr ? interposedIn(arguments, over) : &decides->distribution();
}

}  // namespace sk
