// SPDX-License-Identifier: MIT
//
// -Wperformance: says of each kernel what keeps it from full speed, and the way out. It asks for the same facts by which the
// runtime chooses (program::Parameter, assemble::mayWritePacked) and unroll-loops has decided (Kernel::loops).
#pragma once

#include <string>
#include <vector>

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc::driver {

/// Whether the options of -W, in their order, ask for these warnings.
bool wantsPerformanceWarnings(const std::vector<std::string>& warnings);

/// Reports what slows kernels down. Takes the module that runTransforms leaves.
void warnOfPerformance(const ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc::driver
