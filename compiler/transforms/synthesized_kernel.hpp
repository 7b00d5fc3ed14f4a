// SPDX-License-Identifier: MIT
//
// Builds synthesized kernels: those that combine or finish a reduce. C++ code never calls them, and messages
// name the kernel that they serve. Copies functions for variants of kernels.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "ir/ir.hpp"

namespace skc {

/// Creates a parameter.
ir::KernelParam makeParam(std::string name, ir::ParamRole role, ir::Type type, Loc loc = {});

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

  /// Adds the kernel to the module.
  ir::KernelId finish(ir::Module& module);
  /// Adds it to the module as a reduce that combines its own results.
  ir::KernelId finishCombination(ir::Module& module);
};

// Copies functions for further variants of a kernel: after specialize-gathers each function belongs to one
// kernel, so each variant needs its own.

/// Maps the functions copied for one variant to their copies.
using FunctionCopies = std::map<ir::FunctionId, ir::FunctionId>;

/// Copies a function after the functions that it calls.
ir::FunctionId copyFunction(ir::Module& module, ir::FunctionId id, FunctionCopies& copies);

/// Removes the tables of copied functions, for variants whose precision differs from the tables'.
void dropTables(ir::Module& module, const FunctionCopies& copies);

}  // namespace skc
