// SPDX-License-Identifier: MIT
//
// Tries a reduce that combines partial results by itself on numbers: whether (a op b) op c is a op (b op c), and whether
// what an empty run gives is neutral. Partial results combine in a way that depends on the device, so that a fold for
// which either fails has no one result.
#pragma once

#include <optional>
#include <string>

#include "ir/ir.hpp"

namespace skc {

struct FoldTrial {
  int tried = 0;  ///< samples that have a result
  int failed = 0;  ///< of these
  std::string example;  ///< the first failure, in words
  bool fails() const { return tried > 0 && failed == tried; }
  bool mayFail() const { return 2 * failed >= tried && failed > 0; }
};

/// On elements that are numbers of moderate size.
FoldTrial tryAssociativity(const ir::Module& module, const ir::Kernel& kernel);

/// Folds such elements into the identities, which are given.
struct IdentityTrial : FoldTrial {
  bool isIdempotent = false;  ///< combining identities changes nothing, however many there are
};
IdentityTrial tryIdentity(const ir::Module& module, const ir::Kernel& kernel);

/// Whether what it computes, beside choosing one of the two values, depends on its uniform and specialisation parameters.
bool computesWithOthers(const ir::Module& module, const ir::Kernel& kernel);

}  // namespace skc
