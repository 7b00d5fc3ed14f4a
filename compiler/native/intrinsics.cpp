// SPDX-License-Identifier: MIT
#include "native/intrinsics.hpp"

#include <limits>
#include <string>

#include <llvm/IR/Constants.h>
#include <llvm/IR/Intrinsics.h>
#include <llvm/IR/Module.h>
#include <llvm/TargetParser/Triple.h>

#include "native/arithmetic.hpp"

namespace skc::native {

using namespace ir;
using sk::native::Real;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Arithmetic of one component in the notation of formulas.
class Formula {
 public:
  Formula(Lanes& lanes, const LibraryCall& library) : l(lanes), library_(library) {}

  Lanes& l;

  Part add(const Part& a, const Part& c) const { return op(BinaryOp::Add, a, c); }
  Part sub(const Part& a, const Part& c) const { return op(BinaryOp::Sub, a, c); }
  Part mul(const Part& a, const Part& c) const { return op(BinaryOp::Mul, a, c); }
  Part div(const Part& a, const Part& c) const { return op(BinaryOp::Div, a, c); }
  Part less(const Part& a, const Part& c) const { return op(BinaryOp::Less, a, c); }
  Part equal(const Part& a, const Part& c) const { return op(BinaryOp::Equal, a, c); }
  Part differs(const Part& a, const Part& c) const { return op(BinaryOp::NotEqual, a, c); }
  Part both(const Part& a, const Part& c) const { return logic(BinaryOp::LogicalAnd, a, c); }
  Part either(const Part& a, const Part& c) const { return logic(BinaryOp::LogicalOr, a, c); }
  Part select(const Part& c, const Part& yes, const Part& no) const { return l.select(c, yes, no); }
  /// A number of the type of `like`.
  Part number(const Part& like, double value) const {
    return {l.number(like.value->getType()->getScalarType(), value)};
  }

  Part decimal(const Part& like, const char* text) const {
    return {llvm::ConstantFP::get(like.value->getType()->getScalarType(), llvm::StringRef(text))};
  }

  Part negate(const Part& x) const { return unary(l, UnaryOp::Negate, Scalar::Float, x); }
  Part abs(const Part& x) const { return {l.b.CreateUnaryIntrinsic(llvm::Intrinsic::fabs, x.value)}; }
  Part copySign(const Part& magnitude, const Part& sign) const {
    Part a = magnitude, c = sign;
    l.unify(a, c);
    return {l.b.CreateBinaryIntrinsic(llvm::Intrinsic::copysign, a.value, c.value)};
  }
  Part isInfinite(const Part& x) const { return equal(abs(x), number(x, infinity)); }
  Part isFinite(const Part& x) const { return less(abs(x), number(x, infinity)); }
  /// Whether the sign bit is set, of -0 and NaN, too.
  Part isNegative(const Part& x) const {
    const unsigned bits = x.value->getType()->getScalarSizeInBits();
    llvm::Value* const word = l.b.CreateBitCast(x.value, l.sameShape(x.value, l.b.getIntNTy(bits)));
    return {l.b.CreateICmpSLT(word, llvm::Constant::getNullValue(word->getType()))};
  }

