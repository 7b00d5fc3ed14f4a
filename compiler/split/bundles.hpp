// SPDX-License-Identifier: MIT
//
// Where a pass reads more planes than there are texture units, planes of one texel format are copied
// to the layers of one array texture, which takes one unit. That works for any control flow around
// the reads, which no division of the kernel into passes does.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/ir.hpp"
#include "split/slice.hpp"

namespace skc::split {

struct PassReads {
  VarSet params;                ///< parameters of the kernel that the pass needs
  std::uint32_t temporaries;    ///< planes that it reads beside them
};

/// The bundles that bring every pass within `units`, with as few planes in them as will do. A plane in
/// a bundle is read from there by every pass.
std::vector<ir::Bundle> chooseBundles(const ir::Module& module, const ir::Kernel& kernel,
                                      const std::vector<PassReads>& passes, std::uint32_t units);

}  // namespace skc::split
