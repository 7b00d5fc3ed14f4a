// SPDX-License-Identifier: MIT
#include "ir/scalar_operations.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "ir/build.hpp"

namespace skc::ir {
namespace {

std::optional<double> ofReals(BinaryOp op, double a, double b) {
  if (op == BinaryOp::Add) return a + b;
  if (op == BinaryOp::Sub) return a - b;
  if (op == BinaryOp::Mul) return a * b;
  if (op == BinaryOp::Div) return a / b;
  return std::nullopt;
}

/// Operations on integers of 64 bits that are far below their limits: a result that a double may not represent is at least 2^53.
std::optional<double> ofLongs(BinaryOp op, double a, double b) {
  const auto x = static_cast<std::int64_t>(a), y = static_cast<std::int64_t>(b);
  if (op == BinaryOp::Add) return a + b;
  if (op == BinaryOp::Sub) return a - b;
  if (op == BinaryOp::Mul) return a * b;
  if (op == BinaryOp::Div) return static_cast<double>(y == 0 ? x : x / y);
  if (op == BinaryOp::Rem) return static_cast<double>(y == 0 ? 0 : x % y);
  if (op == BinaryOp::BitAnd) return static_cast<double>(x & y);
  if (op == BinaryOp::BitOr) return static_cast<double>(x | y);
  if (op == BinaryOp::BitXor) return static_cast<double>(x ^ y);
  if (op == BinaryOp::ShiftLeft) return std::ldexp(a, static_cast<int>(y & 63));
  if (op == BinaryOp::ShiftRight) return static_cast<double>(x >> (y & 63));
  return std::nullopt;
}

/// The product and the left shift keep the low 64 bits, which are more than any integer has.
std::optional<double> ofIntegers(BinaryOp op, Scalar scalar, std::int64_t a, std::int64_t b) {
  const auto low = [](std::int64_t value) { return static_cast<std::uint64_t>(value); };
  const auto number = [&](std::int64_t value) { return wrapped(scalar, value); };
  switch (op) {
    case BinaryOp::Add: return number(a + b);
    case BinaryOp::Sub: return number(a - b);
    case BinaryOp::Mul: return number(static_cast<std::int64_t>(low(a) * low(b)));
    case BinaryOp::Div: return number(b == 0 ? a : a / b);
    case BinaryOp::Rem: return number(b == 0 ? 0 : a % b);
    case BinaryOp::BitAnd: return number(a & b);
    case BinaryOp::BitOr: return number(a | b);
    case BinaryOp::BitXor: return number(a ^ b);
    case BinaryOp::ShiftLeft: return number(static_cast<std::int64_t>(low(a) << (b & 31)));
    case BinaryOp::ShiftRight: return number(a >> (b & 31));
    case BinaryOp::Less:
    case BinaryOp::LessEqual:
    case BinaryOp::Greater:
    case BinaryOp::GreaterEqual:
    case BinaryOp::Equal:
    case BinaryOp::NotEqual:
    case BinaryOp::LogicalAnd:
    case BinaryOp::LogicalOr: break;
  }
  return std::nullopt;
}

/// The 32 bits of an int or uint.
std::uint32_t bitsOfInteger(double value) {
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(value));
}

/// The upper 32 bits of the product of two ints or uints.
double highHalf(Scalar scalar, double x, double y) {
  if (scalar == Scalar::Uint)
    return static_cast<double>(std::uint64_t{bitsOfInteger(x)} * bitsOfInteger(y) >> 32U);
  return static_cast<double>(static_cast<std::int64_t>(x) * static_cast<std::int64_t>(y) >> 32);
}

}  // namespace

double wrapped(Scalar scalar, std::int64_t value) {
  switch (scalar) {
    case Scalar::Char: return static_cast<std::int8_t>(value);
    case Scalar::Uchar: return static_cast<std::uint8_t>(value);
    case Scalar::Short: return static_cast<std::int16_t>(value);
    case Scalar::Ushort: return static_cast<std::uint16_t>(value);
    case Scalar::Uint: return static_cast<std::uint32_t>(value);
    case Scalar::Long:
    case Scalar::Ulong: return static_cast<double>(value);
    default: return static_cast<std::int32_t>(value);
  }
}

bool isRepresentable(Scalar scalar, double value) {
  if (scalar != Scalar::Long && scalar != Scalar::Ulong) return true;
  return std::fabs(value) < 0x1p53 && (scalar == Scalar::Long || value >= 0);
}

