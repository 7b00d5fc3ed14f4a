// SPDX-License-Identifier: MIT
//
// Builds a copy of a reduce with other accumulators, or as a kernel with outputs in their place; and variants of reduces that
// hold float sums in other accumulators.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ir/ir.hpp"
#include "support/function_ref.hpp"
#include "transforms/float_sums.hpp"
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
  ir::VarId add(std::string name, ir::ParamRole role, ir::Type type, ir::ExprPtr identity = nullptr);
  /// Makes local variables of the original outputs, and removes the original accumulators, which the body must no longer use.
  void drop(std::vector<ir::ParamRole> roles) { dropped_ = std::move(roles); }

  /// Adds the copy to the module as a reduce that `combine` combines, with the arguments that the original
  /// passes to its combining reduce; or as one that combines its own results and has no identities.
  ir::KernelId finish(ir::KernelId combine);
  ir::KernelId finishCombination();
  /// Adds the copy to the module as a reduce that combines its own results and keeps its identities.
  ir::KernelId finishFold(bool seeded);
  /// Adds the copy to the module as a native-only kernel. It has no accumulators.
  ir::KernelId finishNativeKernel();

 private:
  bool keeps(ir::VarId param) const;
  void renumber();
  ir::KernelId addToModule();
  ir::KernelId finish(ir::KernelId combine, std::size_t operands, bool seeded);

  ir::Module& module_;
  ir::Kernel kernel_;
  ir::Function entry_;
  std::vector<std::uint32_t> operands_;
  std::size_t before_;  ///< number of original parameters
  std::vector<ir::ParamRole> dropped_;
  FunctionCopies copies_;
  std::vector<ir::VarId> added_;
};

/// Appends statements that replace one that folds into a target, or returns false to keep the statement.
using RewriteFold = FunctionRef<bool(const ir::Stmt& fold, const ir::FoldTarget& target, ir::Block& to)>;

/// Replaces statements of a block of the reduce, and of the blocks in it, that fold into accumulators.
void rewriteFolds(const ir::Kernel& kernel, ir::Block& block, RewriteFold rewrite);

/// What holds the float sums of a variant of a reduce. `ofParts`: in what combines its results, whose elements are the
/// results of others.
class SumRepresentation {
 public:
  virtual ~SumRepresentation() = default;
  /// Changes parameters of the copy for its sum number `k`.
  virtual void hold(FoldCopy& copy, const FloatSum& sum, std::size_t k, bool ofParts) = 0;
  /// Appends statements that add to sum `k` what the statement `fold` adds.
  virtual void add(ir::Function& entry, const ir::Stmt& fold, std::size_t k, bool ofParts, ir::Block& to) = 0;
};

/// Adds a variant of a reduce with other representations of these sums, and what combines its results. (Exact sums are built
/// apart: one reduce combines the digits of all of them, and their statements depend on how much the digits hold.)
ir::KernelId makeSumVariant(ir::Module& module, ir::KernelId of, const std::vector<FloatSum>& sums,
                            std::string_view suffix, SumRepresentation& representation);

}  // namespace skc
