// SPDX-License-Identifier: MIT
#include "native/intrinsic_functions.hpp"

#include <limits>
#include <string>

#include <llvm/IR/Constants.h>
#include <llvm/IR/Module.h>

namespace skc::native {

using namespace ir;

namespace {

Part extreme(const ScalarBuilder& f, bool isMin, Scalar scalar, const Part& x, const Part& y) {
  const BinaryOp before = isMin ? BinaryOp::Less : BinaryOp::Greater;
  if (!isReal(scalar)) {
    return f.select(binary(f.l, before, scalar, y, x), y, x);
  }
  Part a = x, c = y;
  f.l.unify(a, c);
  const Part isFirst = f.either(binary(f.l, before, scalar, a, c), f.differs(c, c));
  const Part ofEqual = isMin ? f.select(f.isNegative(a), a, c) : f.select(f.isNegative(a), c, a);
  return f.select(f.equal(a, c), ofEqual, f.select(isFirst, a, c));
}

/// The largest number below 1.
Part belowOne(const Part& x) {
  llvm::APFloat one(1.0);
  bool isInexact = false;
  one.convert(x.value->getType()->getScalarType()->getFltSemantics(), llvm::APFloat::rmNearestTiesToEven,
              &isInexact);
  one.next(/*nextDown=*/true);
  return {llvm::ConstantFP::get(x.value->getType()->getScalarType(), one)};
}

/// A number as the bits of a normal double.
struct DoubleBits {
  llvm::Value* word;
  llvm::Value* exponent;  ///< biased
  llvm::Value* isScaled;  ///< by 2^54, if it is subnormal; null if no number can be
};
DoubleBits doubleBits(const ScalarBuilder& f, const Part& x) {
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

/// True for zeros, infinities and NaN: frexp returns x itself and the exponent 0.
Part isWithoutExponent(const ScalarBuilder& f, const Part& x) {
  return f.either(f.equal(x, f.number(x, 0)), unary(f.l, UnaryOp::LogicalNot, Scalar::Bool, f.isFinite(x)));
}

/// Calls frexpq() or frexpl() lane by lane; returns the mantissa or the exponent.
Part quadFrexp(const ScalarBuilder& f, const Part& x, bool isExponent) {
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

}  // namespace

Part minimum(const ScalarBuilder& f, Scalar scalar, const Part& x, const Part& y) {
  return extreme(f, true, scalar, x, y);
}
Part maximum(const ScalarBuilder& f, Scalar scalar, const Part& x, const Part& y) {
  return extreme(f, false, scalar, x, y);
}

Part absolute(const ScalarBuilder& f, Scalar scalar, const Part& x) {
  if (isReal(scalar)) return f.abs(x);
  const Part zero = {f.l.constant(scalar, 0)};
  return f.select(binary(f.l, BinaryOp::Less, scalar, x, zero), unary(f.l, UnaryOp::Negate, scalar, x), x);
}

Part sign(const ScalarBuilder& f, Scalar scalar, const Part& x) {
  const auto constant = [&](int value) { return Part{f.l.constant(scalar, value)}; };
  const Part below = f.select(binary(f.l, BinaryOp::Less, scalar, x, constant(0)), constant(-1), constant(0));
  return f.select(binary(f.l, BinaryOp::Greater, scalar, x, constant(0)), constant(1), below);
}

Part fraction(const ScalarBuilder& f, const Part& x) {
  const Part rest = f.sub(x, f.floor(x));
  const Part inside =
      f.select(f.less(rest, f.number(x, 1)), rest, f.select(f.differs(rest, rest), rest, belowOne(x)));
  return f.select(f.isInfinite(x), f.number(x, std::numeric_limits<double>::quiet_NaN()), inside);
}

Part modulo(const ScalarBuilder& f, const Part& x, const Part& y) {
  const Part left = f.libm("fmod", {x, y});
  const Part zero = f.number(x, 0);
  Part a = f.less(left, zero), c = f.less(y, zero);
  const Part otherSign = binary(f.l, BinaryOp::BitXor, Scalar::Bool, a, c);
  return f.select(f.both(f.differs(left, zero), otherSign), f.add(left, y), left);
}

Part mix(const ScalarBuilder& f, const Part& x, const Part& y, const Part& t) {
  const Part between = f.add(f.mul(x, f.sub(f.number(t, 1), t)), f.mul(y, t));
  return f.select(f.equal(t, f.number(t, 0)), x, f.select(f.equal(t, f.number(t, 1)), y, between));
}

Part clamp(const ScalarBuilder& f, Scalar scalar, const Part& x, const Part& low, const Part& high) {
  return minimum(f, scalar, maximum(f, scalar, x, low), high);
}

Part smoothstep(const ScalarBuilder& f, const Part& low, const Part& high, const Part& x) {
  const Part t =
      clamp(f, Scalar::Float, f.div(f.sub(x, low), f.sub(high, low)), f.number(x, 0), f.number(x, 1));
  return f.mul(f.mul(t, t), f.sub(f.number(x, 3), f.mul(f.number(x, 2), t)));
}

Part bitsOf(const ScalarBuilder& f, const Part& x) {
  const Part narrow = {f.l.b.CreateFPCast(x.value, f.l.sameShape(x.value, f.l.b.getFloatTy()))};
  return {f.l.b.CreateBitCast(narrow.value, f.l.sameShape(x.value, f.l.int32()))};
}
Part realOfBits(const ScalarBuilder& f, const Part& x) {
  llvm::Value* const bits = f.l.value(x);
  llvm::Value* const value = f.l.b.CreateBitCast(bits, f.l.sameShape(bits, f.l.b.getFloatTy()));
  return {f.l.b.CreateFPCast(value, f.l.sameShape(bits, f.l.real()))};
}

Part frexpExponent(const ScalarBuilder& f, const Part& x) {
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

Part frexpMantissa(const ScalarBuilder& f, const Part& x) {
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

Part modfFraction(const ScalarBuilder& f, const Part& x) {
  const Part rest = f.select(f.isInfinite(x), f.number(x, 0), f.sub(x, f.trunc(x)));
  return f.copySign(rest, x);
}

Part ldexp(const ScalarBuilder& f, const Part& number, const Part& exponent) {
  Lanes& l = f.l;
  Part x = number, e = exponent;
  l.unify(x, e);
  if (!x.value->getType()->getScalarType()->isFloatTy()) {
    return f.libm("ldexp", {x, e});
  }
  // The product of any float and any power of 2 that matters to a float is exact in double.
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

namespace {

/// A number of bits as an int.
Part asInt(Lanes& l, llvm::Value* bits) {
  return {l.b.CreateZExtOrTrunc(bits, l.sameShape(bits, l.int32()))};
}

}  // namespace

Part bitCount(const ScalarBuilder& f, const Part& x) {
  return asInt(f.l, f.l.b.CreateUnaryIntrinsic(llvm::Intrinsic::ctpop, x.value));
}
Part leadingZeros(const ScalarBuilder& f, const Part& x) {
  return asInt(f.l, f.l.b.CreateBinaryIntrinsic(llvm::Intrinsic::ctlz, x.value, f.l.b.getFalse()));
}
Part trailingZeros(const ScalarBuilder& f, const Part& x) {
  return asInt(f.l, f.l.b.CreateBinaryIntrinsic(llvm::Intrinsic::cttz, x.value, f.l.b.getFalse()));
}

Part multiplyHigh(const ScalarBuilder& f, Scalar scalar, const Part& x, const Part& y) {
  Lanes& l = f.l;
  Part a = x, c = y;
  l.unify(a, c);
  const unsigned bits = row(scalar).bits;
  llvm::Type* const wide = l.sameShape(a.value, l.b.getIntNTy(2 * bits));
  const auto widened = [&](const Part& part) {
    return scalar == Scalar::Int || scalar == Scalar::Long ? l.b.CreateSExt(part.value, wide)
                                                           : l.b.CreateZExt(part.value, wide);
  };
  llvm::Value* const product = l.b.CreateMul(widened(a), widened(c));
  return {l.b.CreateTrunc(l.b.CreateLShr(product, bits), a.value->getType())};
}

Part sumError(const ScalarBuilder& f, const Part& a, const Part& c) {
  const Part s = f.add(a, c);
  const Part d = f.sub(s, a);
  return f.add(f.sub(a, f.sub(s, d)), f.sub(c, d));
}

Part productError(const ScalarBuilder& f, const Part& x, const Part& y) {
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
    error = f.libm("fma", {a, c, f.negate(p)});
  } else {
    error = {l.b.CreateIntrinsic(llvm::Intrinsic::fma, {type}, {a.value, c.value, f.negate(p).value})};
  }
  return f.select(f.isFinite(p), error, f.number(p, 0));
}

Part floorOf(Lanes& lanes, const Part& x) { return ScalarBuilder(lanes).floor(x); }

Part toIndex(Lanes& lanes, const Part& x) {
  constexpr double last = 2147483520;
  const ScalarBuilder f(lanes);
  const Part isBeyond = binary(lanes, BinaryOp::Greater, Scalar::Float, x, f.number(x, last));
  const Part index = convert(lanes, Scalar::Float, Scalar::Int, x);
  return f.select(isBeyond, {lanes.integer(lanes.int32(), static_cast<std::int64_t>(last))}, index);
}

namespace {

Parts times(const ScalarBuilder& f, const Parts& a, const Part& factor) {
  Parts result;
  for (const Part& part : a) result.push_back(f.mul(part, factor));
  return result;
}

Part largest(const ScalarBuilder& f, const Parts& a) {
  Part most = f.abs(a[0]);
  for (std::size_t i = 1; i < a.size(); ++i) most = maximum(f, Scalar::Float, most, f.abs(a[i]));
  return most;
}

/// Powers of 2: vectors whose largest component is below `small`, or at least `large` or `huge`, are multiplied by `up`,
/// `down` or `farDown`. Then no square overflows, none that counts underflows, and no component becomes denormal whose part
/// of the length is not: the largest is at least 1 where it was multiplied by less.
struct LengthScales {
  const char *small, *up, *large, *down, *huge, *farDown;
};

LengthScales lengthScales(const Part& part) {
  const llvm::Type* const type = part.value->getType()->getScalarType();
  if (type->isFloatTy()) return {"0x1p-40", "0x1p86", "0x1p62", "0x1p-34", "0x1p95", "0x1p-66"};
  if (type->isDoubleTy()) return {"0x1p-400", "0x1p600", "0x1p500", "0x1p-300", "0x1p750", "0x1p-600"};
  return {"0x1p-8000", "0x1p8500", "0x1p8000", "0x1p-5000", "0x1p12000", "0x1p-9000"};
}

/// The power of 2 by which to multiply a vector with this largest component.
Part lengthScale(const ScalarBuilder& f, const Part& most) {
  const LengthScales scales = lengthScales(most);
  const Part small =
      f.select(f.less(most, f.decimal(most, scales.small)), f.decimal(most, scales.up), f.number(most, 1));
  const auto isAtLeast = [&](const char* number) {
    return binary(f.l, BinaryOp::GreaterEqual, Scalar::Float, most, f.decimal(most, number));
  };
  const Part down =
      f.select(isAtLeast(scales.huge), f.decimal(most, scales.farDown), f.decimal(most, scales.down));
  return f.select(isAtLeast(scales.large), down, small);
}

/// An n by n matrix in row-major order, without one row and one column.
Parts minorOf(const Parts& m, std::size_t n, std::size_t row, std::size_t column) {
  Parts part;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      if (i != row && k != column) part.push_back(m[i * n + k]);
    }
  }
  return part;
}

Part anyOrAll(const ScalarBuilder& f, bool isAny, const Parts& parts) {
  Part result = parts[0];
  for (std::size_t i = 1; i < parts.size(); ++i) {
    result = isAny ? f.either(result, parts[i]) : f.both(result, parts[i]);
  }
  return result;
}

}  // namespace

Parts minus(const ScalarBuilder& f, const Parts& a, const Parts& c) {
  Parts result;
  for (std::size_t i = 0; i < a.size(); ++i) result.push_back(f.sub(a[i], c[i]));
  return result;
}

Part dot(const ScalarBuilder& f, const Parts& a, const Parts& c) {
  Part sum = f.mul(a[0], c[0]);
  for (std::size_t i = 1; i < a.size(); ++i) sum = f.add(sum, f.mul(a[i], c[i]));
  return sum;
}

Part length(const ScalarBuilder& f, const Parts& a) {
  const Part most = largest(f, a);
  const Part scale = lengthScale(f, most);
  const Parts scaled = times(f, a, scale);
  return f.select(f.isInfinite(most), most, f.div(f.sqrt(dot(f, scaled, scaled)), scale));
}

Parts normalize(const ScalarBuilder& f, const Parts& a) {
  const Parts scaled = times(f, a, lengthScale(f, largest(f, a)));
  const Part square = dot(f, scaled, scaled);
  const Part isZero = f.equal(square, f.number(square, 0));
  const Part root = f.sqrt(square);
  Parts result;
  for (std::size_t i = 0; i < a.size(); ++i) result.push_back(f.select(isZero, a[i], f.div(scaled[i], root)));
  return result;
}

Parts cross(const ScalarBuilder& f, const Parts& a, const Parts& c) {
  const auto minor = [&](std::size_t i, std::size_t k) {
    return f.sub(f.mul(a[i], c[k]), f.mul(c[i], a[k]));
  };
  return {minor(1, 2), minor(2, 0), minor(0, 1)};
}

Parts faceforward(const ScalarBuilder& f, const Parts& n, const Parts& i, const Parts& reference) {
  const Part product = dot(f, reference, i);
  const Part isAgainst = f.less(product, f.number(product, 0));
  Parts result;
  for (const Part& part : n) result.push_back(f.select(isAgainst, part, f.negate(part)));
  return result;
}

Parts reflect(const ScalarBuilder& f, const Parts& i, const Parts& n) {
  const Part product = dot(f, n, i);
  return minus(f, i, times(f, n, f.mul(f.number(product, 2), product)));
}

Parts refract(const ScalarBuilder& f, const Parts& i, const Parts& n, const Part& eta) {
  const Part d = dot(f, n, i);
  const Part one = f.number(d, 1);
  const Part k = f.sub(one, f.mul(f.mul(eta, eta), f.sub(one, f.mul(d, d))));
  const Part isTotal = f.less(k, f.number(d, 0));
  const Parts all = minus(f, times(f, i, eta), times(f, n, f.add(f.mul(eta, d), f.sqrt(k))));
  Parts result;
  for (const Part& part : all) result.push_back(f.select(isTotal, f.number(d, 0), part));
  return result;
}

Parts transpose(const Parts& m, std::size_t n) {
  Parts result;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) result.push_back(m[k * n + i]);
  }
  return result;
}

Part determinant(const ScalarBuilder& f, const Parts& m, std::size_t n) {
  if (n == 1) return m[0];
  if (n == 2) return f.sub(f.mul(m[0], m[3]), f.mul(m[1], m[2]));
  Part sum = f.number(m[0], 0);
  for (std::size_t k = 0; k < n; ++k) {
    const Part term = f.mul(m[k], determinant(f, minorOf(m, n, 0, k), n - 1));
    sum = k % 2 == 0 ? f.add(sum, term) : f.sub(sum, term);
  }
  return sum;
}

Parts inverse(const ScalarBuilder& f, const Parts& m, std::size_t n) {
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

Part anyOf(const ScalarBuilder& f, const Parts& parts) { return anyOrAll(f, true, parts); }
Part allOf(const ScalarBuilder& f, const Parts& parts) { return anyOrAll(f, false, parts); }

}  // namespace skc::native
