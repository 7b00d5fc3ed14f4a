// SPDX-License-Identifier: MIT
//
// Makes the kernel of one planned pass: the slice as an entry of its own, with what it loads as
// inputs and what it saves as outputs, and copies of the functions that it calls.
#pragma once

#include "ir/ir.hpp"
#include "split/plan_passes.hpp"

namespace skc::split {

/// Adds the kernel and its functions to the module. Temporaries are numbered as `plan.saved` is.
ir::Pass makePassKernel(ir::Module& module, ir::KernelId whole, const PlannedSplit& plan,
                        const PlannedPass& pass);

}  // namespace skc::split
