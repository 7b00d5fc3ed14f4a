// SPDX-License-Identifier: MIT
//
// Builds a copy of a reduce with other accumulators, or as a kernel with outputs in their place.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ir/ir.hpp"
#include "transforms/synthesized_kernel.hpp"

namespace skc {

class FoldCopy {
 public:
  /// Copies the kernel and all its functions, since each belongs to one kernel; the entry's name gets
  /// the suffix.
  FoldCopy(ir::Module& module, ir::KernelId of, std::string_view suffix);

  /// The body may be changed and get more locals; variables keep their ids until finish().
  ir::Function& entry() { return entry_; }
  ir::KernelParam& param(ir::VarId var) { return kernel_.params[var]; }

  /// Adds an input, output or accumulator after all other parameters; nothing uses it yet.
  ir::VarId addInput(std::string name, ir::Type type);
  ir::VarId addOutput(std::string name, ir::Type type);
  ir::VarId addAccumulator(std::string name, ir::Type type, ir::ExprPtr identity = nullptr);
  /// Removes the original accumulators; the body must no longer use them.
  void dropAccumulators();
  /// Makes local variables of the outputs.
  void dropOutputs();

  /// Adds the copy to the module as a reduce that `combine` combines, with the arguments that the original
  /// passes to its combining reduce; or as one that combines its own results and has no identities.
  ir::KernelId finish(ir::KernelId combine);
  ir::KernelId finishCombination();
  /// Adds the copy to the module as a reduce that combines its own results and keeps its identities.
  ir::KernelId finishFold(bool seeded);
  /// Adds the copy to the module as a native-only kernel. It has no accumulators.
  ir::KernelId finishNativeKernel();

 private:
  ir::VarId add(ir::KernelParam param);
  bool keeps(ir::VarId param) const;
  void renumber();
  ir::KernelId addToModule();
  ir::KernelId finish(ir::KernelId combine, std::size_t operands, bool seeded);

  ir::Module& module_;
  ir::Kernel kernel_;
  ir::Function entry_;
  std::vector<std::uint32_t> operands_;
  std::size_t before_;  ///< number of original parameters
  bool isDropped_ = false;
  bool dropsOutputs_ = false;
  FunctionCopies copies_;
  std::vector<ir::VarId> added_;
};

}  // namespace skc
