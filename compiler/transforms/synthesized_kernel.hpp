// SPDX-License-Identifier: MIT
//
// Builds synthesized kernels: variants of a kernel, and those that combine or finish a reduce. C++ code never calls them,
// and messages name the kernel that they serve.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "ir/ir.hpp"
#include "support/function_ref.hpp"

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

}  // namespace skc
