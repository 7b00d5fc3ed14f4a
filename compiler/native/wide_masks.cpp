// SPDX-License-Identifier: MIT
#include "native/llvm_passes.hpp"

#include <algorithm>
#include <numeric>

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

namespace {

constexpr char splitMasksAttribute[] = "sk-split-masks";

using Pieces = llvm::SmallVector<llvm::Value*, 4>;

class Splitter {
 public:
  Splitter(llvm::Function& function, unsigned vectorBits) : b_(function.getContext()) {
    unsigned narrowest = 64;  // of what is compared
    for (const llvm::Instruction& instruction : llvm::instructions(function)) {
      if (maskType(instruction) != nullptr && llvm::isa<llvm::CmpInst>(instruction))
        narrowest = std::min(narrowest, instruction.getOperand(0)->getType()->getScalarSizeInBits());
    }
    lanes_ = vectorBits / std::max(narrowest, 32U);
    for (llvm::Instruction& instruction : llvm::instructions(function)) {
      if (!isWide(instruction)) continue;
      (isComputedMask(instruction) ? computed_ : sources_).insert(&instruction);
    }
  }

  bool split() {
    if (computed_.empty() && sources_.empty()) return false;
    splitPhis();
    for (llvm::Instruction* const mask : computed_) replaceUses(*mask);
    for (llvm::Instruction* const mask : sources_) {
      if (llvm::isa<llvm::CmpInst>(mask)) replaceUses(*mask);
    }
    for (llvm::Instruction* const mask : computed_) mask->dropAllReferences();
    for (llvm::Instruction* const mask : computed_) mask->eraseFromParent();
    for (llvm::Instruction* const mask : sources_) {
      if (mask->use_empty() && llvm::isa<llvm::CmpInst>(mask)) mask->eraseFromParent();
    }
    return true;
  }

 private:
  bool isWide(const llvm::Value& value) const {
    const llvm::FixedVectorType* const type = maskType(value);
    return type != nullptr && type->getNumElements() > lanes_ && type->getNumElements() % lanes_ == 0;
  }

  void splitPhis() {
    for (llvm::Instruction* const mask : computed_) {
      auto* const phi = llvm::dyn_cast<llvm::PHINode>(mask);
      if (phi == nullptr) continue;
      Pieces& own = pieces_[phi];
      for (unsigned first = 0; first < maskType(*phi)->getNumElements(); first += lanes_) {
        auto* const piece = llvm::PHINode::Create(llvm::FixedVectorType::get(b_.getInt1Ty(), lanes_),
                                                  phi->getNumIncomingValues(), "", phi->getIterator());
        piece->setDebugLoc(phi->getDebugLoc());
        own.push_back(piece);
      }
    }
    for (llvm::Instruction* const mask : computed_) {
      auto* const phi = llvm::dyn_cast<llvm::PHINode>(mask);
      if (phi == nullptr) continue;
      for (unsigned i = 0; i < phi->getNumIncomingValues(); ++i) {
        const Pieces incoming = pieces(phi->getIncomingValue(i));
        for (std::size_t p = 0; p < incoming.size(); ++p) {
          llvm::cast<llvm::PHINode>(pieces_[phi][p])->addIncoming(incoming[p], phi->getIncomingBlock(i));
        }
      }
    }
  }

  void insertAt(llvm::Instruction& instruction) {
    b_.SetInsertPoint(&instruction);
    b_.SetCurrentDebugLocation(instruction.getDebugLoc());
  }

  /// Takes a vector apart at the insertion point.
  Pieces divided(llvm::Value* vector) {
    Pieces result;
    const unsigned count = llvm::cast<llvm::FixedVectorType>(vector->getType())->getNumElements();
    for (unsigned first = 0; first < count; first += lanes_) {
      llvm::SmallVector<int, 64> numbers(lanes_);
      std::iota(numbers.begin(), numbers.end(), static_cast<int>(first));
      result.push_back(b_.CreateShuffleVector(vector, numbers));
    }
    return result;
  }

