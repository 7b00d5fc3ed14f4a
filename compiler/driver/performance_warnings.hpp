// SPDX-License-Identifier: MIT
//
// -Wperformance: reports what slows each kernel down, and how to avoid it. The warnings use the same facts as
// the runtime's choices (program::Parameter, assemble::mayWritePacked) and as unroll-loops.
#pragma once

#include <string>
#include <vector>

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc::driver {

/// True if the options of -W, in order, enable these warnings.
bool wantsPerformanceWarnings(const std::vector<std::string>& warnings);

/// Reports what slows kernels down. Takes the output of runTransforms.
void warnOfPerformance(const ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc::driver
