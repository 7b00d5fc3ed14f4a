// SPDX-License-Identifier: MIT
//
// What an iteration of a loop computes and the next one computes again. A loop in lanes asks at its end whether lanes go on, and what it
// asks (x * x + y * y <= 4) often has parts that the next iteration begins with (x * x - y * y). LLVM's own elimination of partial
// redundancies leaves out blocks that follow themselves, which these loops are.
#pragma once

#include <llvm/IR/PassManager.h>

namespace skc::native {

/// An instruction at the head of a loop whose operands for the next iteration are at hand in this one, beside the instruction itself,
/// becomes a value that goes around the loop. The values stay the same.
class CarriedValues : public llvm::PassInfoMixin<CarriedValues> {
 public:
  llvm::PreservedAnalyses run(llvm::Function& function, llvm::FunctionAnalysisManager& analyses);
};

}  // namespace skc::native
