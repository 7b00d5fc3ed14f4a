// SPDX-License-Identifier: MIT
//
// Runs LLVM's passes on a module of kernels. Their code consists of vectors already: no pass looks for loops
// to vectorise.
#pragma once

#include <llvm/IR/Module.h>
#include <llvm/Target/TargetMachine.h>

namespace skc::native {

void optimize(llvm::Module& module, llvm::TargetMachine& machine);

}  // namespace skc::native
