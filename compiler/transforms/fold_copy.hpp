// SPDX-License-Identifier: MIT
//
// A reduce in the making that does what another does, with other accumulators, or a kernel with outputs in their place.
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

  /// A new input, output or accumulator, of which nobody knows yet, after all other parameters.
  ir::VarId addInput(std::string name, ir::Type type);
  ir::VarId addOutput(std::string name, ir::Type type);
  ir::VarId addAccumulator(std::string name, ir::Type type, ir::ExprPtr identity = nullptr);
  /// The accumulators that there were go; the body does not name them any more.
  void dropAccumulators();

  /// Puts it into the module, a reduce that `combine` combines, which gets the arguments that the copied reduce gives to
  /// what combines that; or one that combines by itself and has no identities.
  ir::KernelId finish(ir::KernelId combine);
  ir::KernelId finishCombination();
  /// The same, as a kernel that runs natively alone. It has no accumulators.
  ir::KernelId finishNativeKernel();

 private:
  ir::VarId add(ir::KernelParam param);
  void renumber();
  ir::KernelId addToModule();
  ir::KernelId finish(ir::KernelId combine, std::size_t operands, bool seeded);

  ir::Module& module_;
  ir::Kernel kernel_;
  ir::Function entry_;
  std::vector<std::uint32_t> operands_;
  std::size_t before_;  ///< parameters that there were
  bool isDropped_ = false;
  FunctionCopies copies_;
  std::vector<ir::VarId> added_;
};

}  // namespace skc
