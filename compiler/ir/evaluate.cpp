// SPDX-License-Identifier: MIT
#include "ir/evaluate.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include "ir/quantize.hpp"
#include "support/overloaded.hpp"

namespace skc::ir {
namespace {

using Bits = std::optional<std::uint32_t>;

float asFloat(std::uint32_t bits) { return std::bit_cast<float>(bits); }
std::int32_t asInt(std::uint32_t bits) { return static_cast<std::int32_t>(bits); }
Bits boolBits(bool value) { return value ? 1U : 0U; }

bool isOrdinary(float value) { return value == 0 || std::isnormal(value); }

Bits floatBits(float value) {
  if (!isOrdinary(value)) return std::nullopt;
  return std::bit_cast<std::uint32_t>(value);
}

template <class T>
Bits compare(BinaryOp op, T a, T b) {
  switch (op) {
    case BinaryOp::Less: return boolBits(a < b);
    case BinaryOp::LessEqual: return boolBits(a <= b);
    case BinaryOp::Greater: return boolBits(a > b);
    case BinaryOp::GreaterEqual: return boolBits(a >= b);
    case BinaryOp::Equal: return boolBits(a == b);
    case BinaryOp::NotEqual: return boolBits(a != b);
    case BinaryOp::Add:
    case BinaryOp::Sub:
    case BinaryOp::Mul:
    case BinaryOp::Div:
    case BinaryOp::Rem:
    case BinaryOp::BitAnd:
    case BinaryOp::BitOr:
    case BinaryOp::BitXor:
    case BinaryOp::ShiftLeft:
    case BinaryOp::ShiftRight:
    case BinaryOp::LogicalAnd:
    case BinaryOp::LogicalOr: break;
  }
  return std::nullopt;
}

Bits binaryFloat(BinaryOp op, float a, float b) {
  if (!isOrdinary(a) || !isOrdinary(b)) return std::nullopt;
  if (op == BinaryOp::Add) return floatBits(a + b);
  if (op == BinaryOp::Sub) return floatBits(a - b);
  if (op == BinaryOp::Mul) return floatBits(a * b);
  if (op == BinaryOp::Div) return b == 0 ? std::nullopt : floatBits(a / b);
  return compare(op, a, b);
}

/// Division and right shift, which differ between int and uint.
Bits divideInt(BinaryOp op, std::int32_t a, std::int32_t b) {
  if (b == 0 || (a == std::numeric_limits<std::int32_t>::min() && b == -1)) return std::nullopt;
  return static_cast<std::uint32_t>(op == BinaryOp::Div ? a / b : a % b);
}

Bits divideUint(BinaryOp op, std::uint32_t a, std::uint32_t b) {
  if (b == 0) return std::nullopt;
  return op == BinaryOp::Div ? a / b : a % b;
}

Bits binaryInteger(BinaryOp op, bool isSigned, std::uint32_t a, std::uint32_t b) {
  switch (op) {
    case BinaryOp::Add: return a + b;
    case BinaryOp::Sub: return a - b;
    case BinaryOp::Mul: return a * b;
    case BinaryOp::Div:
    case BinaryOp::Rem: return isSigned ? divideInt(op, asInt(a), asInt(b)) : divideUint(op, a, b);
    case BinaryOp::BitAnd: return a & b;
    case BinaryOp::BitOr: return a | b;
    case BinaryOp::BitXor: return a ^ b;
    case BinaryOp::ShiftLeft: return b < 32 ? Bits(a << b) : std::nullopt;
    case BinaryOp::ShiftRight:
      if (b >= 32) return std::nullopt;
      return isSigned ? static_cast<std::uint32_t>(asInt(a) >> b) : a >> b;
    case BinaryOp::Less:
    case BinaryOp::LessEqual:
    case BinaryOp::Greater:
    case BinaryOp::GreaterEqual:
    case BinaryOp::Equal:
    case BinaryOp::NotEqual: return isSigned ? compare(op, asInt(a), asInt(b)) : compare(op, a, b);
    case BinaryOp::LogicalAnd:
    case BinaryOp::LogicalOr: break;
  }
  return std::nullopt;
}

Bits fromFloat(Scalar to, float value) {
  if (!isOrdinary(value)) return std::nullopt;
  const double whole = std::trunc(static_cast<double>(value));
  if (to == Scalar::Int && whole >= -0x1p31 && whole < 0x1p31) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(whole));
  }
  if (to == Scalar::Uint && whole >= 0 && whole < 0x1p32) return static_cast<std::uint32_t>(whole);
  return std::nullopt;
}

