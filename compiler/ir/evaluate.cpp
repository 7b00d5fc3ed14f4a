// SPDX-License-Identifier: MIT
#include "ir/evaluate.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include "ir/build.hpp"
#include "ir/operators.hpp"
#include "ir/scalar_operations.hpp"

namespace skc::ir {
namespace {

using Bits = std::optional<std::uint32_t>;

/// What the floats of a kernel's variant are.
enum class Floats : std::uint8_t { Half, Single, Double };

/// As scalar_operations.hpp represents scalars.
using Value = std::optional<double>;

std::uint32_t floatBitsOf(double value) { return std::bit_cast<std::uint32_t>(static_cast<float>(value)); }

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
Value ordinary(Floats floats, double value) {
  const double result = rounded(floats, value);
  return isOrdinary(floats, result) ? Value(result) : std::nullopt;
}

/// Doubles hold sums, products and quotients of floats precisely enough to be rounded once more.
Value binaryFloat(Floats floats, BinaryOp op, double a, double b) {
  if (!isOrdinary(floats, a) || !isOrdinary(floats, b) || (op == BinaryOp::Div && b == 0))
    return std::nullopt;
  const Value exact = computed(op, Scalar::Float, a, b);
  return exact && !isComparison(op) ? ordinary(floats, *exact) : exact;
}

/// False where devices may differ, although the language defines the result.
bool isPortable(BinaryOp op, double a, double b) {
  const bool divides = op == BinaryOp::Div || op == BinaryOp::Rem;
  const bool shifts = op == BinaryOp::ShiftLeft || op == BinaryOp::ShiftRight;
  if (divides) return b != 0 && !(a == std::numeric_limits<std::int32_t>::min() && b == -1);
  return !shifts || (b >= 0 && b < 32);
}

bool isOfFloats(Scalar scalar) { return arithmeticScalar(scalar) == Scalar::Float; }

Value convertedTo(Scalar to, Floats floats, Scalar from, double value) {
  if (from == to) return value;
  if (isNarrow(from)) return convertedTo(to, floats, arithmeticScalar(from), value);
  if (isNarrow(to)) {
    const Value number = convertedTo(arithmeticScalar(to), floats, from, value);
    if (!number) return std::nullopt;
    return isOfFloats(to) ? quantized(to, *number) : wrapped(to, static_cast<std::int64_t>(*number));
  }
  if (to == Scalar::Float) return ordinary(floats, value);
  const double result = converted(from, to, value);
  if (from != Scalar::Float || to == Scalar::Bool) return result;
  const bool isInRange = result == std::trunc(value);
  return isOrdinary(floats, value) && isInRange ? Value(result) : std::nullopt;
}

class Evaluator {
 public:
  Evaluator(const Module& module, Constants constants, Floats floats)
      : module_(module), constants_(constants), floats_(floats) {}

  /// The bits of the value; nullopt, too, for a value that no float is.
  Bits bits(const Expr& expr) const {
    const Value known = value(expr);
    if (!known) return std::nullopt;
    if (!isOfFloats(expr.type.scalar)) return static_cast<std::uint32_t>(static_cast<std::int64_t>(*known));
    const std::uint32_t bits = floatBitsOf(*known);
    return double{std::bit_cast<float>(bits)} == *known ? Bits(bits) : std::nullopt;
  }

  /// True if the value may depend on what floats are.
  bool hasSeenFloats() const { return hasSeenFloats_; }

 private:
  Value value(const Expr& expr) const {
    if (!expr.type.isScalar() || expr.type.is64Bit()) return std::nullopt;
    if (const auto* n = std::get_if<Literal>(&expr.node)) return literal(expr.type.scalar, *n);
    if (const auto* n = std::get_if<ConstantRef>(&expr.node)) {
      if (constants_ == Constants::Keep) return std::nullopt;
      return value(*module_.constants[n->constant].value);
    }
    if (const auto* n = std::get_if<Unary>(&expr.node)) return unary(*n);
    if (const auto* n = std::get_if<Binary>(&expr.node)) return binary(*n);
    if (const auto* n = std::get_if<Convert>(&expr.node)) {
      const Value operand = value(*n->operand);
      hasSeenFloats_ = hasSeenFloats_ || isOfFloats(expr.type.scalar);
      return operand ? convertedTo(expr.type.scalar, floats_, n->operand->type.scalar, *operand)
                     : std::nullopt;
    }
    if (const auto* n = std::get_if<Select>(&expr.node)) {
      const Value cond = value(*n->cond);
      return cond ? value(*cond != 0 ? *n->yes : *n->no) : std::nullopt;
    }
    return std::nullopt;
  }

  Value literal(Scalar scalar, const Literal& n) const {
    if (!isOfFloats(scalar)) return valueOf(scalar, n);
    hasSeenFloats_ = true;
    return isNarrow(scalar) || floats_ == Floats::Single ? valueOf(scalar, n)
                                                         : rounded(floats_, wideValue(n));
  }

  Value unary(const Unary& n) const {
    const Value operand = value(*n.operand);
    if (!operand) return std::nullopt;
    const double result = computed(n.op, n.operand->type.scalar, *operand);
    return n.operand->type.isFloat() ? ordinary(floats_, result) : Value(result);
  }

  Value binary(const Binary& n) const {
    if (!n.lhs->type.isScalar()) return std::nullopt;
    const Value a = value(*n.lhs);
    if (n.op == BinaryOp::LogicalAnd || n.op == BinaryOp::LogicalOr) return logical(n, a);
    const Value b = a ? value(*n.rhs) : std::nullopt;
    if (!a || !b) return std::nullopt;
    if (n.lhs->type.isFloat()) return binaryFloat(floats_, n.op, *a, *b);
    if (n.lhs->type.isBool() && !isComparison(n.op)) return std::nullopt;
    return isPortable(n.op, *a, *b) ? computed(n.op, n.lhs->type.scalar, *a, *b) : std::nullopt;
  }

  Value logical(const Binary& n, const Value& lhs) const {
    const double deciding = n.op == BinaryOp::LogicalOr ? 1 : 0;
    if (lhs == deciding) return lhs;
    const Value rhs = value(*n.rhs);
    if (rhs == deciding) return rhs;   // an operand without effects may be dropped
    return lhs && rhs ? Value(1 - deciding) : std::nullopt;
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
