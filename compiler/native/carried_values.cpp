// SPDX-License-Identifier: MIT
#include "native/llvm_passes.hpp"

#include <llvm/ADT/STLExtras.h>
#include <llvm/ADT/SmallVector.h>
#include <llvm/Analysis/InstructionSimplify.h>
#include <llvm/Analysis/LoopInfo.h>
#include <llvm/Analysis/ValueTracking.h>
#include <llvm/IR/Dominators.h>
#include <llvm/IR/Instructions.h>
#include <llvm/IR/Operator.h>

namespace skc::native {

namespace {

/// Predictive commoning of one loop, which must have a preheader and a single latch.
class Commoning {
 public:
  Commoning(const llvm::Loop& loop, const llvm::DominatorTree& dominators)
      : loop_(loop), dominators_(dominators), entry_(loop.getLoopPreheader()), latch_(loop.getLoopLatch()) {}

  bool run() {
    if (entry_ == nullptr || latch_ == nullptr) return false;
    bool changed = false;
    for (llvm::Instruction& instruction : llvm::make_early_inc_range(*loop_.getHeader())) {
      if (!mayMove(instruction)) continue;
      llvm::Instruction* const next = sameOfNextIteration(instruction);
      if (next == nullptr) continue;
      replace(instruction, *next);
      changed = true;
    }
    return changed;
  }

 private:
  using Values = llvm::SmallVector<llvm::Value*, 4>;

  llvm::PHINode* asPhi(llvm::Value* value) const {
    auto* const phi = llvm::dyn_cast<llvm::PHINode>(value);
    return phi != nullptr && phi->getParent() == loop_.getHeader() ? phi : nullptr;
  }

  /// Excludes products that may be contracted: they are worth more beside the sum that they feed.
  bool mayMove(const llvm::Instruction& instruction) const {
    const auto* const real = llvm::dyn_cast<llvm::FPMathOperator>(&instruction);
    const bool mayFuse =
        real != nullptr && real->hasAllowContract() && real->getOpcode() == llvm::Instruction::FMul;
    return !mayFuse && !llvm::isa<llvm::PHINode>(instruction) && !instruction.isTerminator() &&
           !instruction.mayReadOrWriteMemory() && llvm::isSafeToSpeculativelyExecute(&instruction) &&
           llvm::any_of(instruction.operands(),
                        [&](const llvm::Use& use) { return asPhi(use) != nullptr; }) &&
           llvm::all_of(instruction.operands(), [&](const llvm::Use& use) {
             return asPhi(use) != nullptr || loop_.isLoopInvariant(use);
           });
  }

  /// The operands when control enters the header from `block`.
  Values operandsFrom(const llvm::Instruction& instruction, const llvm::BasicBlock* block) const {
    Values values;
    for (llvm::Value* const operand : instruction.operands()) {
      const llvm::PHINode* const phi = asPhi(operand);
      values.push_back(phi != nullptr ? phi->getIncomingValueForBlock(block) : operand);
    }
    return values;
  }

  /// The instruction that computes in this iteration what `instruction` computes in the next; null if none
  /// does.
  llvm::Instruction* sameOfNextIteration(const llvm::Instruction& instruction) const {
    const Values operands = operandsFrom(instruction, latch_);
    const auto* const known =
        llvm::find_if(operands, [](const llvm::Value* value) { return llvm::isa<llvm::Instruction>(value); });
    if (known == operands.end()) return nullptr;
    llvm::Instruction* const wanted = instruction.clone();
    for (auto [use, value] : llvm::zip(wanted->operands(), operands)) use.set(value);
    const auto found = llvm::find_if((*known)->users(), [&](const llvm::User* user) {
      const auto* const other = llvm::dyn_cast<llvm::Instruction>(user);
      return other != nullptr && other != wanted && loop_.contains(other) && other->isIdenticalTo(wanted) &&
             dominators_.dominates(other->getParent(), latch_);
    });
    llvm::Instruction* const same =
        found == (*known)->users().end() ? nullptr : llvm::cast<llvm::Instruction>(*found);
    wanted->deleteValue();
    return same;
  }

  void replace(llvm::Instruction& instruction, llvm::Instruction& next) const {
    llvm::Instruction* const first = instruction.clone();
    for (auto [use, value] : llvm::zip(first->operands(), operandsFrom(instruction, entry_))) use.set(value);
    first->insertBefore(entry_->getTerminator());
    auto* const phi = llvm::PHINode::Create(instruction.getType(), 2, "", loop_.getHeader()->begin());
    phi->setDebugLoc(instruction.getDebugLoc());
    phi->addIncoming(&next, latch_);
    llvm::Value* const simpler = llvm::simplifyInstruction(first, loop_.getHeader()->getDataLayout());
    phi->addIncoming(simpler != nullptr ? simpler : first, entry_);
    if (simpler != nullptr) first->eraseFromParent();
    instruction.replaceAllUsesWith(phi);
    instruction.eraseFromParent();
  }

  const llvm::Loop& loop_;
  const llvm::DominatorTree& dominators_;
  llvm::BasicBlock* entry_;
  llvm::BasicBlock* latch_;
};

}  // namespace

llvm::PreservedAnalyses CarriedValues::run(llvm::Function& function,
                                           llvm::FunctionAnalysisManager& analyses) {
  const auto& dominators = analyses.getResult<llvm::DominatorTreeAnalysis>(function);
  bool changed = false;
  for (const llvm::Loop* const loop : analyses.getResult<llvm::LoopAnalysis>(function).getLoopsInPreorder()) {
    changed = Commoning(*loop, dominators).run() || changed;
  }
  if (!changed) return llvm::PreservedAnalyses::all();
  llvm::PreservedAnalyses kept;
  kept.preserveSet<llvm::CFGAnalyses>();
  return kept;
}

}  // namespace skc::native
