// SPDX-License-Identifier: MIT
#include "native/scalar_builder.hpp"

#include <llvm/IR/Constants.h>
#include <llvm/IR/Module.h>
#include <llvm/TargetParser/Triple.h>

namespace skc::native {

Part ScalarBuilder::number(const Part& like, double value) const {
  return {l.number(like.value->getType()->getScalarType(), value)};
}

Part ScalarBuilder::decimal(const Part& like, const char* text) const {
  return {llvm::ConstantFP::get(like.value->getType()->getScalarType(), llvm::StringRef(text))};
}

Part ScalarBuilder::multiplyAdd(const Part& a, const Part& c, const Part& d) const {
  if (!l.b.getFastMathFlags().allowContract()) return add(mul(a, c), d);
  Part x = a, y = c, z = d;
  l.unify(x, y);
  l.unify(x, z);
  l.unify(y, z);
  return {l.b.CreateIntrinsic(llvm::Intrinsic::fma, {x.value->getType()}, {x.value, y.value, z.value})};
}

Part ScalarBuilder::abs(const Part& x) const {
  return {l.b.CreateUnaryIntrinsic(llvm::Intrinsic::fabs, x.value)};
}

Part ScalarBuilder::copySign(const Part& magnitude, const Part& sign) const {
  Part a = magnitude, c = sign;
  l.unify(a, c);
  return {l.b.CreateBinaryIntrinsic(llvm::Intrinsic::copysign, a.value, c.value)};
}

Part ScalarBuilder::isNegative(const Part& x) const {
  const unsigned bits = x.value->getType()->getScalarSizeInBits();
  llvm::Value* const word = l.b.CreateBitCast(x.value, l.sameShape(x.value, l.b.getIntNTy(bits)));
  return {l.b.CreateICmpSLT(word, llvm::Constant::getNullValue(word->getType()))};
}

Part ScalarBuilder::instruction(llvm::Intrinsic::ID id, const char* name, const Part& x) const {
  const bool isQuad = x.value->getType()->getScalarType()->isFP128Ty();
  return isQuad ? libm(name, {x}) : Part{l.b.CreateUnaryIntrinsic(id, x.value)};
}

Part ScalarBuilder::libm(std::string name, const std::vector<Part>& x) const {
  llvm::Type* const type = x[0].value->getType()->getScalarType();
  if (type->isFloatTy()) name += "f";
  if (type->isFP128Ty()) name += quadSuffix();
  return l.callPerLane(name, type, x);
}

const char* ScalarBuilder::quadSuffix() const {
  const llvm::Triple triple(l.b.GetInsertBlock()->getModule()->getTargetTriple());
  return triple.isX86() || triple.isPPC64() ? "q" : "l";
}

}  // namespace skc::native
