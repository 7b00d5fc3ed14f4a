// SPDX-License-Identifier: MIT
//
// Floats. The range of each expression is known, and where a result might round, its operands pass through `lim`, a
// function of every generated program.
#include "cpp/body.hpp"

namespace fuzz::cpp {
namespace {

Range sum(Range a, Range b) {
  Range range = {std::max(a.magnitude, b.magnitude) + 1, std::max(a.fraction, b.fraction)};
  if (range.magnitude == storedRange.magnitude) ++range.magnitude;  // that is the mark of copies
  return range;
}

Range product(Range a, Range b) { return {a.magnitude + b.magnitude, a.fraction + b.fraction}; }

}  // namespace

/// A value that may be stored, or, if `bits` is not 0, one below 2^bits.
Expr Body::limited(Expr expr, int bits) {
  const Type& type = types_[expr.type];
  const bool isFloat =
      types_.isFloat(expr.type) || (type.kind == Type::Kind::Vector && type.scalar == Scalar::Float);
  if (!isFloat) return expr;
  const Range range = expr.range;
  const bool isCopy = range.magnitude == storedRange.magnitude;
  const bool isFine = bits == 0 ? range.fraction <= 2 && (range.magnitude <= 14 || isCopy)
                                : range.fraction <= 2 && range.magnitude <= bits;
  if (isFine) return expr;
  const TypeId id = expr.type;
  Expr result = made("lim($)", id, listOf(exact(std::move(expr))), true);
  result.range = limitedRange;
  return result;
}

/// Makes sure that the value itself has been computed without rounding.
Expr Body::exact(Expr expr) { return expr; }

Expr Body::floatLeaf(int depth) {
  if (random_.chance(3, 4)) {
    if (std::optional<Expr> found = read([&](TypeId id) { return types_.isFloat(id); }, depth))
      return std::move(*found);
  }
  if (random_.chance(1, 3) && !isFull() && depth > 0)
    return converted(integer(depth - 1), Types::of(Scalar::Float), false);
  return literal(Types::of(Scalar::Float));
}

Expr Body::floating(int depth) {
  const TypeId type = Types::of(Scalar::Float);
  if (depth <= 0 || isFull()) return floatLeaf(0);
  switch (random_.below(12)) {
    case 0:
    case 1:
    case 2: {
      Expr a = floating(depth - 1);
      Expr b = unsequenced(a, floating(depth - 1));
      if (!sum(a.range, b.range).isExact()) {
        a = limited(std::move(a), 7);
        b = limited(std::move(b), 7);
      }
      const Range range = sum(a.range, b.range);
      Expr result =
          made(random_.chance(1, 2) ? "($ + $)" : "($ - $)", type, listOf(std::move(a), std::move(b)), true);
      result.range = range;
      return result;
    }
    case 3:
    case 4: {
      Expr a = floating(depth - 1);
      Expr b = unsequenced(a, floating(depth - 1));
      if (!product(a.range, b.range).isExact()) {
        a = limited(std::move(a), 7);
        b = limited(std::move(b), 7);
      }
      const Range range = product(a.range, b.range);
      Expr result = made("($ * $)", type, listOf(std::move(a), std::move(b)), true);
      result.range = range;
      return result;
    }
    case 5: {
      Expr any = floating(depth - 1);
      const Range range = any.range;
      Expr result = made("(-$)", type, listOf(std::move(any)));
      result.range = range;
      return result;
    }
    case 6: return choice(type, depth);
    case 7:
      if (std::optional<Expr> found = call([&](TypeId id) { return id == type; }, depth))
        return std::move(*found);
      return floatLeaf(depth);
    case 8:
    case 9:
      if (std::optional<Expr> found = floatAssignment(depth)) return std::move(*found);
      return floatLeaf(depth);
    case 10:
      if (std::optional<Expr> found = memberOf(type, depth)) return std::move(*found);
      return floatLeaf(depth);
    default: return floatLeaf(depth);
  }
}

std::optional<Expr> Body::floatAssignment(int depth) {
  if (!mayHaveEffects()) return std::nullopt;
  const TypeId type = Types::of(Scalar::Float);
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
    if (!types_.isFloat(right.type)) right = converted(std::move(right), type, false);
    Expr left = target(*found, depth - 1);
    result = made(random_.chance(1, 2) ? "($ += $)" : "($ -= $)", type,
                  listOf(std::move(left), std::move(right)), true);
  }
  result.effects.writes |= bit;
  return result;
}

}  // namespace fuzz::cpp
