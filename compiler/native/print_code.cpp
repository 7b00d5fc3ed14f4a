// SPDX-License-Identifier: MIT
//
// printf in native code: one call of the C library's for each active lane, in the order of lanes. The library locks its output
// for the time of a call, so that lines of several threads are not torn.
#include <vector>

#include <llvm/IR/Constants.h>
#include <llvm/IR/Intrinsics.h>
#include <llvm/IR/Module.h>

#include "native/function_code.hpp"

namespace skc::native {

using namespace ir;

namespace {

/// As C passes it: doubles and ints.
llvm::Value* promoted(Lanes& l, llvm::Value* value) {
  if (!value->getType()->isFPOrFPVectorTy()) return value;
  llvm::Type* const real = l.b.getDoubleTy();
  return l.b.CreateFPCast(value, l.isVector(value) ? l.vector(real) : real);
}

}  // namespace

void FunctionCode::write(const Print& n) {
  llvm::Function* const function = b.GetInsertBlock()->getParent();
  llvm::Module& module = *function->getParent();
  const llvm::FunctionCallee printf = module.getOrInsertFunction(
      "printf", llvm::FunctionType::get(b.getInt32Ty(), {b.getPtrTy()}, /*isVarArg=*/true));
  llvm::IRBuilder<> allocas(&function->getEntryBlock(), function->getEntryBlock().begin());
  std::vector<llvm::Value*> lanes;  // the values of all lanes, in memory
  std::vector<llvm::Type*> types;
  for (const ExprPtr& expr : n.values) {
    llvm::Value* const values = promoted(l, l.broadcast(expression(*expr)[0]));
    lanes.push_back(allocas.CreateAlloca(values->getType()));
    types.push_back(values->getType()->getScalarType());
    b.CreateStore(values, lanes.back());
  }
  llvm::Value* const active =
      b.CreateZExt(b.CreateBitCast(maskOf(n.mask), b.getIntNTy(l.count())), l.int64());
  llvm::Value* const mask =
      b.CreateSelect(b.CreateIsNotNull(k.streams.isSilent()), l.integer(l.int64(), 0), active);
  llvm::Value* const format = b.CreateGlobalStringPtr(n.format);
  llvm::BasicBlock* const before = b.GetInsertBlock();
  llvm::BasicBlock* const one = newBlock("print");
  llvm::BasicBlock* const end = newBlock("printed");
  b.CreateCondBr(b.CreateIsNotNull(mask), one, end);
  b.SetInsertPoint(one);
  llvm::PHINode* const left = b.CreatePHI(l.int64(), 2);
  left->addIncoming(mask, before);
  llvm::Value* const lane = b.CreateBinaryIntrinsic(llvm::Intrinsic::cttz, left, b.getTrue());
  std::vector<llvm::Value*> arguments = {format};
  for (std::size_t i = 0; i < lanes.size(); ++i)
    arguments.push_back(b.CreateLoad(types[i], l.at(types[i], lanes[i], lane)));
  b.CreateCall(printf, arguments);
  llvm::Value* const rest = b.CreateAnd(left, b.CreateSub(left, l.integer(l.int64(), 1)));
  left->addIncoming(rest, b.GetInsertBlock());
  b.CreateCondBr(b.CreateIsNotNull(rest), one, end);
  b.SetInsertPoint(end);
}

}  // namespace skc::native
