// SPDX-License-Identifier: MIT
#include "native/llvm_passes.hpp"

#include <llvm/ADT/DenseMap.h>
#include <llvm/ADT/STLExtras.h>
#include <llvm/ADT/SetVector.h>
#include <llvm/IR/Constants.h>
#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/InstIterator.h>
#include <llvm/IR/Instructions.h>
#include <llvm/IR/PatternMatch.h>


namespace skc::native {

namespace {

constexpr char wideMasksAttribute[] = "sk-wide-masks";

bool isUsedElsewhere(const llvm::Instruction& mask) {
  return llvm::any_of(mask.users(), [&](const llvm::User* user) {
    return llvm::cast<llvm::Instruction>(user)->getParent() != mask.getParent();
  });
}

class MaskWidener {
 public:
  explicit MaskWidener(llvm::Function& function) : b_(function.getContext()) {
    unsigned narrowest = 64;
    bool anyLivesOn = false;
    for (llvm::Instruction& instruction : llvm::instructions(function)) {
      if (maskType(instruction) == nullptr) continue;
      if (isComputedMask(instruction)) {
        computed_.insert(&instruction);
      } else {
        sources_.push_back(&instruction);
      }
      anyLivesOn = anyLivesOn || llvm::isa<llvm::PHINode>(instruction) || isUsedElsewhere(instruction);
      if (llvm::isa<llvm::CmpInst>(instruction)) {
        narrowest = std::min(narrowest, instruction.getOperand(0)->getType()->getScalarSizeInBits());
      }
    }
    word_ = b_.getIntNTy(narrowest == 64 ? 64 : 32);
    if (!anyLivesOn) computed_.clear(), sources_.clear();
  }

  bool widen() {
    if (computed_.empty() && sources_.empty()) return false;
    for (llvm::Instruction* const mask : computed_) {
      auto* const phi = llvm::dyn_cast<llvm::PHINode>(mask);
      if (phi == nullptr) continue;
      auto* const wide =
          llvm::PHINode::Create(wordsOf(*phi), phi->getNumIncomingValues(), "", phi->getIterator());
      wide->setDebugLoc(phi->getDebugLoc());
      words_[phi] = wide;
    }
    for (llvm::Instruction* const mask : computed_) {
      auto* const phi = llvm::dyn_cast<llvm::PHINode>(mask);
      if (phi == nullptr) continue;
      for (unsigned i = 0; i < phi->getNumIncomingValues(); ++i) {
        llvm::cast<llvm::PHINode>(words_[phi])
            ->addIncoming(words(phi->getIncomingValue(i)), phi->getIncomingBlock(i));
      }
    }
    for (llvm::Instruction* const mask : computed_) replaceUses(*mask, /*everywhere=*/true);
    for (llvm::Instruction* const mask : sources_) replaceUses(*mask, /*everywhere=*/false);
    for (llvm::Instruction* const mask : computed_) mask->dropAllReferences();
    for (llvm::Instruction* const mask : computed_) mask->eraseFromParent();
    return true;
  }

 private:
  llvm::Type* wordsOf(const llvm::Value& mask) const {
    return llvm::FixedVectorType::get(word_, maskType(mask)->getNumElements());
  }

  /// The mask in words: all ones or all zeros.
  llvm::Value* words(llvm::Value* mask) {
    if (auto* const constant = llvm::dyn_cast<llvm::Constant>(mask))
      return b_.CreateSExt(constant, wordsOf(*mask));
    const auto known = words_.find(mask);
    if (known != words_.end()) return known->second;
    llvm::Value* const wide = make(mask);
    words_[mask] = wide;
    return wide;
  }

  llvm::Value* make(llvm::Value* mask) {
    auto* const instruction = llvm::dyn_cast<llvm::Instruction>(mask);
    if (instruction == nullptr) {
      llvm::BasicBlock& entry = llvm::cast<llvm::Argument>(mask)->getParent()->getEntryBlock();
      b_.SetInsertPoint(&entry, entry.getFirstInsertionPt());
      return b_.CreateSExt(mask, wordsOf(*mask));
    }
    if (!computed_.contains(instruction)) {
      b_.SetInsertPoint(*instruction->getInsertionPointAfterDef());
      b_.SetCurrentDebugLocation(instruction->getDebugLoc());
      return b_.CreateSExt(mask, wordsOf(*mask));
    }
    llvm::SmallVector<llvm::Value*, 3> operands;
    for (llvm::Value* const operand : instruction->operands()) {
      operands.push_back(maskType(*operand) != nullptr ? words(operand) : operand);
    }
    b_.SetInsertPoint(instruction);
    if (auto* const logic = llvm::dyn_cast<llvm::BinaryOperator>(instruction)) {
      return b_.CreateBinOp(logic->getOpcode(), operands[0], operands[1]);
    }
    if (llvm::isa<llvm::FreezeInst>(instruction)) return b_.CreateFreeze(operands[0]);
    using namespace llvm::PatternMatch;
    if (maskType(*instruction->getOperand(0)) == nullptr)
      return b_.CreateSelect(operands[0], operands[1], operands[2]);
    if (match(instruction->getOperand(2), m_Zero()))
      return b_.CreateAnd(operands[0], b_.CreateFreeze(operands[1]));
    if (match(instruction->getOperand(1), m_AllOnes()))
      return b_.CreateOr(operands[0], b_.CreateFreeze(operands[2]));
    return b_.CreateSelect(bits(operands[0]), operands[1], operands[2]);
  }

