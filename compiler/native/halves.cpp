// SPDX-License-Identifier: MIT
#include "native/halves.hpp"

#include <llvm/IR/Constants.h>
#include <llvm/IR/Module.h>
#include <llvm/TargetParser/Triple.h>

namespace skc::native {

using namespace ir;

namespace {

// ---- in software ----------------------------------------------------------------------------------

llvm::Value* expanded(Lanes& l, llvm::Value* stored) {
  llvm::Value* const bits = l.b.CreateZExt(stored, l.sameShape(stored, l.int32()));
  llvm::Type* const word = bits->getType();
  llvm::Type* const real = l.sameShape(bits, l.b.getFloatTy());
  llvm::Value* const sign = l.b.CreateShl(l.b.CreateAnd(bits, l.integer(word, 0x8000)), 16);
  llvm::Value* const magnitude = l.b.CreateAnd(bits, l.integer(word, 0x7fff));
  llvm::Value* const shifted = l.b.CreateShl(magnitude, 13);
  llvm::Value* const normal = l.b.CreateAdd(shifted, l.integer(word, 112 << 23));
  llvm::Value* const special = l.b.CreateAdd(shifted, l.integer(word, 224 << 23));  // infinity, NaN
  llvm::Value* const denormal =
      l.b.CreateBitCast(l.b.CreateFMul(l.b.CreateUIToFP(magnitude, real), l.number(real, 0x1p-24)), word);
  llvm::Value* result =
      l.b.CreateSelect(l.b.CreateICmpUGE(magnitude, l.integer(word, 0x7c00)), special, normal);
  result = l.b.CreateSelect(l.b.CreateICmpULT(magnitude, l.integer(word, 0x400)), denormal, result);
  return l.b.CreateBitCast(l.b.CreateOr(result, sign), real);
}

llvm::Value* roundedBits(Lanes& l, llvm::Value* x) {
  llvm::Type* const real = x->getType();
  llvm::Type* const word = l.sameShape(x, l.int32());
  const auto constant = [&](std::int64_t bits) { return l.integer(word, static_cast<std::int32_t>(bits)); };
  llvm::Value* const bits = l.b.CreateBitCast(x, word);
  llvm::Value* const sign = l.b.CreateAnd(bits, constant(0x80000000));
  llvm::Value* const magnitude = l.b.CreateXor(bits, sign);
  llvm::Value* const odd = l.b.CreateAnd(l.b.CreateLShr(magnitude, 13), constant(1));
  llvm::Value* const up = l.b.CreateAdd(l.b.CreateAdd(magnitude, constant(0xfff)), odd);
  llvm::Value* const normal = l.b.CreateAnd(up, constant(~std::int64_t{0x1fff}));
  // floats at 1/2 have the same unit as subnormal halves, 2^-24
  llvm::Value* const half = l.number(real, 0.5);
  llvm::Value* const denormal =
      l.b.CreateBitCast(l.b.CreateFSub(l.b.CreateFAdd(l.b.CreateBitCast(magnitude, real), half), half), word);
  llvm::Value* const nan =
      l.b.CreateAnd(l.b.CreateOr(magnitude, constant(0x7fc00000)), constant(~std::int64_t{0x1fff}));
  llvm::Value* rounded = l.b.CreateSelect(l.b.CreateICmpUGT(normal, constant(0x477fe000)),  // beyond 65504
                                          constant(0x7f800000), normal);
  rounded = l.b.CreateSelect(l.b.CreateICmpULT(magnitude, constant(0x38800000)), denormal, rounded);
  rounded = l.b.CreateSelect(l.b.CreateICmpUGT(magnitude, constant(0x7f800000)), nan, rounded);
  return l.b.CreateBitCast(l.b.CreateOr(rounded, sign), real);
}

llvm::Value* halfBits(Lanes& l, llvm::Value* x) {
  llvm::Value* const rounded = roundedBits(l, x);
  llvm::Type* const word = l.sameShape(rounded, l.int32());
  llvm::Value* const bits = l.b.CreateBitCast(rounded, word);
  llvm::Value* const sign = l.b.CreateAnd(l.b.CreateLShr(bits, 16), l.integer(word, 0x8000));
  llvm::Value* const magnitude = l.b.CreateAnd(bits, l.integer(word, 0x7fffffff));
  llvm::Value* const normal = l.b.CreateSub(l.b.CreateLShr(magnitude, 13), l.integer(word, 112 << 10));
  llvm::Value* const special = l.b.CreateSub(l.b.CreateLShr(magnitude, 13), l.integer(word, 224 << 10));
  // a subnormal half counts units of 2^-24
  llvm::Value* const scaled =
      l.b.CreateFMul(l.b.CreateBitCast(magnitude, rounded->getType()), l.number(rounded->getType(), 0x1p24));
  llvm::Value* const isDenormal = l.b.CreateICmpULT(magnitude, l.integer(word, 0x38800000));
  llvm::Value* const small =
      l.b.CreateSelect(isDenormal, scaled, llvm::Constant::getNullValue(scaled->getType()));
  llvm::Value* half = l.b.CreateSelect(isDenormal, l.b.CreateFPToUI(small, word), normal);
  half = l.b.CreateSelect(l.b.CreateICmpUGE(magnitude, l.integer(word, 0x7f800000)), special, half);
  return l.b.CreateTrunc(l.b.CreateOr(half, sign), l.sameShape(rounded, l.type(Scalar::Half)));
}

using Conversion = llvm::Value*(Lanes& l, llvm::Value* x);

/// A function of the module that converts values of this type. If the target has a calling convention that
/// preserves all registers, it uses that, so that callers need not save theirs.
llvm::Function* outOfLine(Lanes& l, const char* name, Conversion* conversion, llvm::Type* operand,
                          llvm::Type* result) {
  llvm::Function* const caller = l.b.GetInsertBlock()->getParent();
  const bool isVector = operand->isVectorTy();
  const std::string full = std::string("sk.") + name + (isVector ? "." + std::to_string(l.count()) : "");
  llvm::Module& code = *caller->getParent();
  if (llvm::Function* const known = code.getFunction(full)) return known;
  llvm::Function* const wrapper = llvm::Function::Create(llvm::FunctionType::get(result, {operand}, false),
                                                         llvm::Function::InternalLinkage, full, code);
  if (llvm::Triple(code.getTargetTriple()).getArch() == llvm::Triple::x86_64)
    wrapper->setCallingConv(llvm::CallingConv::PreserveAll);
  wrapper->setDoesNotThrow();
  wrapper->setDoesNotAccessMemory();
  wrapper->addFnAttr(llvm::Attribute::NoInline);
  if (caller->hasFnAttribute("target-cpu")) wrapper->addFnAttr(caller->getFnAttribute("target-cpu"));
  const llvm::IRBuilderBase::InsertPointGuard guard(l.b);
  const llvm::DebugLoc place = l.b.getCurrentDebugLocation();
  l.b.SetCurrentDebugLocation({});
  l.b.SetInsertPoint(llvm::BasicBlock::Create(code.getContext(), "entry", wrapper));
  l.b.CreateRet(conversion(l, wrapper->getArg(0)));
  l.b.SetCurrentDebugLocation(place);
  return wrapper;
}

llvm::Value* converted(Lanes& l, const char* name, Conversion* conversion, llvm::Value* x,
                       llvm::Type* result) {
  if (llvm::isa<llvm::Constant>(x)) return conversion(l, x);
  llvm::Function* const function = outOfLine(l, name, conversion, x->getType(), result);
  llvm::CallInst* const call = l.b.CreateCall(function, {x});
  call->setCallingConv(function->getCallingConv());
  return call;
}

llvm::Value* inHardware(Lanes& l, llvm::Value* x) {
  return l.b.CreateFPTrunc(x, l.sameShape(x, l.b.getHalfTy()));
}

}  // namespace

Part floatOfHalf(Lanes& l, const Part& stored) {
  llvm::Value* const x = l.value(stored);
  llvm::Type* const real = l.sameShape(x, l.b.getFloatTy());
  if (l.options().convertsHalves)
    return {l.b.CreateFPExt(l.b.CreateBitCast(x, l.sameShape(x, l.b.getHalfTy())), real)};
  return {converted(l, "float_of_half", expanded, x, real)};
}

Part roundedToHalf(Lanes& l, const Part& value) {
  llvm::Value* const x = l.value(value);
  if (l.options().convertsHalves) return {l.b.CreateFPExt(inHardware(l, x), x->getType())};
  return {converted(l, "rounded_to_half", roundedBits, x, x->getType())};
}

Part halfOfFloat(Lanes& l, const Part& value) {
  llvm::Value* const x = l.value(value);
  llvm::Type* const bits = l.sameShape(x, l.type(Scalar::Half));
  if (l.options().convertsHalves) return {l.b.CreateBitCast(inHardware(l, x), bits)};
  return {converted(l, "half_of_float", halfBits, x, bits)};
}

}  // namespace skc::native