  /// What the library or, lane by lane, the C library has by this name.
  Part function(Intrinsic intrinsic, const char* name, const std::vector<Part>& x) const {
    const bool isFloat = x[0].value->getType()->getScalarType()->isFloatTy();
    if (library_) {
      if (const auto value = library_(intrinsic, isFloat ? Scalar::Float : Scalar::Double, x)) return *value;
    }
    return cFunction(name, x[0].value->getType()->getScalarType(), x);
  }
  Part cFunction(std::string name, llvm::Type* result, const std::vector<Part>& x) const {
    llvm::Type* const type = x[0].value->getType()->getScalarType();
    if (type->isFloatTy()) name += "f";
    if (type->isFP128Ty()) name += quadSuffix();
    return l.callPerLane(name, result, x);
  }
  /// libquadmath's functions, or, where long double is binary128, those of the C library.
  const char* quadSuffix() const {
    const llvm::Triple triple(l.b.GetInsertBlock()->getModule()->getTargetTriple());
    return triple.isX86() || triple.isPPC64() ? "q" : "l";
  }
  /// An operation that CPUs have; not of binary128, which has functions.
  Part operation(llvm::Intrinsic::ID id, const char* name, const Part& x) const {
    llvm::Type* const type = x.value->getType()->getScalarType();
    return type->isFP128Ty() ? cFunction(name, type, {x}) : Part{l.b.CreateUnaryIntrinsic(id, x.value)};
  }
  Part sqrt(const Part& x) const { return operation(llvm::Intrinsic::sqrt, "sqrt", x); }
  Part floor(const Part& x) const { return operation(llvm::Intrinsic::floor, "floor", x); }
  Part trunc(const Part& x) const { return operation(llvm::Intrinsic::trunc, "trunc", x); }

 private:
  Part op(BinaryOp o, const Part& a, const Part& c) const { return binary(l, o, Scalar::Float, a, c); }
  Part logic(BinaryOp o, const Part& a, const Part& c) const { return binary(l, o, Scalar::Bool, a, c); }

