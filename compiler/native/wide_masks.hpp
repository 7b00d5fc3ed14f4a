// SPDX-License-Identifier: MIT
//
// Masks for CPUs without registers for them. There a comparison gives a vector of words, all ones or all zeros, and what selects by a mask
// wants such words. LLVM's instruction selection sees one block at a time: a vector of single bits that comes from another block, as the
// mask of a loop does, it packs to bytes there and unpacks here, which takes longer than many a loop's arithmetic.
#pragma once

#include <llvm/IR/PassManager.h>

namespace skc::native {

/// Vectors of bits that live from block to block, and what is computed of them, become vectors of words. It is the last pass: others would
/// take words for bits again.
class WideMasks : public llvm::PassInfoMixin<WideMasks> {
 public:
  llvm::PreservedAnalyses run(llvm::Function& function, llvm::FunctionAnalysisManager& analyses);
};

/// The function is for a CPU without registers for masks.
void markWideMasks(llvm::Function& function);

}  // namespace skc::native
