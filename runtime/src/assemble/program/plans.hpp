// SPDX-License-Identifier: MIT
//
// Which plan a kernel needs where a pass writes and reads only so many planes.
#pragma once

#include "sk/program.hpp"

namespace sk::assemble {

/// Planes that one pass may write and read.
struct PassLimits {
  int drawBuffers;
  int textureUnits;
};

/// Whether the whole kernel is one pass.
bool fitsOnePass(const program::Kernel& kernel, const PassLimits& limits);

/// The first plan within the limits; null if there is none.
const program::Plan* planWithin(const program::Kernel& kernel, const PassLimits& limits);

}  // namespace sk::assemble