  const LibraryCall& library_;
};

// ---- one component --------------------------------------------------------------------------------

/// IEEE 754's minNum and maxNum: of a number and a NaN, the number; -0 is below +0.
Part extreme(const Formula& f, bool isMin, Scalar scalar, const Part& x, const Part& y) {
  const BinaryOp before = isMin ? BinaryOp::Less : BinaryOp::Greater;
  if (scalar == Scalar::Int || scalar == Scalar::Uint) {
    return f.select(binary(f.l, before, scalar, y, x), y, x);
  }
  Part a = x, c = y;
  f.l.unify(a, c);
  const Part isFirst = f.either(binary(f.l, before, scalar, a, c), f.differs(c, c));
  const Part ofEqual = isMin ? f.select(f.isNegative(a), a, c) : f.select(f.isNegative(a), c, a);
  return f.select(f.equal(a, c), ofEqual, f.select(isFirst, a, c));
}

Part absolute(const Formula& f, Scalar scalar, const Part& x) {
  if (scalar != Scalar::Int) return f.abs(x);
  const Part zero = {f.l.integer(f.l.int32(), 0)};
  return f.select(binary(f.l, BinaryOp::Less, scalar, x, zero), unary(f.l, UnaryOp::Negate, scalar, x), x);
}

Part sign(const Formula& f, Scalar scalar, const Part& x) {
  const auto constant = [&](int value) { return Part{f.l.constant(scalar, value)}; };
  const Part below = f.select(binary(f.l, BinaryOp::Less, scalar, x, constant(0)), constant(-1), constant(0));
  return f.select(binary(f.l, BinaryOp::Greater, scalar, x, constant(0)), constant(1), below);
}

/// The number before 1.
Part belowOne(const Part& x) {
  llvm::APFloat one(1.0);
  bool isInexact = false;
  one.convert(x.value->getType()->getScalarType()->getFltSemantics(), llvm::APFloat::rmNearestTiesToEven,
              &isInexact);
  one.next(/*nextDown=*/true);
  return {llvm::ConstantFP::get(x.value->getType()->getScalarType(), one)};
}

/// Below 1, also where x is a little less than a whole number.
Part fraction(const Formula& f, const Part& x) {
  const Part rest = f.sub(x, f.floor(x));
  const Part inside =
      f.select(f.less(rest, f.number(x, 1)), rest, f.select(f.differs(rest, rest), rest, belowOne(x)));
  return f.select(f.isInfinite(x), f.number(x, std::numeric_limits<double>::quiet_NaN()), inside);
}

/// What is left of x by y, exact but for the sum that gives it the sign of y.
Part modulo(const Formula& f, const Part& x, const Part& y) {
  const Part left = f.function(Intrinsic::Fmod, "fmod", {x, y});
  const Part zero = f.number(x, 0);
  Part a = f.less(left, zero), c = f.less(y, zero);
  const Part otherSign = binary(f.l, BinaryOp::BitXor, Scalar::Bool, a, c);
  return f.select(f.both(f.differs(left, zero), otherSign), f.add(left, y), left);
}

Part mix(const Formula& f, const Part& x, const Part& y, const Part& t) {
  return f.add(f.mul(x, f.sub(f.number(t, 1), t)), f.mul(y, t));
}

Part clamp(const Formula& f, Scalar scalar, const Part& x, const Part& low, const Part& high) {
  return extreme(f, true, scalar, extreme(f, false, scalar, x, low), high);
}

Part smoothstep(const Formula& f, const Part& low, const Part& high, const Part& x) {
  const Part t =
      clamp(f, Scalar::Float, f.div(f.sub(x, low), f.sub(high, low)), f.number(x, 0), f.number(x, 1));
  return f.mul(f.mul(t, t), f.sub(f.number(x, 3), f.mul(f.number(x, 2), t)));
}

/// The bits of the float that is nearest, where the real type is wider; and the way back.
Part bitsOf(const Formula& f, const Part& x) {
  const Part narrow = {f.l.b.CreateFPCast(x.value, f.l.sameShape(x.value, f.l.b.getFloatTy()))};
  return {f.l.b.CreateBitCast(narrow.value, f.l.sameShape(x.value, f.l.int32()))};
}
Part realOfBits(const Formula& f, const Part& x) {
  llvm::Value* const bits = f.l.value(x);
  llvm::Value* const value = f.l.b.CreateBitCast(bits, f.l.sameShape(bits, f.l.b.getFloatTy()));
  return {f.l.b.CreateFPCast(value, f.l.sameShape(bits, f.l.real()))};
}

/// A number as a double in which it is no denormal, as its bits.
struct DoubleBits {
  llvm::Value* word;
  llvm::Value* exponent;  ///< biased
  llvm::Value* isScaled;  ///< by 2^54; null where that cannot be
};
DoubleBits doubleBits(const Formula& f, const Part& x) {
  Lanes& l = f.l;
  const bool isFloat = x.value->getType()->getScalarType()->isFloatTy();
  llvm::Type* const wide = l.sameShape(x.value, l.b.getDoubleTy());
  llvm::Type* const word = l.sameShape(x.value, l.int64());
  llvm::Value* value = l.b.CreateFPCast(x.value, wide);
  llvm::Value* isScaled = nullptr;
  if (!isFloat) {
    isScaled = l.b.CreateFCmpOLT(f.abs({value}).value, l.number(wide, 0x1p-1022));
    value = l.b.CreateSelect(isScaled, l.b.CreateFMul(value, l.number(wide, 0x1p54)), value);
  }
  llvm::Value* const bits = l.b.CreateBitCast(value, word);
  llvm::Value* const field = l.b.CreateAnd(l.b.CreateLShr(bits, 52), l.integer(word, 0x7ff));
  return {bits, field, isScaled};
}

/// Whether frexp gives x itself, and an exponent of 0.
Part isWithoutExponent(const Formula& f, const Part& x) {
  return f.either(f.equal(x, f.number(x, 0)), unary(f.l, UnaryOp::LogicalNot, Scalar::Bool, f.isFinite(x)));
}

/// frexpq() of one lane: its mantissa or its exponent.
Part quadFrexp(const Formula& f, const Part& x, bool isExponent) {
  Lanes& l = f.l;
  llvm::Function* const around = l.b.GetInsertBlock()->getParent();
  llvm::IRBuilder<> entry(&around->getEntryBlock(), around->getEntryBlock().begin());
  llvm::Value* const exponent = entry.CreateAlloca(l.int32());
  llvm::Type* const quad = x.value->getType()->getScalarType();
  const llvm::FunctionCallee frexp = around->getParent()->getOrInsertFunction(
      std::string("frexp") + f.quadSuffix(),
      llvm::FunctionType::get(quad, {quad, exponent->getType()}, false));
  return l.perLane({x}, isExponent ? l.int32() : quad, [&](llvm::ArrayRef<llvm::Value*> a) -> llvm::Value* {
    llvm::Value* const mantissa = l.b.CreateCall(frexp, {a[0], exponent});
    return isExponent ? l.b.CreateLoad(l.int32(), exponent) : mantissa;
  });
}

Part frexpExponent(const Formula& f, const Part& x) {
  Lanes& l = f.l;
  const Part zero = {l.integer(l.int32(), 0)};
  if (x.value->getType()->getScalarType()->isFP128Ty()) {
    return f.select(isWithoutExponent(f, x), zero, quadFrexp(f, x, true));
  }
  const DoubleBits bits = doubleBits(f, x);
  llvm::Type* const word = bits.word->getType();
  llvm::Value* exponent = l.b.CreateSub(bits.exponent, l.integer(word, 1022));
  if (bits.isScaled != nullptr) {
    exponent = l.b.CreateSelect(bits.isScaled, l.b.CreateSub(exponent, l.integer(word, 54)), exponent);
  }
  return f.select(isWithoutExponent(f, x), zero,
                  {l.b.CreateTrunc(exponent, l.sameShape(x.value, l.int32()))});
}

Part frexpMantissa(const Formula& f, const Part& x) {
  Lanes& l = f.l;
  if (x.value->getType()->getScalarType()->isFP128Ty()) {
    return f.select(isWithoutExponent(f, x), x, quadFrexp(f, x, false));
  }
  const DoubleBits bits = doubleBits(f, x);
  llvm::Type* const word = bits.word->getType();
  llvm::Value* const mantissa = l.b.CreateOr(l.b.CreateAnd(bits.word, l.integer(word, ~(0x7ffLL << 52))),
                                             l.integer(word, 1022LL << 52));
  llvm::Value* const wide = l.b.CreateBitCast(mantissa, l.sameShape(x.value, l.b.getDoubleTy()));
  return f.select(isWithoutExponent(f, x), x, {l.b.CreateFPCast(wide, x.value->getType())});
}

/// x * 2^e, rounded once. All floats by all powers of 2 that matter to them are exact in double.
Part ldexp(const Formula& f, const Part& number, const Part& exponent) {
  Lanes& l = f.l;
  Part x = number, e = exponent;
  l.unify(x, e);
  if (!x.value->getType()->getScalarType()->isFloatTy()) {
    return f.cFunction("ldexp", x.value->getType()->getScalarType(), {x, e});
  }
  llvm::Type* const word = e.value->getType();
  llvm::Value* n = l.b.CreateBinaryIntrinsic(llvm::Intrinsic::smax, e.value, l.integer(word, -400));
  n = l.b.CreateBinaryIntrinsic(llvm::Intrinsic::smin, n, l.integer(word, 400));
  llvm::Type* const longWord = l.sameShape(x.value, l.int64());
  llvm::Value* const bits =
      l.b.CreateShl(l.b.CreateSExt(l.b.CreateAdd(n, l.integer(word, 1023)), longWord), 52);
  llvm::Type* const wide = l.sameShape(x.value, l.b.getDoubleTy());
  llvm::Value* const product = l.b.CreateFMul(l.b.CreateFPExt(x.value, wide), l.b.CreateBitCast(bits, wide));
  return {l.b.CreateFPTrunc(product, x.value->getType())};
}

/// What the rounding of a sum loses (Knuth, TAOCP 2, 4.2.2).
Part sumError(const Formula& f, const Part& a, const Part& c) {
  const Part s = f.add(a, c);
  const Part d = f.sub(s, a);
  return f.add(f.sub(a, f.sub(s, d)), f.sub(c, d));
}

/// What the rounding of a product loses; of one that is not finite, 0.
Part productError(const Formula& f, const Part& x, const Part& y) {
  Lanes& l = f.l;
  Part a = x, c = y;
  l.unify(a, c);
  const Part p = f.mul(a, c);
  llvm::Type* const type = a.value->getType();
  Part error;
  if (type->getScalarType()->isFloatTy()) {
    llvm::Type* const wide = l.sameShape(a.value, l.b.getDoubleTy());
    llvm::Value* const exact = l.b.CreateFMul(l.b.CreateFPExt(a.value, wide), l.b.CreateFPExt(c.value, wide));
    error = {l.b.CreateFPTrunc(l.b.CreateFSub(exact, l.b.CreateFPExt(p.value, wide)), type)};
  } else if (type->getScalarType()->isFP128Ty()) {
    error = f.cFunction("fma", type->getScalarType(), {a, c, f.negate(p)});
  } else {
    error = {l.b.CreateIntrinsic(llvm::Intrinsic::fma, {type}, {a.value, c.value, f.negate(p).value})};
  }
  return f.select(f.isFinite(p), error, f.number(p, 0));
}

Part component(const Formula& f, Intrinsic intrinsic, Scalar scalar, const std::vector<Part>& x) {
  const auto call = [&](const char* name) { return f.function(intrinsic, name, x); };
  switch (intrinsic) {
    case Intrinsic::Radians: return f.mul(x[0], f.decimal(x[0], "0.01745329251994329576923690768488612713"));
    case Intrinsic::Degrees: return f.mul(x[0], f.decimal(x[0], "57.29577951308232087679815481410517033"));
    case Intrinsic::Sin: return call("sin");
    case Intrinsic::Cos: return call("cos");
    case Intrinsic::Tan: return call("tan");
    case Intrinsic::Asin: return call("asin");
    case Intrinsic::Acos: return call("acos");
    case Intrinsic::Atan: return call("atan");
    case Intrinsic::AtanYX:
    case Intrinsic::Atan2: return f.function(Intrinsic::Atan2, "atan2", x);
    case Intrinsic::Sinh: return call("sinh");
    case Intrinsic::Cosh: return call("cosh");
    case Intrinsic::Tanh: return call("tanh");
    case Intrinsic::Asinh: return call("asinh");
    case Intrinsic::Acosh: return call("acosh");
    case Intrinsic::Atanh: return call("atanh");
    case Intrinsic::Pow: return call("pow");
    case Intrinsic::Exp: return call("exp");
    case Intrinsic::Log: return call("log");
    case Intrinsic::Exp2: return call("exp2");
    case Intrinsic::Log2: return call("log2");
    case Intrinsic::Log10: return call("log10");
    case Intrinsic::Sqrt: return f.sqrt(x[0]);
    case Intrinsic::InverseSqrt:
    case Intrinsic::Rsqrt: return f.div(f.number(x[0], 1), f.sqrt(x[0]));
    case Intrinsic::Abs:
    case Intrinsic::Fabs: return absolute(f, scalar, x[0]);
    case Intrinsic::Sign: return sign(f, scalar, x[0]);
    case Intrinsic::Floor: return f.floor(x[0]);
    case Intrinsic::Trunc: return f.trunc(x[0]);
    case Intrinsic::Round:
    case Intrinsic::RoundEven: return f.operation(llvm::Intrinsic::roundeven, "nearbyint", x[0]);
    case Intrinsic::Ceil: return f.operation(llvm::Intrinsic::ceil, "ceil", x[0]);
    case Intrinsic::Fract:
    case Intrinsic::Frac: return fraction(f, x[0]);
    case Intrinsic::Mod: return modulo(f, x[0], x[1]);
    case Intrinsic::Fmod: return call("fmod");
    case Intrinsic::Min:
    case Intrinsic::Fmin: return extreme(f, true, scalar, x[0], x[1]);
    case Intrinsic::Max:
    case Intrinsic::Fmax: return extreme(f, false, scalar, x[0], x[1]);
    case Intrinsic::Clamp: return clamp(f, scalar, x[0], x[1], x[2]);
    case Intrinsic::Saturate: return clamp(f, scalar, x[0], f.number(x[0], 0), f.number(x[0], 1));
    case Intrinsic::Mix:
    case Intrinsic::Lerp: return mix(f, x[0], x[1], x[2]);
    case Intrinsic::MixBool: return f.select(x[2], x[1], x[0]);
    case Intrinsic::Step: return f.select(f.less(x[1], x[0]), f.number(x[0], 0), f.number(x[0], 1));
    case Intrinsic::Smoothstep: return smoothstep(f, x[0], x[1], x[2]);
    case Intrinsic::Fma: return f.add(f.mul(x[0], x[1]), x[2]);
    case Intrinsic::Isnan: return f.differs(x[0], x[0]);
    case Intrinsic::Isinf: return f.isInfinite(x[0]);
    case Intrinsic::Isfinite: return f.isFinite(x[0]);
    case Intrinsic::FloatBitsToInt:
    case Intrinsic::FloatBitsToUint:
    case Intrinsic::AsInt:
    case Intrinsic::AsUint: return bitsOf(f, x[0]);
    case Intrinsic::IntBitsToFloat:
    case Intrinsic::UintBitsToFloat:
    case Intrinsic::AsFloatInt:
    case Intrinsic::AsFloatUint: return realOfBits(f, x[0]);
    case Intrinsic::Ldexp: return ldexp(f, x[0], x[1]);
    case Intrinsic::FrexpExponent: return frexpExponent(f, x[0]);
    case Intrinsic::FrexpMantissa: return frexpMantissa(f, x[0]);
    case Intrinsic::ModfFraction:
      return f.copySign(f.select(f.isInfinite(x[0]), f.number(x[0], 0), f.sub(x[0], f.trunc(x[0]))), x[0]);
    case Intrinsic::Nearest: return wholeIndex(f.l, f.floor(f.add(x[0], f.number(x[0], 0.5))));
    case Intrinsic::RoundedSum: return f.add(x[0], x[1]);
    case Intrinsic::RoundedProduct: return f.mul(x[0], x[1]);
    case Intrinsic::SumError: return sumError(f, x[0], x[1]);
    case Intrinsic::ProductError: return productError(f, x[0], x[1]);
    case Intrinsic::LessThan: return binary(f.l, BinaryOp::Less, scalar, x[0], x[1]);
    case Intrinsic::LessThanEqual: return binary(f.l, BinaryOp::LessEqual, scalar, x[0], x[1]);
    case Intrinsic::GreaterThan: return binary(f.l, BinaryOp::Greater, scalar, x[0], x[1]);
    case Intrinsic::GreaterThanEqual: return binary(f.l, BinaryOp::GreaterEqual, scalar, x[0], x[1]);
    case Intrinsic::EqualTo: return binary(f.l, BinaryOp::Equal, scalar, x[0], x[1]);
    case Intrinsic::NotEqualTo: return binary(f.l, BinaryOp::NotEqual, scalar, x[0], x[1]);
    default: break;
  }
  llvm_unreachable("no intrinsic of single components, or one of exact sums, which the runtime adds");
}

// ---- vectors and matrices -------------------------------------------------------------------------

Part dot(const Formula& f, const Parts& a, const Parts& c) {
  Part sum = f.mul(a[0], c[0]);
  for (std::size_t i = 1; i < a.size(); ++i) sum = f.add(sum, f.mul(a[i], c[i]));
  return sum;
}

Parts times(const Formula& f, const Parts& a, const Part& factor) {
  Parts result;
  for (const Part& part : a) result.push_back(f.mul(part, factor));
  return result;
}
Parts minus(const Formula& f, const Parts& a, const Parts& c) {
  Parts result;
  for (std::size_t i = 0; i < a.size(); ++i) result.push_back(f.sub(a[i], c[i]));
  return result;
}

Part largest(const Formula& f, const Parts& a) {
  Part most = f.abs(a[0]);
  for (std::size_t i = 1; i < a.size(); ++i) most = extreme(f, false, Scalar::Float, most, f.abs(a[i]));
  return most;
}

/// A power of 2 by which vectors with this largest component are multiplied, so that no square overflows or vanishes. All
/// of its values are in the range of float, whose powers of 2 they are.
Part lengthScale(const Formula& f, const Part& most) {
  const Part small =
      f.select(f.less(most, f.number(most, 0x1p-40)), f.number(most, 0x1p86), f.number(most, 1));
  const Part isLarge = binary(f.l, BinaryOp::GreaterEqual, Scalar::Float, most, f.number(most, 0x1p62));
  return f.select(isLarge, f.number(most, 0x1p-66), small);
}

Part length(const Formula& f, const Parts& a) {
  const Part most = largest(f, a);
  const Part scale = lengthScale(f, most);
  const Parts scaled = times(f, a, scale);
  return f.select(f.isInfinite(most), most, f.div(f.sqrt(dot(f, scaled, scaled)), scale));
}

/// Returns a zero vector unchanged.
Parts normalize(const Formula& f, const Parts& a) {
  const Parts scaled = times(f, a, lengthScale(f, largest(f, a)));
  const Part square = dot(f, scaled, scaled);
  const Part isZero = f.equal(square, f.number(square, 0));
  const Part root = f.sqrt(square);
  Parts result;
  for (std::size_t i = 0; i < a.size(); ++i) result.push_back(f.select(isZero, a[i], f.div(scaled[i], root)));
  return result;
}

Parts cross(const Formula& f, const Parts& a, const Parts& c) {
  const auto minor = [&](std::size_t i, std::size_t k) {
    return f.sub(f.mul(a[i], c[k]), f.mul(c[i], a[k]));
  };
  return {minor(1, 2), minor(2, 0), minor(0, 1)};
}

Parts faceforward(const Formula& f, const Parts& n, const Parts& i, const Parts& reference) {
  const Part product = dot(f, reference, i);
  const Part isAgainst = f.less(product, f.number(product, 0));
  Parts result;
  for (const Part& part : n) result.push_back(f.select(isAgainst, part, f.negate(part)));
  return result;
}

Parts reflect(const Formula& f, const Parts& i, const Parts& n) {
  const Part product = dot(f, n, i);
  return minus(f, i, times(f, n, f.mul(f.number(product, 2), product)));
}

Parts refract(const Formula& f, const Parts& i, const Parts& n, const Part& eta) {
  const Part d = dot(f, n, i);
  const Part one = f.number(d, 1);
  const Part k = f.sub(one, f.mul(f.mul(eta, eta), f.sub(one, f.mul(d, d))));
  const Part isTotal = f.less(k, f.number(d, 0));
  const Parts all = minus(f, times(f, i, eta), times(f, n, f.add(f.mul(eta, d), f.sqrt(k))));
  Parts result;
  for (const Part& part : all) result.push_back(f.select(isTotal, f.number(d, 0), part));
  return result;
}

/// A matrix of n rows, one after the other, without a row and a column.
Parts minorOf(const Parts& m, std::size_t n, std::size_t row, std::size_t column) {
  Parts part;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      if (i != row && k != column) part.push_back(m[i * n + k]);
    }
  }
  return part;
}

