// SPDX-License-Identifier: MIT
//
// How many elements a kernel computes together.
#pragma once

#include <cstdint>

#include "ir/ir.hpp"
#include "native/target.hpp"

namespace skc::native {

/// Lanes that fill the CPU's vectors; several vectors of each where the kernel waits for results in loops and has
/// registers to spare, or folds in any order. One where loops of different trip counts do little but gather elements.
std::uint32_t laneCount(const ir::Module& module, const ir::Kernel& kernel, sk::native::EntryKind kind,
                        sk::native::Real real, const CpuLevel& level);

}  // namespace skc::native
