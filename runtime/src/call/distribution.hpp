// SPDX-License-Identifier: MIT
//
// Calls with streams that several processes share are not run here: their Distribution runs them.
#pragma once

#include <span>

#include "sk/call.hpp"

namespace sk {

/// Whoever runs a call with these arguments in place of the runtime; null if all streams are of this process alone.
inline detail::Distribution* distributionOf(std::span<const Argument> arguments) {
  for (const Argument& argument : arguments) {
    if (argument.region.distributed != nullptr) return &argument.region.distributed->distribution();
  }
  return nullptr;
}

}  // namespace sk
