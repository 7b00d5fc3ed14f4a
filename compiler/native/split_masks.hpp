// SPDX-License-Identifier: MIT
//
// Masks for CPUs with mask registers. There, a comparison of vectors sets a mask register, and selections and
// arithmetic take one. LLVM packs the masks of lanes that need several vectors into one register, and takes it
// apart again wherever vectors are masked, which takes longer than the arithmetic of many loops.
//
//   %inside = fcmp ole <32 x float> %a, %b         %inside0 = fcmp ole <16 x float> %a0, %b0
//   %live = and <32 x i1> %before, %inside         %live0 = and <16 x i1> %before0, %inside0   ; likewise %live1
#pragma once

#include <cstdint>

#include <llvm/IR/PassManager.h>

namespace skc::native {

/// Divides masks of more lanes than a vector register has, and what is computed from masks, into one mask per
/// register. It must be one of the last passes, because others would join them again.
class SplitMasks : public llvm::PassInfoMixin<SplitMasks> {
 public:
  llvm::PreservedAnalyses run(llvm::Function& function, llvm::FunctionAnalysisManager& analyses);
};

/// Marks a function for a CPU with mask registers and vectors of `vectorBits`.
void markSplitMasks(llvm::Function& function, std::uint32_t vectorBits);

}  // namespace skc::native
