// SPDX-License-Identifier: MIT
//
// Checks what the author of a reduce promises: the fold is associative, and the initial value is its
// identity. Part of derive-combine.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {

/// Checks the identities that the author gives for known operators; returns false after an error.
bool checkIdentities(const ir::Module& module, const ir::Kernel& kernel, const FoldPattern& pattern,
                     Diagnostics& diagnostics);

/// Tries a fold without a known operator that combines its own results on numbers; false after an error.
bool checkByTrial(const ir::Module& module, const ir::Kernel& kernel, Diagnostics& diagnostics);

}  // namespace skc
