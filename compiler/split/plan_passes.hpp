// SPDX-License-Identifier: MIT
//
// Which passes a kernel takes under given limits: which outputs are written together, which values
// are saved for later passes and which are computed again wherever they are needed, and which
// inputs share a texture. What each pass does is a slice (slice.hpp) of the kernel.
//
// The method is in the spirit of the recursive dominator split (Chan et al., Graphics Hardware 2002), which
// decides value by value between saving and computing again, with the merging of several outputs
// into a pass by their cost (Foley, Houston, Hanrahan, Graphics Hardware 2004; Riffel et al., ibid.):
// those work on trees and graphs without control flow, this on slices, which have it.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/ir.hpp"
#include "split/slice.hpp"

namespace skc::split {

/// What a pass writes: planes of an output, or a temporary.
struct Target {
  ir::VarId var;                 ///< of the entry
  bool isOutput;
  std::uint32_t firstPlane;
  std::uint32_t planeCount;
};

struct PlannedPass {
  std::vector<Target> targets;
  Slice slice;                   ///< Slice::loaded are temporaries
  double cost = 0;
};

struct PlannedSplit {
  std::vector<ir::VarId> saved;          ///< the temporaries, in the order in which they are final
  std::vector<double> computeCosts;      ///< one a temporary
  std::vector<PlannedPass> passes;
  std::vector<ir::Bundle> bundles;
  double cost = 0;
  double costWithoutTemporaries = 0;
};

/// The kernel is after specialize-gathers, and neither a reduce nor a pass.
PlannedSplit planPasses(const ir::Module& module, const ir::Kernel& kernel, const ir::Limits& limits);

}  // namespace skc::split