  /// The vector of these pieces, whose number is a power of 2.
  llvm::Value* joined(Pieces parts) {
    while (parts.size() > 1) {
      const unsigned count = llvm::cast<llvm::FixedVectorType>(parts[0]->getType())->getNumElements();
      llvm::SmallVector<int, 64> numbers(2 * count);
      std::iota(numbers.begin(), numbers.end(), 0);
      Pieces longer;
      for (std::size_t p = 0; p < parts.size(); p += 2)
        longer.push_back(b_.CreateShuffleVector(parts[p], parts[p + 1], numbers));
      parts = std::move(longer);
    }
    return parts[0];
  }

  /// The pieces of a wide mask.
  Pieces pieces(llvm::Value* mask) {
    if (llvm::isa<llvm::Constant>(mask)) return divided(mask);
    const auto known = pieces_.find(mask);
    if (known != pieces_.end()) return known->second;
    Pieces result = make(mask);
    pieces_[mask] = result;
    return result;
  }

  Pieces make(llvm::Value* mask) {
    auto* const instruction = llvm::dyn_cast<llvm::Instruction>(mask);
    if (instruction == nullptr) {
      llvm::BasicBlock& entry = llvm::cast<llvm::Argument>(mask)->getParent()->getEntryBlock();
      b_.SetInsertPoint(&entry, entry.getFirstInsertionPt());
      return divided(mask);
    }
    Pieces result;
    if (auto* const comparison = llvm::dyn_cast<llvm::CmpInst>(instruction)) {
      insertAt(*comparison);
      const Pieces left = divided(comparison->getOperand(0));
      const Pieces right = divided(comparison->getOperand(1));
      for (std::size_t p = 0; p < left.size(); ++p)
        result.push_back(b_.CreateCmp(comparison->getPredicate(), left[p], right[p]));
      return result;
    }
    if (!computed_.contains(instruction)) {
      b_.SetInsertPoint(*instruction->getInsertionPointAfterDef());
      b_.SetCurrentDebugLocation(instruction->getDebugLoc());
      return divided(mask);
    }
    llvm::SmallVector<Pieces, 3> operands;
    for (llvm::Value* const operand : instruction->operands())
      operands.push_back(maskType(*operand) != nullptr ? pieces(operand) : Pieces{});
    insertAt(*instruction);
    for (std::size_t p = 0; p < operands.back().size(); ++p) {
      if (auto* const logic = llvm::dyn_cast<llvm::BinaryOperator>(instruction)) {
        result.push_back(b_.CreateBinOp(logic->getOpcode(), operands[0][p], operands[1][p]));
      } else if (llvm::isa<llvm::FreezeInst>(instruction)) {
        result.push_back(b_.CreateFreeze(operands[0][p]));
      } else {
        llvm::Value* const condition = operands[0].empty() ? instruction->getOperand(0) : operands[0][p];
        result.push_back(b_.CreateSelect(condition, operands[1][p], operands[2][p]));
      }
    }
    return result;
  }

  /// Makes users that are not masks themselves take the pieces.
  void replaceUses(llvm::Instruction& mask) {
    llvm::SmallSetVector<llvm::Instruction*, 8> users;
    for (llvm::User* const user : mask.users()) {
      auto* const instruction = llvm::cast<llvm::Instruction>(user);
      if (!computed_.contains(instruction)) users.insert(instruction);
    }
    for (llvm::Instruction* const user : users) {
      const Pieces own = pieces(&mask);
      insertAt(*user);
      if (replaceAnyTest(*user, own) || replaceSelection(*user, mask, own) || replaceConversion(*user, own))
        continue;
      user->replaceUsesOfWith(&mask, joined(own));
    }
  }

  void replace(llvm::Instruction& instruction, llvm::Value* value) {
    instruction.replaceAllUsesWith(value);
    instruction.eraseFromParent();
  }

  /// Turns a test whether any bit is set into a test of the pieces; false if `user` is no such test.
  bool replaceAnyTest(llvm::Instruction& user, const Pieces& own) {
    using namespace llvm::PatternMatch;
    if (!llvm::isa<llvm::BitCastInst>(user) || !user.getType()->isIntegerTy()) return false;
    const auto isZeroTest = [](const llvm::User* comparison) {
      const auto* const test = llvm::dyn_cast<llvm::ICmpInst>(comparison);
      return test != nullptr && test->isEquality() && match(test->getOperand(1), m_Zero());
    };
    if (!llvm::all_of(user.users(), isZeroTest)) return false;
    llvm::Value* any = own[0];
    for (llvm::Value* const piece : llvm::drop_begin(own)) any = b_.CreateOr(any, piece);
    any = b_.CreateBitCast(any, b_.getIntNTy(lanes_));
    for (llvm::User* const comparison : llvm::make_early_inc_range(user.users())) {
      auto* const test = llvm::cast<llvm::ICmpInst>(comparison);
      insertAt(*test);
      replace(*test, b_.CreateICmp(test->getPredicate(), any, llvm::ConstantInt::get(any->getType(), 0)));
    }
    user.eraseFromParent();
    return true;
  }