Bits convertBits(Scalar from, Scalar to, std::uint32_t bits) {
  if (isNarrow(from)) return from == to ? Bits(bits) : convertBits(arithmeticScalar(from), to, bits);
  if (isNarrow(to)) {
    const Bits converted =
        from == arithmeticScalar(to) ? Bits(bits) : convertBits(from, arithmeticScalar(to), bits);
    return converted ? Bits(quantize(to, *converted)) : std::nullopt;
  }
  if (from == to) return bits;
  if (to == Scalar::Bool) return boolBits(from == Scalar::Float ? asFloat(bits) != 0 : bits != 0);
  if (from == Scalar::Float) return fromFloat(to, asFloat(bits));
  if (to != Scalar::Float) return bits;
  return floatBits(from == Scalar::Int ? static_cast<float>(asInt(bits)) : static_cast<float>(bits));
}

class Evaluator {
 public:
  Evaluator(const Module& module, Constants constants) : module_(module), constants_(constants) {}

  Bits value(const Expr& expr) const {
    if (!expr.type.isScalar() || expr.type.scalar == Scalar::Double) return std::nullopt;
    if (const auto* n = std::get_if<Literal>(&expr.node)) return n->bits;
    if (const auto* n = std::get_if<ConstantRef>(&expr.node)) {
      if (constants_ == Constants::Keep) return std::nullopt;
      return value(*module_.constants[n->constant].value);
    }
    if (const auto* n = std::get_if<Unary>(&expr.node)) return unary(*n);
    if (const auto* n = std::get_if<Binary>(&expr.node)) return binary(*n);
    if (const auto* n = std::get_if<Convert>(&expr.node)) {
      const Bits operand = value(*n->operand);
      return operand ? convertBits(n->operand->type.scalar, expr.type.scalar, *operand) : std::nullopt;
    }
    if (const auto* n = std::get_if<Select>(&expr.node)) {
      const Bits cond = value(*n->cond);
      return cond ? value(*cond != 0 ? *n->yes : *n->no) : std::nullopt;
    }
    return std::nullopt;
  }

 private:
  Bits unary(const Unary& n) const {
    const Bits operand = value(*n.operand);
    if (!operand) return std::nullopt;
    switch (n.op) {
      case UnaryOp::Negate:
        return n.operand->type.isFloat() ? floatBits(-asFloat(*operand)) : Bits(0U - *operand);
      case UnaryOp::BitNot: return ~*operand;
      case UnaryOp::LogicalNot: break;
    }
    return boolBits(*operand == 0);
  }

  Bits binary(const Binary& n) const {
    if (!n.lhs->type.isScalar()) return std::nullopt;
    const Bits a = value(*n.lhs);
    if (n.op == BinaryOp::LogicalAnd || n.op == BinaryOp::LogicalOr) return logical(n, a);
    const Bits b = a ? value(*n.rhs) : std::nullopt;
    if (!a || !b) return std::nullopt;
    if (n.lhs->type.isFloat()) return binaryFloat(n.op, asFloat(*a), asFloat(*b));
    if (n.lhs->type.isBool()) return compare(n.op, *a, *b);
    return binaryInteger(n.op, n.lhs->type.scalar == Scalar::Int, *a, *b);
  }

  Bits logical(const Binary& n, Bits lhs) const {
    const std::uint32_t deciding = n.op == BinaryOp::LogicalOr ? 1 : 0;
    if (lhs == deciding) return deciding;
    const Bits rhs = value(*n.rhs);
    if (rhs == deciding) return deciding;   // an operand without effects may be dropped
    return lhs && rhs ? Bits(1 - deciding) : std::nullopt;
  }

  const Module& module_;
  Constants constants_;
};

}  // namespace

std::optional<std::uint32_t> evaluate(const Module& module, const Expr& expr, Constants constants) {
  return Evaluator(module, constants).value(expr);
}

}  // namespace skc::ir
