// SPDX-License-Identifier: MIT
//
// Tests a reduce that combines its own results on numbers: whether (a op b) op c equals a op (b op c), and
// whether the result of an empty run is neutral. The device determines how partial results combine, so a fold
// that fails either test has no single result.
#pragma once

#include <optional>
#include <string>

#include "ir/ir.hpp"

namespace skc {

struct FoldTrial {
  int tried = 0;  ///< samples that gave a result
  int failed = 0;  ///< samples that failed
  std::string example;  ///< the first failure, in words
  bool fails() const { return tried > 0 && failed == tried; }
  bool mayFail() const { return 2 * failed >= tried && failed > 0; }
};

/// Tries elements that are numbers of moderate size.
FoldTrial tryAssociativity(const ir::Module& module, const ir::Kernel& kernel);

/// Folds such elements into the identities, which the reduce must have.
struct IdentityTrial : FoldTrial {
  bool isIdempotent = false;  ///< combining any number of identities changes nothing
};
IdentityTrial tryIdentity(const ir::Module& module, const ir::Kernel& kernel);

/// True if a result depends on uniform or spec parameters other than by choosing one of the two values.
bool computesWithOthers(const ir::Module& module, const ir::Kernel& kernel);

}  // namespace skc