Part determinant(const Formula& f, const Parts& m, std::size_t n) {
  if (n == 1) return m[0];
  if (n == 2) return f.sub(f.mul(m[0], m[3]), f.mul(m[1], m[2]));
  Part sum = f.number(m[0], 0);
  for (std::size_t k = 0; k < n; ++k) {
    const Part term = f.mul(m[k], determinant(f, minorOf(m, n, 0, k), n - 1));
    sum = k % 2 == 0 ? f.add(sum, term) : f.sub(sum, term);
  }
  return sum;
}

/// By cofactors, as GLSL's implementations do; of a singular one, infinities and NaN.
Parts inverse(const Formula& f, const Parts& m, std::size_t n) {
  const Part d = determinant(f, m, n);
  Parts result(m.size());
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      const Part cofactor = determinant(f, minorOf(m, n, i, k), n - 1);
      result[k * n + i] = f.div((i + k) % 2 == 0 ? cofactor : f.negate(cofactor), d);
    }
  }
  return result;
}

Parts transpose(const Parts& m, std::size_t n) {
  Parts result;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) result.push_back(m[k * n + i]);
  }
  return result;
}

Part anyOrAll(const Formula& f, bool isAny, const Parts& parts) {
  Part result = parts[0];
  for (std::size_t i = 1; i < parts.size(); ++i) {
    result = isAny ? f.either(result, parts[i]) : f.both(result, parts[i]);
  }
  return result;
}

