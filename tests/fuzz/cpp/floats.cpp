// SPDX-License-Identifier: MIT
//
// Floats. The range of each expression is known, and where a result might round, its operands pass through `lim`, a
// function of every generated program.
#include <algorithm>

#include "cpp/body.hpp"

namespace fuzz::cpp {
namespace {

Range sum(Range a, Range b) {
  Range range = {std::max(a.magnitude, b.magnitude) + 1, std::max(a.fraction, b.fraction)};
  if (range.magnitude == Precision::copyMagnitude) ++range.magnitude;
  return range;
}

Range product(Range a, Range b) {
  Range range = {a.magnitude + b.magnitude, a.fraction + b.fraction};
  if (range.magnitude == Precision::copyMagnitude) ++range.magnitude;
  return range;
}

Range either(Range a, Range b) {
  return {std::max(a.magnitude, b.magnitude), std::max(a.fraction, b.fraction)};
}

}  // namespace

/// A value that may be stored, or, if `bits` is not 0, one below 2^bits.
Expr Body::limited(Expr expr, int bits) {
  if (expr.type < 0 || !types_.hasFloats(expr.type)) return expr;
  const Precision& precision = precisionOf(types_[expr.type]);
  const Range range = expr.range;
  const bool isCopy = range.magnitude == Precision::copyMagnitude;
  const bool isSmall = bits == 0 ? range.magnitude <= precision.stored || isCopy : range.magnitude <= bits;
  if (isSmall && range.fraction <= precision.fraction) return expr;
  const TypeId id = expr.type;
  Expr result = made("lim($)", id, listOf(std::move(expr)), true);
  result.range = precision.limited();
  return result;
}

TypeId Body::pickFloating() {
  const bool isDouble = unit_.has("doubles") && (!unit_.has("floats") || random_.chance(1, 3));
  return Types::of(isDouble ? Scalar::Double : Scalar::Float);
}

Expr Body::floatLeaf(TypeId type, int depth) {
  if (random_.chance(3, 4)) {
    if (std::optional<Expr> found = read([&](TypeId id) { return id == type; }, depth))
      return std::move(*found);
  }
  if (random_.chance(1, 3) && !isFull() && depth > 0) return converted(integer(depth - 1), type, false);
  return literal(type);
}

Expr Body::floatOperand(TypeId type, int depth) {
  if (depth > 0 && random_.chance(1, 8)) return converted(integer(depth - 1), type, true);
  if (type == Types::of(Scalar::Double) && unit_.has("floats") && random_.chance(1, 4))
    return floating(Types::of(Scalar::Float), depth);
  return floating(type, depth);
}

Expr Body::floatBinary(TypeId type, int depth) {
  const Precision& precision = precisionOf(types_[type]);
  const bool isProduct = random_.chance(2, 5);
  Expr a = floatOperand(type, depth - 1);
  Expr b = unsequenced(a, a.type == type ? floatOperand(type, depth - 1) : floating(type, depth - 1));
  const auto range = [&] { return isProduct ? product(a.range, b.range) : sum(a.range, b.range); };
  if (!precision.holds(range())) {
    a = limited(std::move(a), 7);
    b = limited(std::move(b), 7);
  }
  const Range exact = range();
  std::string& text = b.node->text;
  const bool isLiteral = b.node->children.empty() && text.starts_with("double(") && text.size() > 9;
  if (isLiteral && a.type == type && !a.node->children.empty() && random_.chance(1, 2))
    text = text.substr(6);  // beside a double, a literal is one by itself
  const std::string op = isProduct ? "*" : random_.chance(1, 2) ? "+" : "-";
  Expr result = made("($ " + op + " $)", type, listOf(std::move(a), std::move(b)), true);
  result.range = exact;
  return result;
}

namespace {

/// Functions of the arguments x and y, which `some` makes: multiples of 1/4 from -4 to 3.75. None of their values is closer to a step
/// of `near` than all rounding can bring it.
const std::vector<std::string> functionsOfOne = {
    "atan($)",  "cbrt($)",         "cos($)",        "erf($)",           "erfc($)", "exp($)",       "exp2($)",
    "expm1($)", "log(abs($) + O)", "log1p(abs($))", "log2(abs($) + O)", "sin($)",  "sqrt(abs($))", "tanh($)"};
const std::vector<std::string> functionsOfTwo = {"atan2($, $)", "hypot($, $)"};
const std::vector<std::string> exponents = {"0",   "1",   "2",    "3",    "4",     "0.5",
                                            "1.5", "2.5", "(-1)", "(-2)", "(-0.5)"};

}  // namespace

Expr Body::roundingFunction(TypeId type, int depth) {
  const bool isDouble = types_[type].scalar == Scalar::Double;
  const int count = types_[type].count;
  const std::string name = types_.spell(type), some = isDouble ? "someDouble($)" : "some($)";
  std::vector<Expr> parts;
  const auto argument = [&] {
    std::string text = count == 1 ? some : name + "(";
    for (int i = 0; i < count; ++i) {
      parts.push_back(value(Types::of(Scalar::Int), depth - 1));
      if (count > 1) text += (i == 0 ? "" : ", ") + some;
    }
    return count == 1 ? text : text + ")";
  };
  const std::string one = isDouble ? name + "(1)" : count == 1 ? "1.0f" : name + "(1.0f)";
  std::string text;
  const std::size_t form = random_.below(4);
  if (form == 0) {
    const std::string exponent = random_.pick(exponents);
    text = "pow(abs(" + argument() + ")" + (exponent.front() == '(' ? " + " + one : "") + ", " +
           (count == 1 ? exponent : name + "(" + exponent + ")") + ")";
  } else {
    for (const char c : random_.pick(form == 1 ? functionsOfTwo : functionsOfOne)) {
      if (c == '$') {
        text += argument();
      } else if (c == 'O') {
        text += one;
      } else {
        text += c;
      }
    }
  }
  Expr result = made("near(" + text + ")", type, std::move(parts), true);
  result.range = {9, 6};
  return result;
}

Expr Body::floatIntrinsic(TypeId type, int depth) {
  if (unit_.with("functions", 1, 3)) return roundingFunction(type, depth);
  if (type == Types::of(Scalar::Float) && random_.chance(1, 3)) {
    if (std::optional<Expr> found = sampled(depth)) return std::move(*found);
  }
  Expr a = floating(type, depth - 1);
  Range range = a.range;
  static const std::vector<std::string> steps = {"floor", "ceil", "trunc", "round"};
  const std::size_t form = random_.below(8);
  std::string text;
  std::vector<Expr> parts;
  parts.push_back(std::move(a));
  const auto add = [&] {
    parts.push_back(floating(type, depth - 1));
    range = either(range, parts.back().range);
  };
  if (form < 3) {
    text = random_.pick(steps) + "($)";
    range = sum({range.magnitude, 0}, {0, 0});
  } else if (form == 3) {
    text = "abs($)";
  } else if (form == 4) {
    text = "fract($)";
    range = {0, range.fraction};
  } else if (form < 7) {
    text = random_.chance(1, 2) ? "min($, $)" : "max($, $)";
    add();
  } else {
    text = "clamp($, $, $)";
    add();
    add();
  }
  Expr result = made(std::move(text), type, std::move(parts), true);
  result.range = range;
  return result;
}

Expr Body::floating(TypeId type, int depth) {
  if (depth <= 0 || isFull()) return floatLeaf(type, 0);
  switch (random_.below(13)) {
    case 0:
    case 1:
    case 2:
    case 3:
    case 4: return floatBinary(type, depth);
    case 5: {
      Expr any = floating(type, depth - 1);
      const Range range = any.range;
      Expr result = made("(-$)", type, listOf(std::move(any)));
      result.range = range;
      return result;
    }
    case 6: return choice(type, depth);
    case 7:
      if (std::optional<Expr> found = call([&](TypeId id) { return id == type; }, depth))
        return std::move(*found);
      return floatLeaf(type, depth);
    case 8:
    case 9:
      if (std::optional<Expr> found = floatAssignment(type, depth)) return std::move(*found);
      return floatLeaf(type, depth);
    case 10:
      if (std::optional<Expr> found = memberOf(type, depth)) return std::move(*found);
      return floatLeaf(type, depth);
    case 11:
      if (unit_.has("intrinsics") && !isConstant_) return floatIntrinsic(type, depth);
      return floatLeaf(type, depth);
    default: return floatLeaf(type, depth);
  }
}

std::optional<Expr> Body::floatAssignment(TypeId type, int depth) {
  if (!mayHaveEffects()) return std::nullopt;
  const std::size_t form = random_.below(3);
  if (form == 0) return assignment(type, depth);
  const std::optional<Place> found = place(type, true);
  if (!found) return std::nullopt;
  const std::uint64_t bit = std::uint64_t{1} << variableOf(*found).bit;
  Expr result{};
  if (form == 1) {
    static const std::vector<std::string> steps = {"($++)", "(++$)", "($--)", "(--$)"};
    result = made(random_.pick(steps), type, listOf(target(*found, depth - 1)), true);
  } else {
    Expr right = limited(convertible(type, depth - 1), 7);
    if (right.type != type && !types_.isInteger(right.type))
      right = limited(converted(std::move(right), type, type == Types::of(Scalar::Double)), 7);
    Expr left = target(*found, depth - 1);
    result = made(random_.chance(1, 2) ? "($ += $)" : "($ -= $)", type,
                  listOf(std::move(left), std::move(right)), true);
  }
  result.effects.writes |= bit;
  result.mayBeComponent = isComponent(*found);
  return result;
}

}  // namespace fuzz::cpp
