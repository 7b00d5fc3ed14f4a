// SPDX-License-Identifier: MIT
//
// Which parameters of a kernel a slice needs, and how many planes that is.
#pragma once

#include <vector>

#include "ir/ir.hpp"
#include "split/slice.hpp"

namespace skc::split {

class Demand {
 public:
  /// The kernel is after specialize-gathers: its functions name its parameters.
  Demand(const ir::Module& module, const ir::Kernel& kernel);

  /// Every parameter that the slice mentions as a value or as a stream, but for outputs.
  VarSet params(const Slice& slice) const;

 private:
  void collect(const ir::Stmt& stmt, VarSet& params) const;
  void collect(const ir::Expr& expr, VarSet& params) const;

  const ir::Module& module_;
  const ir::Kernel& kernel_;
  std::vector<VarSet> functions_;   ///< streams that a call of the function reads; empty until known
};

/// Planes that a kernel writes and reads when it runs as one pass.
ir::Limits demandOf(const ir::Module& module, const ir::Kernel& kernel);

/// Whether a parameter is bound to texture units.
bool isRead(const ir::KernelParam& param);

}  // namespace skc::split
