// SPDX-License-Identifier: MIT
//
// Which LLVM values are masks: vectors of single bits. Both passes over masks start from them.
#pragma once

#include <llvm/IR/DerivedTypes.h>
#include <llvm/IR/Instructions.h>

namespace skc::native {

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
