// SPDX-License-Identifier: MIT
//
// Computes which parameters of a kernel a slice needs, and how many planes these have.
#pragma once

#include <unordered_map>
#include <vector>

#include "ir/ir.hpp"
#include "split/slice.hpp"

namespace skc::split {

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
  std::unordered_map<ir::FunctionId, VarSet> functions_;   ///< streams that a call of the function reads
  std::unordered_map<const ir::Stmt*, std::vector<ir::VarId>>
      streams_;   ///< what statements of the entry read; without those that read none
};

/// The planes that a kernel writes and reads as a single pass.
ir::Limits demandOf(const ir::Module& module, const ir::Kernel& kernel);

/// True if a parameter is bound to texture units.
bool isRead(const ir::KernelParam& param);

}  // namespace skc::split