  llvm::Value* bits(llvm::Value* words) {
    return b_.CreateICmpSLT(words, llvm::Constant::getNullValue(words->getType()));
  }

  /// Makes users that are not computed in words take the mask from the words. `everywhere` is false for masks
  /// of comparisons, whose users in the same block stay, but for tests of masks that have words anyway.
  void replaceUses(llvm::Instruction& mask, bool everywhere) {
    llvm::SmallSetVector<llvm::Instruction*, 8> users;
    const bool hasWords = words_.contains(&mask) || isUsedElsewhere(mask);
    for (llvm::User* const user : mask.users()) {
      auto* const instruction = llvm::cast<llvm::Instruction>(user);
      const bool takesWords =
          everywhere || instruction->getParent() != mask.getParent() || (hasWords && isAnyTest(*instruction));
      if (!computed_.contains(instruction) && takesWords) users.insert(instruction);
    }
    users.remove_if([&](llvm::Instruction* user) { return words_.contains(&mask) && words_[&mask] == user; });
    for (llvm::Instruction* const user : users) {
      llvm::Value* const wide = words(&mask);
      b_.SetInsertPoint(user);
      b_.SetCurrentDebugLocation(user->getDebugLoc());
      if (replaceAnyTest(*user, wide) || replaceConversion(*user, wide)) continue;
      user->replaceUsesOfWith(&mask, bits(wide));
    }
  }

  /// True if `user` tests whether any bit is set.
  static bool isAnyTest(const llvm::Instruction& user) {
    using namespace llvm::PatternMatch;
    return llvm::isa<llvm::BitCastInst>(user) && user.getType()->isIntegerTy() &&
           llvm::all_of(user.users(), [](const llvm::User* comparison) {
             const auto* const test = llvm::dyn_cast<llvm::ICmpInst>(comparison);
             return test != nullptr && test->isEquality() && match(test->getOperand(1), m_Zero());
           });
  }

  /// Turns a test whether any bit is set into a test of the words; false if `user` is no such test.
  bool replaceAnyTest(llvm::Instruction& user, llvm::Value* wide) {
    if (!isAnyTest(user)) return false;
    llvm::Value* const any = b_.CreateOrReduce(wide);
    for (llvm::User* const comparison : llvm::make_early_inc_range(user.users())) {
      auto* const test = llvm::cast<llvm::ICmpInst>(comparison);
      b_.SetInsertPoint(test);
      test->replaceAllUsesWith(b_.CreateICmp(test->getPredicate(), any, llvm::ConstantInt::get(word_, 0)));
      test->eraseFromParent();
    }
    user.eraseFromParent();
    return true;
  }

  /// Turns a conversion of a mask to numbers into the words, which are -1 where the mask is true: adding 1
  /// becomes subtracting them. False if `user` is no such conversion.
  bool replaceConversion(llvm::Instruction& user, llvm::Value* wide) {
    if (user.getType() != wide->getType()) return false;
    if (llvm::isa<llvm::SExtInst>(user)) {
      user.replaceAllUsesWith(wide);
      user.eraseFromParent();
      return true;
    }
    if (!llvm::isa<llvm::ZExtInst>(user)) return false;
    for (llvm::User* const consumer : llvm::make_early_inc_range(user.users())) {
      auto* const sum = llvm::dyn_cast<llvm::BinaryOperator>(consumer);
      if (sum == nullptr || sum->getOpcode() != llvm::Instruction::Add ||
          sum->getOperand(0) == sum->getOperand(1))
        continue;
      llvm::Value* const other = sum->getOperand(sum->getOperand(0) == &user ? 1 : 0);
      b_.SetInsertPoint(sum);
      b_.SetCurrentDebugLocation(sum->getDebugLoc());
      sum->replaceAllUsesWith(b_.CreateSub(other, wide));
      sum->eraseFromParent();
    }
    if (!user.use_empty()) {
      b_.SetInsertPoint(&user);
      user.replaceAllUsesWith(b_.CreateAnd(wide, llvm::ConstantInt::get(wide->getType(), 1)));
    }
    user.eraseFromParent();
    return true;
  }

  llvm::IRBuilder<> b_;
  llvm::IntegerType* word_ = nullptr;
  llvm::SmallSetVector<llvm::Instruction*, 16> computed_;
  llvm::SmallVector<llvm::Instruction*, 16> sources_;  ///< comparisons and other sources of masks
  llvm::DenseMap<llvm::Value*, llvm::Value*> words_;
};

}  // namespace

llvm::PreservedAnalyses WideMasks::run(llvm::Function& function, llvm::FunctionAnalysisManager&) {
  if (!function.hasFnAttribute(wideMasksAttribute) || !MaskWidener(function).widen())
    return llvm::PreservedAnalyses::all();
  llvm::PreservedAnalyses kept;
  kept.preserveSet<llvm::CFGAnalyses>();
  return kept;
}

void markWideMasks(llvm::Function& function) { function.addFnAttr(wideMasksAttribute); }

}  // namespace skc::native
