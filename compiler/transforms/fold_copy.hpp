// SPDX-License-Identifier: MIT
//
// Builds a copy of a reduce with other accumulators, or as a kernel with outputs in their place; and variants of reduces that
// hold float sums in other accumulators.
//
// Builds synthesized kernels: variants of a kernel, and those that combine or finish a reduce. C++ code never calls them,
// and messages name the kernel that they serve.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ir/ir.hpp"
#include "support/function_ref.hpp"
#include "transforms/float_sums.hpp"

namespace skc {

/// Creates a parameter.
ir::KernelParam makeParam(std::string name, ir::ParamRole role, ir::Type type, Loc loc = {});

/// The parameters of a role, in order.
std::vector<ir::VarId> paramsOf(const ir::Kernel& kernel, ir::ParamRole role);

/// A kernel with the name, scope and location of `of`. It has no entry, parameters or reduction yet.
ir::Kernel synthesizedFor(const ir::Kernel& of);

/// A kernel builder, whose entry has a variable for each parameter. Add locals after all parameters.
struct SynthesizedKernel {
  ir::Kernel kernel;
  ir::Function entry;

  /// Builds a kernel for `of`, whose entry is named after it, with the suffix.
  SynthesizedKernel(const ir::Kernel& of, std::string_view suffix);
  /// Builds a kernel that serves several.
  explicit SynthesizedKernel(const std::string& name);

  /// Adds an Input, an Output or an Accumulator; returns its variable.
  ir::VarId add(ir::KernelParam param);

  /// Adds a parameter for each of these of `of`. Their names are that of the original between `prefix` and `suffix`; they have
  /// the original's type, or the one that `typeOf` gives for it.
  std::vector<ir::VarId> addEach(const ir::Kernel& of, const std::vector<ir::VarId>& params,
                                 ir::ParamRole role, std::string_view prefix, std::string_view suffix,
                                 const std::function<ir::Type(ir::VarId)>& typeOf = {});

  /// Adds the kernel to the module.
  ir::KernelId finish(ir::Module& module);
  /// Adds it to the module as a reduce that combines its own results.
  ir::KernelId finishCombination(ir::Module& module);
};

// Copies of what a variant of a kernel changes. After specialize-gathers each function belongs to one kernel, so that each
// variant needs its own.

/// Maps the functions copied for one variant to their copies.
using FunctionCopies = std::map<ir::FunctionId, ir::FunctionId>;

/// Copies a function after the functions that it calls.
ir::FunctionId copyFunction(ir::Module& module, ir::FunctionId id, FunctionCopies& copies);

/// Removes the tables of copied functions, for variants whose precision differs from the tables'.
void dropTables(ir::Module& module, const FunctionCopies& copies);

/// A variant of a kernel with the same parameters and copies of its functions, not in the module yet. If it is a reduce,
/// nothing combines its results yet. (Precisions share no more: widen-floats changes types, round-halves keeps them and adds
/// roundings.)
ir::Kernel variantOf(ir::Module& module, ir::KernelId of, FunctionCopies& copies);

/// Maps constants to their copies for a precision.
using ConstantCopies = std::map<ir::ConstantId, ir::ConstantId>;

/// The copy of a constant for a precision, named with the suffix, which `convert` changes at its first use; the constant
/// itself if it holds no float.
ir::ConstantId copyConstant(ir::Module& module, ir::ConstantId id, ConstantCopies& copies,
                            std::string_view suffix, FunctionRef<void(ir::Constant&)> convert);

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
