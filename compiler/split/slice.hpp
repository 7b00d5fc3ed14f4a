// SPDX-License-Identifier: MIT
//
// Program slicing (Weiser 1981) on structured statements: the part of a kernel's entry that computes some of
// its variables. The slice for q of
//
//   float s = f(x), t = g(x);
//   for (int i = 0; i < 4; ++i) { s += a[i]; t *= b[i]; }
//   r = s; q = t;
//
// is `float t = g(x); for (...) { t *= b[i]; } q = t;`. A variable may be loaded instead of
// computed; statements that only it needed then drop out. The slicer tracks whole variables, not components,
// and keeps a statement when in doubt. Demand says which of the kernel's streams a slice needs.
#pragma once

#include <cstddef>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "ir/ir.hpp"

namespace skc::split {

/// A set of a function's variables, indexed by VarId.
using VarSet = std::vector<bool>;

struct Slice {
  std::unordered_set<const ir::Stmt*> kept;   ///< statements; one inside another is listed by itself
  VarSet used;                                ///< variables that kept statements use, also loaded ones
  VarSet loaded;                              ///< offered variables that it reads, not computes
};

class Slicer {
 public:
  Slicer(const ir::Module& module, const ir::Function& function);

  /// The statements that compute the final values of `wanted`. `loadable` variables, whose final values are
  /// available, are loaded unless the slice reads them before they are final.
  Slice slice(const VarSet& wanted, VarSet loadable) const;

  /// Index of the last statement of the body that writes a variable, which is final after it.
  std::size_t lastWrite(ir::VarId var) const { return lastWrites_[var]; }

  /// Copies the kept statements of the body.
  ir::Block copy(const Slice& slice) const;

 private:
  const ir::Module& module_;
  const ir::Function& function_;
  std::vector<std::size_t> lastWrites_;
};

/// The location of the first value in the slice that uses the variable, without those that are assigned to it.
std::optional<Loc> firstRead(ir::VarId var, const Slice& slice);

/// Computes which parameters of a kernel a slice needs, and how many planes these have.
class Demand {
 public:
  /// The kernel must have passed specialize-gathers, so that its functions name its parameters.
  Demand(const ir::Module& module, const ir::Kernel& kernel);

  /// Every parameter except outputs that the slice uses as a value or as a stream.
  VarSet params(const Slice& slice) const;

 private:
  void collect(const ir::Stmt& stmt, VarSet& params) const;
  void collect(const ir::Expr& expr, VarSet& params) const;

  const ir::Module& module_;
  const ir::Kernel& kernel_;
  std::unordered_map<ir::FunctionId, VarSet> functions_;  ///< streams that a call of the function reads
  std::unordered_map<const ir::Stmt*, std::vector<ir::VarId>>
      streams_;  ///< what statements of the entry read; without those that read none
};

/// The planes that a kernel writes and reads as a single pass.
ir::Limits demandOf(const ir::Module& module, const ir::Kernel& kernel);

/// True if a parameter is bound to texture units.
bool isRead(const ir::KernelParam& param);

}  // namespace skc::split
