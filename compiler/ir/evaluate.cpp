// SPDX-License-Identifier: MIT
#include "ir/evaluate.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include "ir/build.hpp"
#include "ir/quantize.hpp"
#include "support/overloaded.hpp"

namespace skc::ir {
namespace {

using Bits = std::optional<std::uint32_t>;

/// What the floats of a kernel's variant are.
enum class Floats : std::uint8_t { Half, Single, Double };

/// A value: `real` if its arithmetic type is float, else `bits`.
struct Value {
  std::uint32_t bits = 0;
  double real = 0;
};
using Known = std::optional<Value>;

Known ofBits(Bits bits) { return bits ? Known(Value{*bits}) : std::nullopt; }

std::uint32_t floatBitsOf(double value) { return std::bit_cast<std::uint32_t>(static_cast<float>(value)); }

std::int32_t asInt(std::uint32_t bits) { return static_cast<std::int32_t>(bits); }
Bits boolBits(bool value) { return value ? 1U : 0U; }

double quantized(Scalar narrow, double value) {
  const float rounded = narrow == Scalar::Half ? roundedToOdd(value) : static_cast<float>(value);
  return std::bit_cast<float>(quantize(narrow, std::bit_cast<std::uint32_t>(rounded)));
}

/// `value` rounded to what floats are.
double rounded(Floats floats, double value) {
  if (floats == Floats::Double) return value;
  return floats == Floats::Single ? static_cast<float>(value) : quantized(Scalar::Half, value);
}

/// True unless devices may flush the number to zero or compute with it in their own way.
bool isOrdinary(Floats floats, double value) {
  if (value == 0 || floats == Floats::Double) return value == 0 || std::isnormal(value);
  return floats == Floats::Single ? std::isnormal(static_cast<float>(value)) : std::isfinite(value);
}

/// The result of an operation.
Known ordinary(Floats floats, double value) {
  const double result = rounded(floats, value);
  return isOrdinary(floats, result) ? Known(Value{0, result}) : std::nullopt;
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

/// Doubles hold sums, products and quotients of floats precisely enough to be rounded once more.
Known binaryFloat(Floats floats, BinaryOp op, double a, double b) {
  if (!isOrdinary(floats, a) || !isOrdinary(floats, b)) return std::nullopt;
  if (op == BinaryOp::Add) return ordinary(floats, a + b);
  if (op == BinaryOp::Sub) return ordinary(floats, a - b);
  if (op == BinaryOp::Mul) return ordinary(floats, a * b);
  if (op == BinaryOp::Div) return b == 0 ? std::nullopt : ordinary(floats, a / b);
  return ofBits(compare(op, a, b));
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

Known toInteger(Scalar to, double value) {
  const double whole = std::trunc(value);
  if (to == Scalar::Int && whole >= -0x1p31 && whole < 0x1p31)
    return Value{static_cast<std::uint32_t>(static_cast<std::int32_t>(whole))};
  if (to == Scalar::Uint && whole >= 0 && whole < 0x1p32) return Value{static_cast<std::uint32_t>(whole)};
  return std::nullopt;
}

bool isOfFloats(Scalar scalar) { return arithmeticScalar(scalar) == Scalar::Float; }

Known converted(Floats floats, Scalar from, Scalar to, Value value) {
  if (isNarrow(from)) {
    return from == to ? Known(value) : converted(floats, arithmeticScalar(from), to, value);
  }
  if (isNarrow(to)) {
    const Known whole =
        from == arithmeticScalar(to) ? Known(value) : converted(floats, from, arithmeticScalar(to), value);
    if (!whole) return std::nullopt;
    return isOfFloats(to) ? Value{0, quantized(to, whole->real)} : Value{quantize(to, whole->bits)};
  }
  if (from == to) return value;
  if (to == Scalar::Bool)
    return Value{static_cast<std::uint32_t>(from == Scalar::Float ? value.real != 0 : value.bits != 0)};
  if (from == Scalar::Float) return isOrdinary(floats, value.real) ? toInteger(to, value.real) : std::nullopt;
  if (to != Scalar::Float) return value;
  return ordinary(
      floats, from == Scalar::Int ? static_cast<double>(asInt(value.bits)) : static_cast<double>(value.bits));
}

class Evaluator {
 public:
  Evaluator(const Module& module, Constants constants, Floats floats)
      : module_(module), constants_(constants), floats_(floats) {}

  /// The bits of the value; nullopt, too, for a value that no float is.
  Bits bits(const Expr& expr) const {
    const Known known = value(expr);
    if (!known) return std::nullopt;
    if (!isOfFloats(expr.type.scalar)) return known->bits;
    const std::uint32_t bits = floatBitsOf(known->real);
    return double{std::bit_cast<float>(bits)} == known->real ? Bits(bits) : std::nullopt;
  }

  /// True if the value may depend on what floats are.
  bool hasSeenFloats() const { return hasSeenFloats_; }

 private:
  Known value(const Expr& expr) const {
    if (!expr.type.isScalar() || expr.type.scalar == Scalar::Double) return std::nullopt;
    if (const auto* n = std::get_if<Literal>(&expr.node)) return literal(expr.type.scalar, *n);
    if (const auto* n = std::get_if<ConstantRef>(&expr.node)) {
      if (constants_ == Constants::Keep) return std::nullopt;
      return value(*module_.constants[n->constant].value);
    }
    if (const auto* n = std::get_if<Unary>(&expr.node)) return unary(*n);
    if (const auto* n = std::get_if<Binary>(&expr.node)) return binary(*n);
    if (const auto* n = std::get_if<Convert>(&expr.node)) {
      const Known operand = value(*n->operand);
      hasSeenFloats_ = hasSeenFloats_ || isOfFloats(expr.type.scalar);
      return operand ? converted(floats_, n->operand->type.scalar, expr.type.scalar, *operand) : std::nullopt;
    }
    if (const auto* n = std::get_if<Select>(&expr.node)) {
      const Known cond = value(*n->cond);
      return cond ? value(cond->bits != 0 ? *n->yes : *n->no) : std::nullopt;
    }
    return std::nullopt;
  }

  Known literal(Scalar scalar, const Literal& n) const {
    if (!isOfFloats(scalar)) return Value{n.bits};
    hasSeenFloats_ = true;
    if (isNarrow(scalar) || floats_ == Floats::Single) return Value{0, std::bit_cast<float>(n.bits)};
    return Value{0, rounded(floats_, wideValue(n))};
  }

  Known unary(const Unary& n) const {
    const Known operand = value(*n.operand);
    if (!operand) return std::nullopt;
    switch (n.op) {
      case UnaryOp::Negate:
        return n.operand->type.isFloat() ? ordinary(floats_, -operand->real)
                                         : Known(Value{0U - operand->bits});
      case UnaryOp::BitNot: return Value{~operand->bits};
      case UnaryOp::LogicalNot: break;
    }
    return Value{operand->bits == 0 ? 1U : 0U};
  }

  Known binary(const Binary& n) const {
    if (!n.lhs->type.isScalar()) return std::nullopt;
    const Known a = value(*n.lhs);
    if (n.op == BinaryOp::LogicalAnd || n.op == BinaryOp::LogicalOr) return logical(n, a);
    const Known b = a ? value(*n.rhs) : std::nullopt;
    if (!a || !b) return std::nullopt;
    if (n.lhs->type.isFloat()) return binaryFloat(floats_, n.op, a->real, b->real);
    if (n.lhs->type.isBool()) return ofBits(compare(n.op, a->bits, b->bits));
    return ofBits(binaryInteger(n.op, n.lhs->type.scalar == Scalar::Int, a->bits, b->bits));
  }

  Known logical(const Binary& n, const Known& lhs) const {
    const std::uint32_t deciding = n.op == BinaryOp::LogicalOr ? 1 : 0;
    if (lhs && lhs->bits == deciding) return lhs;
    const Known rhs = value(*n.rhs);
    if (rhs && rhs->bits == deciding) return rhs;   // an operand without effects may be dropped
    return lhs && rhs ? Known(Value{1 - deciding}) : std::nullopt;
  }

  const Module& module_;
  Constants constants_;
  Floats floats_;
  mutable bool hasSeenFloats_ = false;
};

}  // namespace

std::optional<std::uint32_t> evaluate(const Module& module, const Expr& expr, Constants constants) {
  const Evaluator single(module, constants, Floats::Single);
  const Bits bits = single.bits(expr);
  if (!single.hasSeenFloats()) return bits;
  for (const Floats floats : {Floats::Half, Floats::Double}) {
    if (bits && Evaluator(module, constants, floats).bits(expr) != bits) return std::nullopt;
  }
  return bits;
}

std::optional<std::uint32_t> evaluateInFloat(const Module& module, const Expr& expr, Constants constants) {
  return Evaluator(module, constants, Floats::Single).bits(expr);
}

}  // namespace skc::ir
