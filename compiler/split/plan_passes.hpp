// SPDX-License-Identifier: MIT
//
// Plans the passes of a kernel under given limits: which outputs are written together, which values are saved
// for later passes and which are recomputed wherever they are needed, and which inputs share a texture. What
// each pass does is a slice (slice.hpp) of the kernel.
//
// The method follows the recursive dominator split (Chan et al., Graphics Hardware 2002), which decides value
// by value between saving and recomputing, combined with merging outputs into passes by their cost (Foley,
// Houston, Hanrahan, Graphics Hardware 2004; Riffel et al., ibid.). Those work on trees and graphs without
// control flow; this works on slices, which have it.
//
// Builds the kernel of one planned pass: the slice becomes its entry, loaded values its inputs, saved values
// its outputs, and the functions that it calls are copied.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/ir.hpp"
#include "split/slice.hpp"

namespace skc::split {

/// Something that a pass writes: planes of an output, or a temporary.
struct Target {
  ir::VarId var;  ///< a variable of the entry
  bool isOutput;
  std::uint32_t firstPlane;
  std::uint32_t planeCount;
};

struct PlannedPass {
  std::vector<Target> targets;
  Slice slice;  ///< its Slice::loaded are the temporaries that it reads
  double cost = 0;
};

struct PlannedSplit {
  std::vector<ir::VarId> saved;  ///< temporaries, in the order in which they are final
  std::vector<double> computeCosts;  ///< one per temporary
  std::vector<PlannedPass> passes;
  std::vector<ir::Stack> stacks;
  double cost = 0;
  double costWithoutTemporaries = 0;
};

/// The kernel must have passed specialize-gathers, and be neither a reduce nor a pass.
PlannedSplit planPasses(const ir::Module& module, const ir::Kernel& kernel, const ir::Limits& limits);

/// Adds the kernel and its functions to the module. Temporaries are numbered as in `plan.saved`.
ir::Pass makePassKernel(ir::Module& module, ir::KernelId whole, const PlannedSplit& plan,
                        const PlannedPass& pass);

}  // namespace skc::split
