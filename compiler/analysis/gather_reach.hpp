// SPDX-License-Identifier: MIT
//
// Finds how far from the index of the element that it computes a kernel reads each gather:
//
//   int2 p = indexof(r).xy;
//   for (int k = -radius; k <= radius; ++k) r += u[p + int2(k, 0)];   // x: from radius before to radius after; y: 0
//
// Follows every path through the kernel and the functions that it calls, each call on its own, with the ranges of all
// integers (index_range.hpp); loops run to a fixed point, with widening.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/ir.hpp"

namespace skc::analysis {

/// How a kernel reads a parameter: see ir::KernelParam::reach and reachShapes.
struct GatherReach {
  std::vector<ir::Reach> reach;
  std::uint64_t shapes = 0;
};

/// One for each parameter; it is empty for those that are not gathers. The module must have passed
/// specialize-gathers.
std::vector<GatherReach> gatherReach(const ir::Module& module, const ir::Kernel& kernel);

}  // namespace skc::analysis
