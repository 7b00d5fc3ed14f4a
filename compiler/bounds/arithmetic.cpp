// SPDX-License-Identifier: MIT
#include "bounds/arithmetic.hpp"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "ir/build.hpp"
#include "ir/scalar_operations.hpp"
#include "sk/error_bounds.hpp"
#include "support/text.hpp"

namespace skc::bounds {
namespace {

using ir::Scalar;

/// Errors of pairs of floats are 2^-44 of the result (docs/accuracy.md, Precision). Below 3e-24 they have the error of denormals.
constexpr Format pairFormat = {0x1p-44, 0x1p-126, 0x1.fffffep127, /*isRelative=*/true, /*flushes=*/true};

/// What ARB_shader_precision allows for quotients and roots, in units in the last place.
constexpr double shaderUnits = 2.5;
/// Halves have half a unit of their own, and 2.5 units of a float.
constexpr double halfUnits = 0.5007;

Integer integerOf(Scalar type) {
  return type == Scalar::Int ? Integer::Signed : type == Scalar::Uint ? Integer::Unsigned : Integer::No;
}

/// How far a double is from the decimal number that its shortest text says, at most.
double decimalError(double value) {
  if (std::fabs(value) >= 0x1p53 || std::floor(value) == value) return 0;
  const long double text = std::strtold(shortestDouble(value).c_str(), nullptr);
  const auto error = static_cast<double>(std::fabs(text - static_cast<long double>(value)));
  // A long double has 11 more bits.
  return error == 0 ? 0 : roundedUp(error + std::fabs(value) * 0x1p-63);
}

double halfOf(double value) {
  return std::bit_cast<float>(
      ir::quantize(Scalar::Half, std::bit_cast<std::uint32_t>(ir::roundedToOdd(value))));
}

}  // namespace

// ---- formats and roundings ------------------------------------------------------------------------

bool Arithmetic::isPair(Scalar type) const {
  return type == Scalar::Float && options_.precision == Precision::Extended && !isNative();
}

Format Arithmetic::formatOf(Scalar type) const {
  Format format = doubleFormat;
  if (type == Scalar::Float && options_.precision == Precision::Single) format = floatFormat;
  if (type == Scalar::Float && options_.precision == Precision::Half) format = halfFormat;
  if (isPair(type)) return pairFormat;
  // Halves are computed as floats, which have no denormal halves.
  format.flushes = !isNative() && format.unit != halfFormat.unit;
  return format;
}

Rounding Arithmetic::nearest(Scalar type) const {
  if (!ir::isReal(type)) return {};
  return {.kind = Rounding::Kind::Nearest, .format = formatOf(type)};
}

Rounding Arithmetic::units(Scalar type, double amount) const {
  return {.kind = Rounding::Kind::Units, .format = formatOf(type), .amount = amount};
}

/// From the table of bounds that docs/accuracy.md shows.
Rounding Arithmetic::roundingOf(Scalar type, std::string_view function) const {
  const bool isDouble = type == Scalar::Double || options_.precision == Precision::Double ||
                        (options_.precision == Precision::Extended && isNative());
  const auto code = isNative() ? sk::BoundedCode::Native : sk::BoundedCode::Glsl;
  const auto bounded = isPair(type) ? sk::BoundedType::Pair
                       : isDouble   ? sk::BoundedType::Double
                                    : sk::BoundedType::Float;
  const sk::ErrorBound* const bound = sk::errorBoundOf(function, bounded, code);
  if (bound == nullptr)
    throw NotBounded(fmt::format("no bound of the error of '{}' is known", function), loc_);
  if (bounded == sk::BoundedType::Float) {
    Format format = floatFormat;
    format.flushes = !isNative();
    return {.kind = Rounding::Kind::Units, .format = format, .amount = bound->bound};
  }
  if (isNative()) return units(type, bound->bound);
  // Relative, in units of 2^-53.
  Format format = bounded == sk::BoundedType::Pair ? pairFormat : formatOf(type);
  format.isRelative = true;
  format.unit = 0x1p-53;
  return {.kind = Rounding::Kind::Units, .format = format, .amount = bound->bound / 2};
}

NodeId Arithmetic::add(Node node) {
  node.loc = loc_;
  return graph_.add(node);
}

NodeId Arithmetic::rounded(const Format& format, NodeId x) {
  return add({.op = Op::Round,
              .operands = {x, noNode, noNode},
              .rounding = {.kind = Rounding::Kind::Nearest, .format = format}});
}

/// What precision=half keeps of a result that was computed in floats.
NodeId Arithmetic::toHalf(Scalar type, NodeId x) {
  return type == Scalar::Float && options_.precision == Precision::Half ? rounded(halfFormat, x) : x;
}

// ---- operations -----------------------------------------------------------------------------------

NodeId Arithmetic::basic(Op op, Scalar type, NodeId x, NodeId y) {
  Node node{.op = op, .operands = {x, y, noNode}, .rounding = nearest(type)};
  node.integer = integerOf(type);
  return add(node);
}

NodeId Arithmetic::divide(Scalar type, NodeId x, NodeId y) {
  if (!ir::isReal(type)) {
    Node quotient{.op = Op::Divide, .operands = {x, y, noNode}};
    Node node{.op = Op::Truncate, .operands = {add(quotient), noNode, noNode}};
    node.integer = integerOf(type);
    return add(node);
  }
  const bool isHalf = options_.precision == Precision::Half;
  if (isNative() || type != Scalar::Float || (!isHalf && options_.precision != Precision::Single))
    return basic(Op::Divide, type, x, y);
  const double amount = isHalf ? halfUnits : shaderUnits;
  return add({.op = Op::Divide, .operands = {x, y, noNode}, .rounding = units(type, amount)});
}

NodeId Arithmetic::negate(Scalar type, NodeId x) {
  Node node{.op = Op::Negate, .operands = {x, noNode, noNode}};
  node.integer = integerOf(type);
  return add(node);
}

NodeId Arithmetic::absolute(Scalar type, NodeId x) {
  Node node{.op = Op::Absolute, .operands = {x, noNode, noNode}};
  node.integer = integerOf(type);
  return add(node);
}

NodeId Arithmetic::multiplyAdd(Scalar type, NodeId x, NodeId y, NodeId z) {
  // In halves, it is rounded to a float first.
  const bool isHalf = type == Scalar::Float && options_.precision == Precision::Half;
  return add({.op = Op::MultiplyAdd,
              .operands = {x, y, z},
              .rounding = isHalf ? units(type, 0.501) : nearest(type)});
}

NodeId Arithmetic::minimum(Scalar type, NodeId x, NodeId y) {
  Node node{.op = Op::Min, .operands = {x, y, noNode}};
  node.integer = integerOf(type);
  return add(node);
}

NodeId Arithmetic::maximum(Scalar type, NodeId x, NodeId y) {
  Node node{.op = Op::Max, .operands = {x, y, noNode}};
  node.integer = integerOf(type);
  return add(node);
}

NodeId Arithmetic::call(Scalar type, UnaryFunction function, NodeId x) {
  Node node{.op = Op::Call, .function = function, .operands = {x, noNode, noNode}};
  if (function == UnaryFunction::Sqrt || function == UnaryFunction::InverseSqrt) {
    const bool isFloat = type == Scalar::Float && options_.precision == Precision::Single;
    const bool isHalf = type == Scalar::Float && options_.precision == Precision::Half;
    if (function == UnaryFunction::InverseSqrt && (isNative() || !isFloat)) {
      // As native code has it: a quotient by the root.
      return divide(type, number(1), call(type, UnaryFunction::Sqrt, x));
    }
    // A device's root of a double is within a unit.
    const double amount = isFloat ? shaderUnits : isHalf ? halfUnits : 1;
    node.rounding = isNative() || isPair(type) ? nearest(type) : units(type, amount);
    return add(node);
  }
  node.rounding = roundingOf(type, spelling(function));
  return toHalf(type, add(node));
}

NodeId Arithmetic::call(Scalar type, BinaryFunction function, NodeId x, NodeId y) {
  constexpr const char* names[] = {"pow", "atan2", "hypot"};
  const auto number = static_cast<std::size_t>(function);
  return toHalf(type, add({.op = Op::Call2,
                           .function2 = function,
                           .operands = {x, y, noNode},
                           .rounding = roundingOf(type, names[number])}));
}

NodeId Arithmetic::step(Op op, Scalar type, NodeId x) {
  Node node{.op = op, .operands = {x, noNode, noNode}};
  node.integer = integerOf(type);
  return add(node);
}

NodeId Arithmetic::remainder(Scalar type, NodeId x, NodeId y, Op rounded) {
  const NodeId quotient = add({.op = Op::Divide, .operands = {x, y, noNode}});
  const NodeId whole = step(rounded, type, quotient);
  Node product{.op = Op::Multiply, .operands = {y, whole, noNode}};
  Node difference{.op = Op::Subtract, .operands = {x, add(product), noNode}};
  difference.integer = integerOf(type);
  if (rounded == Op::Floor)
    difference.rounding = nearest(type);  // fmod is exact, and mod adds the divisor to it
  return add(difference);
}

NodeId Arithmetic::fraction(Scalar type, NodeId x) {
  return add(
      {.op = Op::Subtract, .operands = {x, step(Op::Floor, type, x), noNode}, .rounding = units(type, 1)});
}

NodeId Arithmetic::compare(Op op, NodeId x, NodeId y) { return add({.op = op, .operands = {x, y, noNode}}); }

// ---- numbers --------------------------------------------------------------------------------------

NodeId Arithmetic::number(Scalar type, double value) { return graph_.constant(value, {}, integerOf(type)); }

NodeId Arithmetic::read(Scalar type, std::string name, Interval range) {
  const bool isInteger = !ir::isReal(type);
  const bool isHalf = type == Scalar::Float && options_.precision == Precision::Half;
  if (range.isPoint() && !options_.inputsAreReal) {
    // The device gets a float.
    const double given =
        type == Scalar::Float ? static_cast<double>(static_cast<float>(range.low)) : range.low;
    const double error = isHalf ? std::fabs(halfOf(given) - given) : 0;
    if (error > 0)
      return graph_.constant(given, {.kind = Rounding::Kind::Absolute, .amount = roundedUp(error)});
    return number(type, given);
  }
  Rounding rounding;
  if (!isInteger) {
    if (isHalf || options_.inputsAreReal) {
      rounding = nearest(type);
    } else if (!isNative()) {
      // A device may take a denormal number for 0; all others it has exactly.
      rounding = nearest(type);
      rounding.isScaling = true;
    }
  }
  Input input;
  input.name = std::move(name);
  input.range = range;
  input.isInteger = isInteger;
  return graph_.input(std::move(input), rounding, integerOf(type));
}

NodeId Arithmetic::literal(Scalar type, const ir::Literal& literal) {
  if (!ir::isReal(type)) return number(type, ir::valueOf(type, literal));
  double exact, held;
  if (type == Scalar::Double) {
    exact = held = ir::valueOf(type, literal);
  } else {
    exact = ir::wideValue(literal);
    held = ir::valueOf(type, literal);
    if (options_.precision == Precision::Half) held = halfOf(exact);
    if (options_.precision == Precision::Double || options_.precision == Precision::Extended) held = exact;
  }
  double error = std::fabs(exact - held);
  if (isPair(type) && exact != std::bit_cast<float>(literal.bits)) error = std::fabs(exact) * 0x1p-44;
  if (options_.literalsAreDecimal) error = sumUp(error, decimalError(exact));
  if (error == 0) return number(exact);
  return graph_.constant(exact, {.kind = Rounding::Kind::Absolute, .amount = roundedUp(error)});
}

NodeId Arithmetic::convert(Scalar from, Scalar to, NodeId x) {
  if (from == to) return x;
  if (to == Scalar::Bool) return graph_.negation(equal(x, number(0)));
  if (from == Scalar::Bool) return select(x, number(to, 1), number(to, 0));
  const Scalar wide = ir::arithmeticScalar(to);
  if (ir::isNarrow(to)) return stored(to, x);
  if (ir::isReal(wide)) {
    // A float in a variant that computes in doubles is a double.
    const bool isWidening = from == Scalar::Float && to == Scalar::Double;
    const bool isSame =
        ir::arithmeticScalar(from) == to || (ir::isReal(from) && formatOf(from) == formatOf(to));
    if (isWidening || isSame) return x;
    return rounded(formatOf(to), x);
  }
  if (!ir::isReal(ir::arithmeticScalar(from))) {
    if (graph_.isExact(x)) return number(to, ir::converted(from, to, graph_[x].value));
    Node node{.op = Op::Round, .operands = {x, noNode, noNode}};
    node.integer = integerOf(to);
    return add(node);
  }
  return step(Op::Truncate, to, x);
}

NodeId Arithmetic::stored(Scalar type, NodeId x) {
  switch (type) {
    case Scalar::Half: return formatOf(Scalar::Float) == halfFormat ? x : rounded(halfFormat, x);
    case Scalar::Unorm8:
    case Scalar::Unorm16:
    case Scalar::Snorm8:
    case Scalar::Snorm16: {
      const bool isSigned = type == Scalar::Snorm8 || type == Scalar::Snorm16;
      const NodeId inside =
          minimum(Scalar::Float, maximum(Scalar::Float, x, number(isSigned ? -1 : 0)), number(1));
      // Half a step, and what the product and the float nearest to the step are rounded by.
      const double error = 0.5 / ir::normalizedScale(type) + 0x1p-22;
      return add({.op = Op::Round,
                  .operands = {inside, noNode, noNode},
                  .rounding = {.kind = Rounding::Kind::Absolute, .amount = error}});
    }
    case Scalar::Float:
      // A variant that computes in doubles, or in pairs, rounds what it writes.
      return formatOf(Scalar::Float).unit < floatFormat.unit ? rounded(floatFormat, x) : x;
    case Scalar::Bool:
    case Scalar::Int:
    case Scalar::Uint:
    case Scalar::Double: return x;
    case Scalar::Long:
    case Scalar::Ulong:
    case Scalar::Char:
    case Scalar::Uchar:
    case Scalar::Short:
    case Scalar::Ushort: {
      if (graph_.isExact(x)) {
        const auto bits = static_cast<std::uint32_t>(static_cast<std::int64_t>(graph_[x].value));
        if (ir::isNarrow(type))
          return number(Scalar::Int, static_cast<std::int32_t>(ir::quantize(type, bits)));
        return x;
      }
      throw NotBounded(fmt::format("a {} that is not constant", ir::row(type).spelling), loc_);
    }
  }
  return x;
}

}  // namespace skc::bounds