  /// Selects vectors piece by piece; false if `user` does not select by the mask.
  bool replaceSelection(llvm::Instruction& user, const llvm::Value& mask, const Pieces& own) {
    auto* const selection = llvm::dyn_cast<llvm::SelectInst>(&user);
    if (selection == nullptr || selection->getCondition() != &mask) return false;
    replace(user, selected(own, selection->getTrueValue(), selection->getFalseValue()));
    return true;
  }
  llvm::Value* selected(const Pieces& masks, llvm::Value* yes, llvm::Value* no) {
    const Pieces left = divided(yes), right = divided(no);
    Pieces result;
    for (std::size_t p = 0; p < masks.size(); ++p)
      result.push_back(b_.CreateSelect(masks[p], left[p], right[p]));
    return joined(std::move(result));
  }

  /// Converts masks to numbers piece by piece. Adding the numbers 0 and 1 becomes adding 1 in some lanes. False
  /// if `user` is no such conversion.
  bool replaceConversion(llvm::Instruction& user, const Pieces& own) {
    auto* const conversion = llvm::dyn_cast<llvm::CastInst>(&user);
    if (conversion == nullptr || !user.getType()->isVectorTy()) return false;
    if (llvm::isa<llvm::ZExtInst>(user)) replaceSums(user, own);
    insertAt(user);
    if (!user.use_empty()) {
      llvm::Type* const type = llvm::FixedVectorType::get(user.getType()->getScalarType(), lanes_);
      Pieces result;
      for (llvm::Value* const piece : own)
        result.push_back(b_.CreateCast(conversion->getOpcode(), piece, type));
      user.replaceAllUsesWith(joined(std::move(result)));
    }
    user.eraseFromParent();
    return true;
  }
  void replaceSums(llvm::Instruction& numbers, const Pieces& own) {
    for (llvm::User* const consumer : llvm::make_early_inc_range(numbers.users())) {
      auto* const sum = llvm::dyn_cast<llvm::BinaryOperator>(consumer);
      if (sum == nullptr || sum->getOpcode() != llvm::Instruction::Add ||
          sum->getOperand(0) == sum->getOperand(1))
        continue;
      llvm::Value* const other = sum->getOperand(sum->getOperand(0) == &numbers ? 1 : 0);
      insertAt(*sum);
      llvm::Value* const more = b_.CreateAdd(other, llvm::ConstantInt::get(other->getType(), 1));
      replace(*sum, selected(own, more, other));
    }
  }

  llvm::IRBuilder<> b_;
  unsigned lanes_;  ///< of a piece
  llvm::SmallSetVector<llvm::Instruction*, 16> computed_;
  llvm::SmallSetVector<llvm::Instruction*, 16> sources_;  ///< comparisons and other sources of masks
  llvm::DenseMap<llvm::Value*, Pieces> pieces_;
};

}  // namespace

llvm::PreservedAnalyses SplitMasks::run(llvm::Function& function, llvm::FunctionAnalysisManager&) {
  if (!function.hasFnAttribute(splitMasksAttribute)) return llvm::PreservedAnalyses::all();
  const auto bits = static_cast<unsigned>(function.getFnAttributeAsParsedInteger(splitMasksAttribute));
  if (!Splitter(function, bits).split()) return llvm::PreservedAnalyses::all();
  llvm::PreservedAnalyses kept;
  kept.preserveSet<llvm::CFGAnalyses>();
  return kept;
}

void markSplitMasks(llvm::Function& function, std::uint32_t vectorBits) {
  function.addFnAttr(splitMasksAttribute, std::to_string(vectorBits));
}

}  // namespace skc::native
