// SPDX-License-Identifier: MIT
//
// Our own passes over LLVM IR. optimize() runs each at its place.
#pragma once

#include <cstdint>

#include <llvm/IR/DerivedTypes.h>
#include <llvm/IR/Instructions.h>
#include <llvm/IR/PassManager.h>

namespace skc::native {

// Removes computations that an iteration of a loop repeats from the iteration before. A loop in lanes tests
// at its end whether any lane continues, and the condition (x * x + y * y <= 4) often has parts with which
// the next iteration begins (x * x - y * y). LLVM's own elimination of partial redundancies skips blocks that
// are their own successors, as in these loops.

/// If the loop computes in each iteration what an instruction in its header computes in the next, replaces
/// that instruction by a phi. No value changes.
class CarriedValues : public llvm::PassInfoMixin<CarriedValues> {
 public:
  llvm::PreservedAnalyses run(llvm::Function& function, llvm::FunctionAnalysisManager& analyses);
};

// Masks for CPUs with mask registers. There, a comparison of vectors sets a mask register, and selections and
// arithmetic take one. LLVM packs the masks of lanes that need several vectors into one register, and takes it
// apart again wherever vectors are masked, which takes longer than the arithmetic of many loops.
//
//   %inside = fcmp ole <32 x float> %a, %b         %inside0 = fcmp ole <16 x float> %a0, %b0
//   %live = and <32 x i1> %before, %inside         %live0 = and <16 x i1> %before0, %inside0   ; likewise %live1

/// Divides masks of more lanes than a vector register has, and what is computed from masks, into one mask per
/// register. It must be one of the last passes, because others would join them again.
class SplitMasks : public llvm::PassInfoMixin<SplitMasks> {
 public:
  llvm::PreservedAnalyses run(llvm::Function& function, llvm::FunctionAnalysisManager& analyses);
};

/// Marks a function for a CPU with mask registers and vectors of `vectorBits`.
void markSplitMasks(llvm::Function& function, std::uint32_t vectorBits);

// Masks for CPUs without mask registers. There, a comparison gives a vector of words, all ones or all zeros,
// and selections take such vectors. LLVM's instruction selection sees one block at a time: if a vector of
// single bits comes from another block, as the mask of a loop does, it packs the bits into bytes there and
// unpacks them here, which takes longer than the arithmetic of many loops.

/// Turns vectors of bits that are live across blocks, and what is computed from them, into vectors of words.
/// It must be the last pass, because others would turn words into bits again.
class WideMasks : public llvm::PassInfoMixin<WideMasks> {
 public:
  llvm::PreservedAnalyses run(llvm::Function& function, llvm::FunctionAnalysisManager& analyses);
};

/// Marks a function for a CPU without mask registers.
void markWideMasks(llvm::Function& function);

// Which LLVM values are masks: vectors of single bits. Both passes over masks start from them.

/// The type of a mask; null for any other value.
inline llvm::FixedVectorType* maskType(const llvm::Value& value) {
  auto* const type = llvm::dyn_cast<llvm::FixedVectorType>(value.getType());
  return type != nullptr && type->getElementType()->isIntegerTy(1) ? type : nullptr;
}

/// True if an instruction that gives a mask computes it from masks.
inline bool isComputedMask(const llvm::Instruction& instruction) {
  return llvm::isa<llvm::PHINode, llvm::FreezeInst, llvm::SelectInst>(instruction) ||
         instruction.isBitwiseLogicOp();
}

}  // namespace skc::native
