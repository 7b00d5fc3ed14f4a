// SPDX-License-Identifier: MIT
//
// Masks for CPUs without mask registers. There, a comparison gives a vector of words, all ones or all zeros,
// and selections take such vectors. LLVM's instruction selection sees one block at a time: if a vector of
// single bits comes from another block, as the mask of a loop does, it packs the bits into bytes there and
// unpacks them here, which takes longer than the arithmetic of many loops.
#pragma once

#include <llvm/IR/PassManager.h>

namespace skc::native {

/// Turns vectors of bits that are live across blocks, and what is computed from them, into vectors of words.
/// It must be the last pass, because others would turn words into bits again.
class WideMasks : public llvm::PassInfoMixin<WideMasks> {
 public:
  llvm::PreservedAnalyses run(llvm::Function& function, llvm::FunctionAnalysisManager& analyses);
};

/// Marks a function for a CPU without mask registers.
void markWideMasks(llvm::Function& function);

}  // namespace skc::native
