// SPDX-License-Identifier: MIT
//
// Checks what a reduce's author promises: that the fold is associative, and that what a run starts from is neutral. Part
// of derive-combine.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {

/// The identities that the author gives to a fold by known operators; false where one is an error.
bool checkIdentities(const ir::Module& module, const ir::Kernel& kernel, const FoldPattern& pattern,
                     Diagnostics& diagnostics);

/// A fold by no known operator that combines partial results by itself, tried on numbers; false after an error.
bool checkByTrial(const ir::Module& module, const ir::Kernel& kernel, Diagnostics& diagnostics);

}  // namespace skc
