// SPDX-License-Identifier: MIT
//
// Builds synthesized kernels: those that combine or finish a reduce. C++ code never calls them, and messages
// name the kernel that they serve.
#pragma once

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

}  // namespace skc
