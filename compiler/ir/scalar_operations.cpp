// SPDX-License-Identifier: MIT
#include "ir/scalar_operations.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace skc::ir {
namespace {

std::optional<double> ofReals(BinaryOp op, double a, double b) {
  if (op == BinaryOp::Add) return a + b;
  if (op == BinaryOp::Sub) return a - b;
  if (op == BinaryOp::Mul) return a * b;
  if (op == BinaryOp::Div) return a / b;
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

}  // namespace

double wrapped(Scalar scalar, std::int64_t value) {
  switch (scalar) {
    case Scalar::Char: return static_cast<std::int8_t>(value);
    case Scalar::Uchar: return static_cast<std::uint8_t>(value);
    case Scalar::Short: return static_cast<std::int16_t>(value);
    case Scalar::Ushort: return static_cast<std::uint16_t>(value);
    case Scalar::Uint: return static_cast<std::uint32_t>(value);
    default: return static_cast<std::int32_t>(value);
  }
}

double valueOf(Scalar scalar, const Literal& literal) {
  switch (arithmeticScalar(scalar)) {
    case Scalar::Bool: return literal.bits != 0;
    case Scalar::Int: return static_cast<std::int32_t>(literal.bits);
    case Scalar::Uint: return literal.bits;
    case Scalar::Double: return std::bit_cast<double>(std::uint64_t{literal.high} << 32U | literal.bits);
    default: return std::bit_cast<float>(literal.bits);
  }
}

double converted(Scalar from, Scalar to, double value) {
  if (to == Scalar::Bool) return value != 0;
  const Scalar arithmetic = arithmeticScalar(to);
  if (isReal(arithmetic)) return value;
  if (isReal(arithmeticScalar(from))) {
    if (std::isnan(value)) return 0;
    const bool isSigned = arithmetic == Scalar::Int;
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
  return ofIntegers(op, scalar, static_cast<std::int64_t>(x), static_cast<std::int64_t>(y));
}

std::optional<double> computed(Intrinsic intrinsic, Scalar scalar, double x, double y, double z) {
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
    case Intrinsic::Isnan: return std::isnan(x);
    case Intrinsic::Isinf: return std::isinf(x);
    case Intrinsic::Isfinite: return std::isfinite(x);
    default: return std::nullopt;
  }
}

}  // namespace skc::ir
