// SPDX-License-Identifier: MIT
//
// Removes computations that an iteration of a loop repeats from the iteration before. A loop in lanes tests
// at its end whether any lane continues, and the condition (x * x + y * y <= 4) often has parts with which
// the next iteration begins (x * x - y * y). LLVM's own elimination of partial redundancies skips blocks that
// are their own successors, as in these loops.
#pragma once

#include <llvm/IR/PassManager.h>

namespace skc::native {

/// If the loop computes in each iteration what an instruction in its header computes in the next, replaces
/// that instruction by a phi. No value changes.
class CarriedValues : public llvm::PassInfoMixin<CarriedValues> {
 public:
  llvm::PreservedAnalyses run(llvm::Function& function, llvm::FunctionAnalysisManager& analyses);
};

}  // namespace skc::native
