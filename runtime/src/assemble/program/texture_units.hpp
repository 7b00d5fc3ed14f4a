// SPDX-License-Identifier: MIT
//
// Counts the texture units of programs, and selects a kernel's plan for the number of planes that a pass may write and read.
// Checks of calls, the choice of plans, and the programs themselves ask here, so that none of them allows what another one
// cannot bind.
#pragma once

#include <cstddef>
#include <vector>

#include "assemble/condition.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// The pass that writes a counted append output's list reads the two textures of its pyramid (append/histo_pyramid.hpp).
inline constexpr std::size_t pyramidUnits = 2;

/// What a program reads through texture units besides its kernel's inputs and gathers.
struct OtherUnits {
  std::size_t uniforms = 0;  ///< planes of streams that stand for uniforms
  std::size_t carried = 0;  ///< planes of accumulators of earlier elements, in scans
  std::size_t rows = 0;  ///< tables of rows
  std::size_t pyramid = 0;  ///< pyramidUnits, or 0
  std::size_t tables = 0;  ///< tables of functions

  std::size_t all() const { return uniforms + carried + rows + pyramid + tables; }
};

/// The texture units of a program: one for each plane of an input or gather that the kernel needs with these values of its Spec
/// parameters, except for planes in stacks, and one for each stack.
std::size_t textureUnits(const program::Kernel& kernel, const SpecValues& specs,
                         const OtherUnits& others = {});

/// The stacks that a kernel of a plan reads, in order.
std::vector<std::size_t> stacksOf(const program::Kernel& kernel);

/// The planes of a kernel's accumulators.
std::size_t accumulatorPlanes(const program::Kernel& kernel);

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
