// SPDX-License-Identifier: MIT
//
// Calls with streams that several processes share are not run here: their Distribution runs them.
#pragma once

#include <span>

#include "sk/call.hpp"
#include "sk/program.hpp"

namespace sk {

/// Whoever runs a call with these arguments in place of the runtime; null if all streams are of this process alone. Streams of
/// several Distributions may meet in one call: outputs decide before element inputs, and these before others.
inline detail::Distribution* distributionOf(const program::Kernel& kernel,
                                            std::span<const Argument> arguments) {
  detail::DistributedStream* decides = nullptr;
  int least = 3;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i].region.distributed == nullptr) continue;
    const program::Role role =
        i < kernel.parameters.size() ? kernel.parameters[i].role : program::Role::Gather;
    const int order = role == program::Role::Output ? 0 : role == program::Role::Input ? 1 : 2;
    if (order >= least) continue;
    least = order;
    decides = arguments[i].region.distributed;
  }
  return decides == nullptr ? nullptr : &decides->distribution();
}

}  // namespace sk