double valueOf(Scalar scalar, const Literal& literal) {
  switch (arithmeticScalar(scalar)) {
    case Scalar::Bool: return literal.bits != 0;
    case Scalar::Int: return static_cast<std::int32_t>(literal.bits);
    case Scalar::Uint: return literal.bits;
    case Scalar::Long: return static_cast<double>(static_cast<std::int64_t>(literal.wide()));
    case Scalar::Ulong: return static_cast<double>(literal.wide());
    case Scalar::Double: return std::bit_cast<double>(literal.wide());
    default: return std::bit_cast<float>(literal.bits);
  }
}

double converted(Scalar from, Scalar to, double value) {
  if (to == Scalar::Bool) return value != 0;
  const Scalar arithmetic = arithmeticScalar(to);
  if (isReal(arithmetic)) return value;
  if (isReal(arithmeticScalar(from))) {
    if (std::isnan(value)) return 0;
    const bool isSigned = arithmetic == Scalar::Int || arithmetic == Scalar::Long;
    if (is64Bit(arithmetic)) return std::trunc(isSigned ? value : std::max(value, 0.0));
    value = isSigned ? std::clamp(value, -0x1p31, 0x1p31 - 1) : std::clamp(value, 0.0, 0x1p32 - 1);
  }
  return wrapped(to, static_cast<std::int64_t>(value));
}

double computed(UnaryOp op, Scalar scalar, double x) {
  switch (op) {
    case UnaryOp::Negate:
      return isReal(arithmeticScalar(scalar)) ? -x : wrapped(scalar, -static_cast<std::int64_t>(x));
    case UnaryOp::BitNot:
      return scalar == Scalar::Bool ? x == 0 : wrapped(scalar, ~static_cast<std::int64_t>(x));
    case UnaryOp::LogicalNot: break;
  }
  return x == 0;
}

std::optional<double> computed(BinaryOp op, Scalar scalar, double x, double y) {
  switch (op) {
    case BinaryOp::Less: return x < y;
    case BinaryOp::LessEqual: return x <= y;
    case BinaryOp::Greater: return x > y;
    case BinaryOp::GreaterEqual: return x >= y;
    case BinaryOp::Equal: return x == y;
    case BinaryOp::NotEqual: return x != y;
    case BinaryOp::LogicalAnd: return x != 0 && y != 0;
    case BinaryOp::LogicalOr: return x != 0 || y != 0;
    case BinaryOp::Add:
    case BinaryOp::Sub:
    case BinaryOp::Mul:
    case BinaryOp::Div:
    case BinaryOp::Rem:
    case BinaryOp::BitAnd:
    case BinaryOp::BitOr:
    case BinaryOp::BitXor:
    case BinaryOp::ShiftLeft:
    case BinaryOp::ShiftRight: break;
  }
  if (isReal(arithmeticScalar(scalar))) return ofReals(op, x, y);
  if (is64Bit(scalar)) return ofLongs(op, x, y);
  return ofIntegers(op, scalar, static_cast<std::int64_t>(x), static_cast<std::int64_t>(y));
}

