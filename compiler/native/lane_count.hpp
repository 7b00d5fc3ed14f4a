// SPDX-License-Identifier: MIT
//
// Chooses how many elements a kernel computes together.
#pragma once

#include <cstdint>

#include "ir/ir.hpp"
#include "native/target.hpp"

namespace skc::native {

/// As many lanes as fill a vector of the CPU; several vectors if the kernel waits for results in loops and
/// has registers to spare, or folds in any order. One lane if loops with different trip counts do little but
/// gather.
std::uint32_t laneCount(const ir::Module& module, const ir::Kernel& kernel, sk::native::EntryKind kind,
                        sk::native::Real real, const CpuLevel& level);

}  // namespace skc::native
