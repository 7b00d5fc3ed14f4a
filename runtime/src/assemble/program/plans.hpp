// SPDX-License-Identifier: MIT
//
// Selects a kernel's plan for the number of planes that a pass may write and read.
#pragma once

#include "assemble/condition.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// The planes that one pass may write and read.
struct PassLimits {
  int drawBuffers;
  int textureUnits;
};

/// Whether one pass has room for all streams that the kernel needs with these values of its Spec parameters.
bool fitsOnePass(const program::Kernel& kernel, const PassLimits& limits, const SpecValues& specs);

/// The first plan within the limits; null if there is none.
const program::Plan* planWithin(const program::Kernel& kernel, const PassLimits& limits);

}  // namespace sk::assemble