std::optional<double> computed(Intrinsic intrinsic, Scalar scalar, double x, double y, double z) {
  if (intrinsic >= Intrinsic::Popcount && intrinsic <= Intrinsic::Mulhi && is64Bit(scalar))
    return std::nullopt;
  switch (intrinsic) {
    case Intrinsic::Abs:
    case Intrinsic::Fabs:
      return isReal(arithmeticScalar(scalar)) ? std::fabs(x)
                                              : wrapped(scalar, static_cast<std::int64_t>(std::fabs(x)));
    case Intrinsic::Sign: return x > 0 ? 1 : x < 0 ? -1 : 0;
    case Intrinsic::Floor: return std::floor(x);
    case Intrinsic::Ceil: return std::ceil(x);
    case Intrinsic::Trunc: return std::trunc(x);
    case Intrinsic::Round:
    case Intrinsic::RoundEven: return std::nearbyint(x);
    case Intrinsic::Fract:
    case Intrinsic::Frac: return x - std::floor(x);
    case Intrinsic::Min:
    case Intrinsic::Fmin: return std::fmin(x, y);
    case Intrinsic::Max:
    case Intrinsic::Fmax: return std::fmax(x, y);
    case Intrinsic::Clamp: return std::fmin(std::fmax(x, y), z);
    case Intrinsic::Saturate: return std::fmin(std::fmax(x, 0), 1);
    case Intrinsic::Step: return y < x ? 0 : 1;
    case Intrinsic::LessThan: return x < y;
    case Intrinsic::LessThanEqual: return x <= y;
    case Intrinsic::GreaterThan: return x > y;
    case Intrinsic::GreaterThanEqual: return x >= y;
    case Intrinsic::EqualTo: return x == y;
    case Intrinsic::NotEqualTo: return x != y;
    case Intrinsic::MixBool: return z != 0 ? y : x;
    case Intrinsic::Popcount: return std::popcount(bitsOfInteger(x));
    case Intrinsic::Clz: return std::countl_zero(bitsOfInteger(x));
    case Intrinsic::Ctz: return std::countr_zero(bitsOfInteger(x));
    case Intrinsic::Mulhi: return highHalf(scalar, x, y);
    case Intrinsic::Isnan: return std::isnan(x);
    case Intrinsic::Isinf: return std::isinf(x);
    case Intrinsic::Isfinite: return std::isfinite(x);
    default: return std::nullopt;
  }
}

namespace {

float nearestHalf(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const std::uint32_t magnitude = bits & 0x7fffffffU;
  if (magnitude > 0x7f800000U) return x;
  std::uint32_t rounded = (magnitude + 0xfffU + ((magnitude >> 13) & 1U)) & 0xffffe000U;
  if (rounded > 0x477fe000U) rounded = 0x7f800000U;
  if (magnitude < 0x38800000U) {   // half would be subnormal: a multiple of 2^-24
    const float steps = std::bit_cast<float>(magnitude) * 0x1p24F;
    rounded = std::bit_cast<std::uint32_t>(std::nearbyint(steps) * 0x1p-24F);
  }
  return std::bit_cast<float>((bits & 0x80000000U) | rounded);
}

float nearestNormalized(float x, float least, float scale) {
  if (std::isnan(x)) return 0;
  if (x <= least) return least;
  return x >= 1 ? 1.0F : std::nearbyint(x * scale) / scale;
}

}  // namespace

float normalizedScale(Scalar narrow) {
  assert(row(narrow).one > 0 && "not a normalized scalar");
  return row(narrow).one;
}

float roundedToOdd(double value) {
  const auto nearest = static_cast<float>(value);
  const auto bits = std::bit_cast<std::uint32_t>(nearest);
  if (std::isnan(value) || double{nearest} == value || (bits & 1U) != 0) return nearest;
  const bool isBeyond = std::fabs(double{nearest}) > std::fabs(value);
  return std::bit_cast<float>(isBeyond ? bits - 1 : bits + 1);
}

std::uint32_t quantize(Scalar narrow, const Literal& literal) {
  if (narrow != Scalar::Half) return quantize(narrow, literal.bits);
  return quantize(narrow, std::bit_cast<std::uint32_t>(roundedToOdd(wideValue(literal))));
}

std::uint32_t quantize(Scalar narrow, std::uint32_t bits) {
  const auto value = std::bit_cast<float>(bits);
  switch (narrow) {
    case Scalar::Char: return static_cast<std::uint32_t>(std::int32_t{static_cast<std::int8_t>(bits)});
    case Scalar::Short: return static_cast<std::uint32_t>(std::int32_t{static_cast<std::int16_t>(bits)});
    case Scalar::Uchar: return bits & 0xffU;
    case Scalar::Ushort: return bits & 0xffffU;
    case Scalar::Half: return std::bit_cast<std::uint32_t>(nearestHalf(value));
    case Scalar::Unorm8:
    case Scalar::Unorm16:
      return std::bit_cast<std::uint32_t>(nearestNormalized(value, 0, normalizedScale(narrow)));
    case Scalar::Snorm8:
    case Scalar::Snorm16:
      return std::bit_cast<std::uint32_t>(nearestNormalized(value, -1, normalizedScale(narrow)));
    case Scalar::Bool:
    case Scalar::Int:
    case Scalar::Uint:
    case Scalar::Float:
    case Scalar::Double:
    case Scalar::Long:
    case Scalar::Ulong: break;
  }
  assert(!"not a narrow scalar");
  return bits;
}

}  // namespace skc::ir
