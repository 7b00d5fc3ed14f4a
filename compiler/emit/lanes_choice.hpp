// SPDX-License-Identifier: MIT
//
// Which kernels native code computes by lanes (native_lanes.hpp).
#pragma once

#include "emit/divergence.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

/// Whether a kernel can be computed by lanes: it neither pushes nor scatters, and what differs is numbers and their vectors.
bool hasLanesForm(const ir::Module& module, const ir::Kernel& kernel, const Divergence& divergence);

/// Whether it gains by that: compilers do not vectorise its loop around elements themselves, since it loops as elements
/// decide or gathers at indices that it computes; and it computes enough for what it reads from all over memory, which
/// lanes do one after the other.
bool gainsByLanes(const ir::Module& module, const ir::Kernel& kernel, const Divergence& divergence);

}  // namespace skc::emit
