// SPDX-License-Identifier: MIT
//
// A reduce's fold in the making that does what another does, with other accumulators.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ir/ir.hpp"
#include "transforms/copy_functions.hpp"

namespace skc {

class FoldCopy {
 public:
  /// A copy of the kernel and of all its functions, since each belongs to one kernel. The entry's name gets the suffix.
  FoldCopy(ir::Module& module, ir::KernelId of, std::string_view suffix);

  /// Its body may be changed, and have more locals; its variables keep their numbers until finish().
  ir::Function& entry() { return entry_; }
  ir::KernelParam& param(ir::VarId var) { return kernel_.params[var]; }

  /// A new accumulator, of which nobody knows yet, after all others.
  ir::VarId addAccumulator(std::string name, ir::Type type, ir::ExprPtr identity);
  /// The accumulators that there were go; the body does not name them any more.
  void dropAccumulators();

  /// Puts it into the module, a reduce that `combine` combines.
  ir::KernelId finish(ir::KernelId combine);

 private:
  void renumber();

  ir::Module& module_;
  ir::Kernel kernel_;
  ir::Function entry_;
  std::size_t before_;  ///< parameters that there were
  bool isDropped_ = false;
  FunctionCopies copies_;
  std::vector<ir::VarId> added_;
};

}  // namespace skc
