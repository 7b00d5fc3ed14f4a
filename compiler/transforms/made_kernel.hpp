// SPDX-License-Identifier: MIT
//
// Kernels that a transform makes for another one: what combines or finishes a reduce. Calls of C++ never reach them, and
// messages name the kernel that they serve.
#pragma once

#include <string>
#include <string_view>

#include "ir/ir.hpp"

namespace skc {

/// A parameter with this name, role and type.
ir::KernelParam makeParam(std::string name, ir::ParamRole role, ir::Type type, Loc loc = {});

/// What a kernel made for `of` has of it: its name, scope and place. It has no entry, parameters or reduction yet.
ir::Kernel madeFor(const ir::Kernel& of);

/// A kernel in the making, whose entry has a variable for each parameter. Locals of the entry come after all
/// parameters.
struct MadeKernel {
  ir::Kernel kernel;
  ir::Function entry;

  /// One for `of`, whose entry is called as that with the suffix.
  MadeKernel(const ir::Kernel& of, std::string_view suffix);
  /// One for several.
  explicit MadeKernel(const std::string& name);

  /// An Input, an Output or an Accumulator: the variable that stands for it.
  ir::VarId add(ir::KernelParam param);

  /// Puts it into the module.
  ir::KernelId finish(ir::Module& module);
  /// The same, as a reduce that combines by itself.
  ir::KernelId finishCombination(ir::Module& module);
};

}  // namespace skc
