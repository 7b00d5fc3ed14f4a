// SPDX-License-Identifier: MIT
//
// Tries a fold on numbers at compile time: whether folding all elements one after the other equals folding
// blocks of them and combining the results, and whether the value that a block starts from is neutral. The device
// chooses the blocks, so a fold that fails has no single result.
//
// Elements are few and small: integers, and floats of which sums and products are exact. An author may know more
// about elements than their types say (they are positive, sorted, flags, of length 1), so a fold fails only if it
// fails for numbers of every kind (see Kind in fold_trial.cpp). One that fails for some kinds may fail.
#pragma once

#include <string>

#include "ir/ir.hpp"

namespace skc {

struct FoldTrial {
  bool runs = false;  ///< at least one try gave a result
  bool failsOnce = false;  ///< it fails for some numbers
  bool fails = false;  ///< it fails for numbers of every kind
  bool mayFail = false;  ///< it fails for some numbers that most programs have
  std::string example = {};  ///< a failure, in words
};

/// Tries whether a fold that combines its own results is associative: (a op b) op c equals a op (b op c).
FoldTrial tryAssociativity(const ir::Module& module, ir::KernelId id);

/// Tries whether the results of blocks combine to the result of all elements.
FoldTrial tryCombination(const ir::Module& module, ir::KernelId id);

/// Tries whether combining a result with the identities changes it.
FoldTrial tryStart(const ir::Module& module, ir::KernelId id);

/// Tries whether an element that is folded into the identities stays what it is, for a fold that combines its own
/// results.
struct IdentityTrial : FoldTrial {
  bool isIdempotent = false;  ///< combining any number of identities changes nothing
};
IdentityTrial tryIdentity(const ir::Module& module, ir::KernelId id);

/// True if a result depends on uniform or spec parameters other than by choosing one of the two values.
bool computesWithOthers(const ir::Module& module, ir::KernelId id);

}  // namespace skc
