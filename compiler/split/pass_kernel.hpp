// SPDX-License-Identifier: MIT
//
// Builds the kernel of one planned pass: the slice becomes its entry, loaded values its inputs, saved values
// its outputs, and the functions that it calls are copied.
#pragma once

#include "ir/ir.hpp"
#include "split/plan_passes.hpp"

namespace skc::split {

/// Adds the kernel and its functions to the module. Temporaries are numbered as in `plan.saved`.
ir::Pass makePassKernel(ir::Module& module, ir::KernelId whole, const PlannedSplit& plan,
                        const PlannedPass& pass);

}  // namespace skc::split
