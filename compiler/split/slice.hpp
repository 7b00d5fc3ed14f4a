// SPDX-License-Identifier: MIT
//
// Program slicing (Weiser 1981) on structured statements: what of a kernel's entry is needed to
// compute some of its variables. Of
//
//   float s = f(x), t = g(x);
//   for (int i = 0; i < 4; ++i) { s += a[i]; t *= b[i]; }
//   r = s; q = t;
//
// the slice for q is `float t = g(x); for (...) { t *= b[i]; } q = t;`. Variables may be given
// instead of computed ("loaded"); what only they needed is then no part of the slice. It asks which
// variables a statement writes, not which of their components, and errs on the side of keeping.
#pragma once

#include <cstddef>
#include <unordered_set>
#include <vector>

#include "ir/ir.hpp"

namespace skc::split {

/// A set of variables of one function, by VarId.
using VarSet = std::vector<bool>;

struct Slice {
  std::unordered_set<const ir::Stmt*> kept;   ///< statements, those inside others apart from these
  VarSet used;                                ///< variables that it mentions, loaded ones among them
  VarSet loaded;                              ///< of those that were offered, the ones that it reads
};

class Slicer {
 public:
  Slicer(const ir::Module& module, const ir::Function& function);

  /// What computes the final values of `wanted`. Of `loadable`, whose final values are at hand, those
  /// are loaded that the slice reads nowhere before they are final.
  Slice slice(const VarSet& wanted, VarSet loadable) const;

  /// Number of the last statement of the body that writes a variable: it is final after that.
  std::size_t lastWrite(ir::VarId var) const { return lastWrites_[var]; }

  /// The statements of the body that are kept, as a body of their own.
  ir::Block copy(const Slice& slice) const;

 private:
  const ir::Module& module_;
  const ir::Function& function_;
  std::vector<std::size_t> lastWrites_;
};

}  // namespace skc::split