/// Component by component; a scalar serves for every one.
Parts byComponent(const Formula& f, Intrinsic intrinsic, const std::vector<IntrinsicArgument>& arguments) {
  std::size_t width = 1;
  for (const IntrinsicArgument& argument : arguments) width = std::max(width, argument.parts.size());
  Parts result;
  for (std::size_t i = 0; i < width; ++i) {
    std::vector<Part> x;
    for (const IntrinsicArgument& argument : arguments) {
      const Part& part = argument.parts[argument.parts.size() == 1 ? 0 : i];
      x.push_back({f.l.value(part)});
    }
    result.push_back(component(f, intrinsic, arguments[0].type.scalar, x));
  }
  return result;
}

}  // namespace

Parts intrinsic(Lanes& lanes, Intrinsic intrinsic, const std::vector<IntrinsicArgument>& arguments,
                const LibraryCall& library) {
  const Formula f(lanes, library);
  const auto parts = [&](std::size_t i) -> const Parts& { return arguments[i].parts; };
  const std::size_t width = arguments[0].type.width;
  switch (intrinsic) {
    case Intrinsic::Length: return {length(f, parts(0))};
    case Intrinsic::Distance: return {length(f, minus(f, parts(0), parts(1)))};
    case Intrinsic::Dot: return {dot(f, parts(0), parts(1))};
    case Intrinsic::Cross: return cross(f, parts(0), parts(1));
    case Intrinsic::Normalize: return normalize(f, parts(0));
    case Intrinsic::Faceforward: return faceforward(f, parts(0), parts(1), parts(2));
    case Intrinsic::Reflect: return reflect(f, parts(0), parts(1));
    case Intrinsic::Refract: return refract(f, parts(0), parts(1), parts(2)[0]);
    case Intrinsic::Transpose: return transpose(parts(0), width);
    case Intrinsic::Determinant: return {determinant(f, parts(0), width)};
    case Intrinsic::Inverse: return inverse(f, parts(0), width);
    case Intrinsic::Any: return {anyOrAll(f, true, parts(0))};
    case Intrinsic::All: return {anyOrAll(f, false, parts(0))};
    default: return byComponent(f, intrinsic, arguments);
  }
}

Part floorOf(Lanes& lanes, const Part& x) { return Formula(lanes, {}).floor(x); }

Part wholeIndex(Lanes& lanes, const Part& x) {
  constexpr double last = 2147483520;
  const Formula f(lanes, {});
  const Part isBeyond = binary(lanes, BinaryOp::Greater, Scalar::Float, x, f.number(x, last));
  const Part index = convert(lanes, Scalar::Float, Scalar::Int, x);
  return f.select(isBeyond, {lanes.integer(lanes.int32(), static_cast<std::int64_t>(last))}, index);
}

}  // namespace skc::native
