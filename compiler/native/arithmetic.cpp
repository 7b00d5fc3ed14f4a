// SPDX-License-Identifier: MIT
#include "native/arithmetic.hpp"

#include <llvm/IR/Constants.h>
#include <llvm/IR/Intrinsics.h>
#include <llvm/IR/Module.h>
#include <llvm/TargetParser/Triple.h>

#include "ir/scalar_operations.hpp"

namespace skc::native {

using namespace ir;

namespace {

bool isSigned(Scalar scalar) {
  return scalar != Scalar::Uint && scalar != Scalar::Ulong && scalar != Scalar::Bool;
}

bool isInteger(Scalar scalar) { return !isReal(scalar) && scalar != Scalar::Bool; }

/// True if the result is consecutive: a uniform value is added to a consecutive one, or subtracted from it.
bool staysConsecutive(BinaryOp op, const Lanes& lanes, const Part& lhs, const Part& rhs) {
  if (op == BinaryOp::Add) {
    return (lhs.isConsecutive && lanes.isUniform(rhs)) || (lanes.isUniform(lhs) && rhs.isConsecutive);
  }
  return op == BinaryOp::Sub && lhs.isConsecutive && lanes.isUniform(rhs);
}

/// Divides vectors of 32-bit integers in double, because CPUs have no instruction for it. Doubles hold the
/// operands and the truncated quotient exactly.
llvm::Value* quotientByDoubles(Lanes& l, bool isSigned, llvm::Value* a, llvm::Value* c) {
  llvm::Type* const wide = l.vector(l.b.getDoubleTy());
  llvm::Value* const x = isSigned ? l.b.CreateSIToFP(a, wide) : l.b.CreateUIToFP(a, wide);
  llvm::Value* const y = isSigned ? l.b.CreateSIToFP(c, wide) : l.b.CreateUIToFP(c, wide);
  llvm::Value* const q = l.b.CreateFDiv(x, y);
  return isSigned ? l.b.CreateFPToSI(q, a->getType()) : l.b.CreateFPToUI(q, a->getType());
}

llvm::Value* plainQuotient(Lanes& l, bool isSigned, llvm::Value* a, llvm::Value* c) {
  const bool fitsDouble = a->getType()->getScalarSizeInBits() == 32;
  if (fitsDouble && l.isVector(a) && !llvm::isa<llvm::Constant>(c))
    return quotientByDoubles(l, isSigned, a, c);
  return isSigned ? l.b.CreateSDiv(a, c) : l.b.CreateUDiv(a, c);
}

/// a / c and a % c.
struct Division {
  llvm::Value* quotient;
  llvm::Value* remainder;
};
Division divide(Lanes& l, bool isSigned, llvm::Value* a, llvm::Value* c) {
  llvm::Type* const type = a->getType();
  llvm::Value* const zero = l.integer(type, 0);
  llvm::Value* const one = l.integer(type, 1);
  llvm::Value* const isZero = l.b.CreateICmpEQ(c, zero);
  llvm::Value* isSpecial = isZero;
  llvm::Value* isMinusOne = nullptr;
  if (isSigned) {
    isMinusOne = l.b.CreateICmpEQ(c, l.integer(type, -1));
    isSpecial = l.b.CreateOr(isZero, isMinusOne);
  }
  llvm::Value* const divisor = l.b.CreateSelect(isSpecial, one, c);
  llvm::Value* quotient = plainQuotient(l, isSigned, a, divisor);
  llvm::Value* const remainder = l.b.CreateSub(a, l.b.CreateMul(quotient, divisor));  // 0 for the divisor 1
  if (isSigned) quotient = l.b.CreateSelect(isMinusOne, l.b.CreateNeg(a), quotient);
  return {quotient, remainder};
}

/// The count modulo the width of `a`, as a value of its type.
llvm::Value* shiftCount(Lanes& l, llvm::Value* a, llvm::Value* count) {
  const std::int64_t last = a->getType()->getScalarSizeInBits() - 1;
  return l.b.CreateZExt(l.b.CreateAnd(count, l.integer(count->getType(), last)), a->getType());
}

llvm::Value* realOperation(Lanes& l, BinaryOp op, llvm::Value* a, llvm::Value* c) {
  switch (op) {
    case BinaryOp::Add: return l.b.CreateFAdd(a, c);
    case BinaryOp::Sub: return l.b.CreateFSub(a, c);
    case BinaryOp::Mul: return l.b.CreateFMul(a, c);
    case BinaryOp::Div: return l.b.CreateFDiv(a, c);
    case BinaryOp::Less: return l.b.CreateFCmpOLT(a, c);
    case BinaryOp::LessEqual: return l.b.CreateFCmpOLE(a, c);
    case BinaryOp::Greater: return l.b.CreateFCmpOGT(a, c);
    case BinaryOp::GreaterEqual: return l.b.CreateFCmpOGE(a, c);
    case BinaryOp::Equal: return l.b.CreateFCmpOEQ(a, c);
    case BinaryOp::NotEqual: return l.b.CreateFCmpUNE(a, c);
    case BinaryOp::Rem:
    case BinaryOp::BitAnd:
    case BinaryOp::BitOr:
    case BinaryOp::BitXor:
    case BinaryOp::ShiftLeft:
    case BinaryOp::ShiftRight:
    case BinaryOp::LogicalAnd:
    case BinaryOp::LogicalOr: break;
  }
  llvm_unreachable("no operator of real numbers");
}

llvm::Value* integerOperation(Lanes& l, BinaryOp op, bool isSigned, llvm::Value* a, llvm::Value* c) {
  switch (op) {
    case BinaryOp::Add: return l.b.CreateAdd(a, c);
    case BinaryOp::Sub: return l.b.CreateSub(a, c);
    case BinaryOp::Mul: return l.b.CreateMul(a, c);
    case BinaryOp::Div: return divide(l, isSigned, a, c).quotient;
    case BinaryOp::Rem: return divide(l, isSigned, a, c).remainder;
    case BinaryOp::LogicalAnd:
    case BinaryOp::BitAnd: return l.b.CreateAnd(a, c);
    case BinaryOp::LogicalOr:
    case BinaryOp::BitOr: return l.b.CreateOr(a, c);
    case BinaryOp::BitXor: return l.b.CreateXor(a, c);
    case BinaryOp::ShiftLeft: return l.b.CreateShl(a, shiftCount(l, a, c));
    case BinaryOp::ShiftRight:
      return isSigned ? l.b.CreateAShr(a, shiftCount(l, a, c)) : l.b.CreateLShr(a, shiftCount(l, a, c));
    case BinaryOp::Less: return isSigned ? l.b.CreateICmpSLT(a, c) : l.b.CreateICmpULT(a, c);
    case BinaryOp::LessEqual: return isSigned ? l.b.CreateICmpSLE(a, c) : l.b.CreateICmpULE(a, c);
    case BinaryOp::Greater: return isSigned ? l.b.CreateICmpSGT(a, c) : l.b.CreateICmpUGT(a, c);
    case BinaryOp::GreaterEqual: return isSigned ? l.b.CreateICmpSGE(a, c) : l.b.CreateICmpUGE(a, c);
    case BinaryOp::Equal: return l.b.CreateICmpEQ(a, c);
    case BinaryOp::NotEqual: return l.b.CreateICmpNE(a, c);
  }
  llvm_unreachable("every operator has its case");
}

// ---- narrow scalars -------------------------------------------------------------------------------

/// The float that a normalized integer represents: k / max, but at least -1.
Part floatOfNormalized(Lanes& l, Scalar narrow, const Part& stored) {
  llvm::Value* const k = l.value(stored);
  const bool isSnorm = narrow == Scalar::Snorm8 || narrow == Scalar::Snorm16;
  llvm::Type* const type = l.sameShape(k, l.b.getFloatTy());
  llvm::Value* const whole = isSnorm ? l.b.CreateSIToFP(k, type) : l.b.CreateUIToFP(k, type);
  llvm::Value* const value = l.b.CreateFDiv(whole, l.number(type, normalizedScale(narrow)));
  if (!isSnorm) return {value};
  llvm::Value* const least = l.number(type, -1);
  return {l.b.CreateSelect(l.b.CreateFCmpOLT(value, least), least, value)};
}

/// The nearest normalized integer, ties to even; 0 for NaN.
Part normalizedOfFloat(Lanes& l, Scalar narrow, const Part& value) {
  llvm::Value* const x = l.value(value);
  llvm::Type* const type = x->getType();
  const bool isSnorm = narrow == Scalar::Snorm8 || narrow == Scalar::Snorm16;
  llvm::Value* const low = l.number(type, isSnorm ? -1 : 0);
  llvm::Value* const high = l.number(type, 1);
  llvm::Value* inside = l.b.CreateSelect(l.b.CreateFCmpOGT(x, low), x, low);
  inside = l.b.CreateSelect(l.b.CreateFCmpOLT(inside, high), inside, high);
  inside = l.b.CreateSelect(l.b.CreateFCmpUNO(x, x), l.number(type, 0), inside);
  llvm::Value* const product = l.b.CreateFMul(inside, l.number(type, normalizedScale(narrow)));
  // this sum has no bits behind the binary point, so that it rounds to an integer
  llvm::Value* const large = l.number(type, 0x1.8p23);
  llvm::Value* const nearest = l.b.CreateFSub(l.b.CreateFAdd(product, large), large);
  llvm::Value* const whole = l.b.CreateFPToSI(nearest, l.sameShape(x, l.int32()));
  return {l.b.CreateTrunc(whole, l.sameShape(x, l.type(narrow)))};
}

/// Converts a real number of any type to float, and back.
Part asFloat(Lanes& l, const Part& real) {
  llvm::Type* const type = l.sameShape(real.value, l.b.getFloatTy());
  return real.value->getType() == type ? real : Part{l.b.CreateFPTrunc(real.value, type)};
}
/// Rounds a real number to float so that rounding the result to half gives the half nearest to the number: to the nearest
/// float if that is exact or odd, else to its odd neighbour on the other side of the number (Boldo and Melquiond, "Emulation of
/// FMA and correctly rounded sums: proved algorithms using rounding to odd", 2008).
Part asOddFloat(Lanes& l, const Part& real) {
  llvm::Value* const x = real.value;
  const Part nearest = asFloat(l, real);
  if (nearest.value == x) return nearest;
  llvm::Type* const word = l.sameShape(x, l.int32());
  const auto magnitude = [&](llvm::Value* value) {
    return l.b.CreateUnaryIntrinsic(llvm::Intrinsic::fabs, value);
  };
  llvm::Value* const exact = magnitude(x);
  llvm::Value* const rounded = magnitude(l.b.CreateFPExt(nearest.value, x->getType()));
  llvm::Value* const bits = l.b.CreateBitCast(nearest.value, word);
  llvm::Value* step =
      l.b.CreateSelect(l.b.CreateFCmpOGT(rounded, exact), l.integer(word, -1), l.integer(word, 0));
  step = l.b.CreateSelect(l.b.CreateFCmpOLT(rounded, exact), l.integer(word, 1), step);
  llvm::Value* const isOdd = l.b.CreateTrunc(bits, l.sameShape(x, l.b.getInt1Ty()));
  llvm::Value* const odd = l.b.CreateSelect(isOdd, bits, l.b.CreateAdd(bits, step));
  return {l.b.CreateBitCast(odd, nearest.value->getType())};
}
Part asReal(Lanes& l, const Part& value) {
  llvm::Type* const type = l.sameShape(value.value, l.real());
  return value.value->getType() == type ? value : Part{l.b.CreateFPExt(value.value, type)};
}

Part fromNarrow(Lanes& l, Scalar narrow, const Part& stored) {
  llvm::Type* const word = l.sameShape(stored.value, l.int32());
  switch (narrow) {
    case Scalar::Char:
    case Scalar::Short: return {l.b.CreateSExt(stored.value, word)};
    case Scalar::Uchar:
    case Scalar::Ushort: return {l.b.CreateZExt(stored.value, word)};
    case Scalar::Half: return asReal(l, floatOfHalf(l, stored));
    default: return asReal(l, floatOfNormalized(l, narrow, stored));
  }
}
Part toNarrow(Lanes& l, Scalar narrow, const Part& number) {
  if (arithmeticScalar(narrow) == Scalar::Int) {
    llvm::Value* const word = l.value(number);
    return {l.b.CreateTrunc(word, l.sameShape(word, l.type(narrow)))};
  }
  return narrow == Scalar::Half ? halfOfFloat(l, asOddFloat(l, number))
                                : normalizedOfFloat(l, narrow, asFloat(l, number));
}

}  // namespace

Part unary(Lanes& l, UnaryOp op, Scalar scalar, const Part& operand) {
  llvm::Value* const x = l.value(operand);
  switch (op) {
    case UnaryOp::Negate: return {isReal(scalar) ? l.b.CreateFNeg(x) : l.b.CreateNeg(x)};
    case UnaryOp::BitNot:
    case UnaryOp::LogicalNot: break;
  }
  return {l.b.CreateNot(x)};
}

Part binary(Lanes& l, BinaryOp op, Scalar scalar, const Part& lhs, const Part& rhs) {
  if (scalar == Scalar::Int && staysConsecutive(op, l, lhs, rhs)) {
    return {integerOperation(l, op, true, lhs.value, rhs.value), true};
  }
  Part a = lhs, c = rhs;
  l.unify(a, c);
  return {isReal(scalar) ? realOperation(l, op, a.value, c.value)
                         : integerOperation(l, op, isSigned(scalar), a.value, c.value)};
}

/// Truncates and saturates; 0 for NaN. This is fptosi.sat, which LLVM computes lane by lane on x86.
static llvm::Value* saturatedInts(Lanes& l, llvm::Value* x) {
  llvm::Type* const type = l.sameShape(x, l.int32());
  const bool isFloat = x->getType()->getScalarType()->isFloatTy();
  llvm::Value* const least = l.number(x->getType(), -2147483648.0);
  llvm::Value* const most = l.number(x->getType(), isFloat ? 2147483520.0 : 2147483647.0);
  llvm::Value* const low = l.b.CreateSelect(l.b.CreateFCmpOGT(x, least), x, least);
  llvm::Value* const inside = l.b.CreateSelect(l.b.CreateFCmpOLT(low, most), low, most);
  llvm::Value* const isAbove = l.b.CreateFCmpOGE(x, l.number(x->getType(), 2147483648.0));
  llvm::Value* const nearest =
      l.b.CreateSelect(isAbove, l.integer(type, 0x7fffffff), l.b.CreateFPToSI(inside, type));
  return l.b.CreateSelect(l.b.CreateFCmpUNO(x, x), llvm::Constant::getNullValue(type), nearest);
}

Part convert(Lanes& l, Scalar from, Scalar to, const Part& operand) {
  if (from == to) return operand;
  if (isNarrow(from)) return convert(l, arithmeticScalar(from), to, fromNarrow(l, from, operand));
  if (to == Scalar::Half && from == Scalar::Double) return toNarrow(l, to, operand);
  if (isNarrow(to)) return toNarrow(l, to, convert(l, from, arithmeticScalar(to), operand));
  const bool areIntegers = isInteger(from) && isInteger(to);
  if (areIntegers && is64Bit(from) == is64Bit(to)) return operand;
  llvm::Value* const x = l.value(operand);
  llvm::Type* const type = l.sameShape(x, l.type(to));
  if (areIntegers && is64Bit(to)) return {isSigned(from) ? l.b.CreateSExt(x, type) : l.b.CreateZExt(x, type)};
  if (areIntegers) return {l.b.CreateTrunc(x, type)};
  if (to == Scalar::Bool) {
    llvm::Value* const zero = llvm::Constant::getNullValue(x->getType());
    return {isReal(from) ? l.b.CreateFCmpUNE(x, zero) : l.b.CreateICmpNE(x, zero)};
  }
  if (from == Scalar::Bool) return {isReal(to) ? l.b.CreateUIToFP(x, type) : l.b.CreateZExt(x, type)};
  if (isReal(from) && isReal(to)) return {l.b.CreateFPCast(x, type)};
  if (isReal(to)) return {isSigned(from) ? l.b.CreateSIToFP(x, type) : l.b.CreateUIToFP(x, type)};
  if (to == Scalar::Int && l.isVector(x)) return {saturatedInts(l, x)};
  const auto saturating = isSigned(to) ? llvm::Intrinsic::fptosi_sat : llvm::Intrinsic::fptoui_sat;
  return {l.b.CreateIntrinsic(saturating, {type, x->getType()}, {x})};
}

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
