// SPDX-License-Identifier: MIT
//
// LLVM's passes over a module of kernels (-O2). They are vectors already: nothing looks for loops to vectorise.
#pragma once

#include <llvm/IR/Module.h>
#include <llvm/Target/TargetMachine.h>

namespace skc::native {

void optimize(llvm::Module& module, llvm::TargetMachine& machine);

}  // namespace skc::native
