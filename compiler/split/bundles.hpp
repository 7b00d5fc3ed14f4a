// SPDX-License-Identifier: MIT
//
// If a pass reads more planes than there are texture units, planes of one texel format are copied to the
// layers of one array texture, which takes one unit. This works for any control flow around the reads; no
// division of the kernel into passes does.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/ir.hpp"
#include "split/slice.hpp"

namespace skc::split {

struct PassReads {
  VarSet params;                ///< parameters of the kernel that the pass reads
  std::uint32_t temporaries;    ///< planes of temporaries that it reads as well
};

/// Chooses bundles that bring every pass within `units`, with as few planes in them as possible. Every pass
/// reads a bundled plane from its bundle.
std::vector<ir::Bundle> chooseBundles(const ir::Module& module, const ir::Kernel& kernel,
                                      const std::vector<PassReads>& passes, std::uint32_t units);

}  // namespace skc::split
