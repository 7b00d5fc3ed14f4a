// SPDX-License-Identifier: MIT
//
// Checks what the author of a reduce promises: the fold is associative, the initial value is its identity, and an
// overload combines results as the fold would. Part of derive-combine.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

/// Checks the identities that the author gives for the operators of the reduce's pattern; returns false after an error.
bool checkIdentities(const ir::Module& module, const ir::Kernel& kernel, Diagnostics& diagnostics);

/// Tries a fold without a known operator that combines its own results on numbers; false after an error. Of one that
/// combines the results of others (`combinesOthers`), only the identity is tried: its elements are no arbitrary values.
bool checkOwnCombination(const ir::Module& module, ir::KernelId id, bool combinesOthers,
                         Diagnostics& diagnostics);

/// Tries on numbers whether results of a fold combine to the result of all elements, whatever combines them. Returns
/// true if it could be tried.
bool checkCombination(const ir::Module& module, ir::KernelId id, Diagnostics& diagnostics);

}  // namespace skc
