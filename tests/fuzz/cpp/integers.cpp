// SPDX-License-Identifier: MIT
//
// Integers of all sizes: what they are computed in follows C++'s promotions.
#include "cpp/body.hpp"

namespace fuzz::cpp {

Expr Body::integer(int depth) {
  const auto isInteger = [&](TypeId id) { return types_.isLikeInteger(id); };
  if (depth <= 0 || isFull()) {
    if (random_.chance(3, 4)) {
      if (std::optional<Expr> found = read(isInteger, 0)) return std::move(*found);
    }
    return literal(pickInteger());
  }
  switch (random_.below(19)) {
    case 0: return literal(pickInteger());
    case 1:
    case 2:
      if (std::optional<Expr> found = read(isInteger, depth)) return std::move(*found);
      return integerBinary(depth);
    case 3: {
      Expr any = integer(depth - 1);
      const TypeId type = types_.promoted(any.type);
      const std::size_t form = random_.below(4);
      if (form == 3) return made("!$", Types::of(Scalar::Bool), listOf(std::move(any)));
      return made(form == 0 ? "(-$)" : form == 1 ? "(~$)" : "(+$)", type, listOf(std::move(any)));
    }
    case 4: return comparison(depth);
    case 5: {
      Expr test = condition(depth - 1), yes = integer(depth - 1), no = integer(depth - 1);
      const TypeId type = yes.type == no.type ? yes.type : types_.common(yes.type, no.type);
      return made("($ ? $ : $)", type,
                  listOf(std::move(test), noComponent(std::move(yes)), noComponent(std::move(no))));
    }
    case 6:
    case 7:
    case 8:
      if (std::optional<Expr> found = integerAssignment(depth)) return std::move(*found);
      return integerBinary(depth);
    case 9:
    case 10:
      if (std::optional<Expr> found = call(isInteger, depth)) return std::move(*found);
      return integerBinary(depth);
    case 11: {
      const auto to = static_cast<TypeId>(random_.below(unit_.has("narrow") ? 7 : 1));
      const TypeId type = random_.chance(1, 3)  ? pickInteger()
                          : unit_.has("narrow") ? to
                                                : Types::of(Scalar::Uint);
      if (hasFloating() && random_.chance(1, 4)) return converted(floating(depth - 1), type, false);
      return converted(integer(depth - 1), type, false);
    }
    case 12:
      if (unit_.has("comma")) {
        Expr first = mayHaveEffects() ? effectExpression(depth - 1) : integer(depth - 1);
        Expr second = integer(depth - 1);
        const TypeId type = second.type;
        Expr result = made("($, $)", type, listOf(std::move(first), std::move(second)));
        result.mayBeComponent = true;
        return result;
      }
      return integerBinary(depth);
    case 13:
      if (std::optional<Expr> found =
              memberOf(Types::of(random_.chance(1, 2) ? Scalar::Int : Scalar::Uint), depth))
        return std::move(*found);
      return integerBinary(depth);
    case 14:
      if (unit_.has("vectors")) {
        Scalar scalar = random_.chance(1, 2) ? Scalar::Int : Scalar::Uint;
        if (unit_.with("narrow_vectors", 1, 4)) scalar = static_cast<Scalar>(random_.between(1, 4));
        const int count = random_.between(2, 4);
        Expr vector = vectorOf(Types::vector(scalar, count), depth - 1);
        const std::string name(1, "xyzw"[random_.below(static_cast<std::size_t>(count))]);
        return made("$." + name, Types::of(scalar), listOf(std::move(vector)));
      }
      return integerBinary(depth);
    case 15:
      if (unit_.has("intrinsics")) return intrinsic(depth);
      return integerBinary(depth);
    case 16:
    case 17:
      if (std::optional<Expr> found = streamInteger(depth)) return std::move(*found);
      return integerBinary(depth);
    default: return integerBinary(depth);
  }
}

/// Int or Uint, or sometimes one of 64 bits.
TypeId Body::pickInteger() {
  const TypeId wide = Types::of(random_.chance(1, 2) ? Scalar::Long : Scalar::Ulong);
  if (unit_.mayHave(wide) && random_.chance(1, 3)) return wide;
  return Types::of(random_.chance(2, 3) ? Scalar::Int : Scalar::Uint);
}

Expr Body::intrinsic(int depth) {
  const TypeId type = Types::of(random_.chance(1, 2) ? Scalar::Int : Scalar::Uint);
  Expr a = value(type, depth - 1);
  if (random_.chance(1, 4)) {
    static const std::vector<std::string> counts = {"popcount($)", "clz($)", "ctz($)"};
    return made(random_.pick(counts), Types::of(Scalar::Int), listOf(std::move(a)));
  }
  const std::size_t form = random_.below(5);
  if (form == 0 && type == Types::of(Scalar::Int)) return made("abs($)", type, listOf(std::move(a)));
  Expr b = value(type, depth - 1);
  if (form == 4) return made("mulhi($, $)", type, listOf(std::move(a), std::move(b)));
  if (form < 3)
    return made(random_.chance(1, 2) ? "min($, $)" : "max($, $)", type, listOf(std::move(a), std::move(b)));
  Expr c = value(type, depth - 1);
  return made("clamp($, $, $)", type, listOf(std::move(a), std::move(b), std::move(c)));
}

Expr Body::integerBinary(int depth) {
  static const std::vector<std::string> operators = {"+", "-", "*", "&", "|", "^"};
  Expr a = integer(depth - 1);
  if (random_.chance(1, 5)) {  // E1 << E2 evaluates E1 first
    Expr b = integer(depth - 1);
    const TypeId count = types_.promoted(b.type), type = types_.promoted(a.type);
    Expr masked = made("($ & " + types_.shiftMask(type) + ")", count, listOf(std::move(b)), true);
    return made(random_.chance(1, 2) ? "($ << $)" : "($ >> $)", type,
                listOf(std::move(a), std::move(masked)));
  }
  Expr b = unsequenced(a, integer(depth - 1));
  if (random_.chance(1, 5)) {
    const TypeId divisor = types_.promoted(b.type), type = types_.common(a.type, b.type);
    std::vector<std::string> masks = {"7", "15", "255", "65535"};
    if (types_.isWideInteger(divisor))
      masks.insert(masks.end(), 3, "(" + types_.spell(divisor) + "(1) << 62)");
    Expr positive = made("(($ & " + random_.pick(masks) + ") + 1)", divisor, listOf(std::move(b)), true);
    return made(random_.chance(1, 2) ? "($ / $)" : "($ % $)", type,
                listOf(std::move(a), std::move(positive)));
  }
  const TypeId type = types_.common(a.type, b.type);
  return made("($ " + random_.pick(operators) + " $)", type, listOf(std::move(a), std::move(b)));
}

std::optional<Expr> Body::integerAssignment(int depth) {
  if (!mayHaveEffects()) return std::nullopt;
  const std::optional<Place> found = place([&](TypeId id) { return types_.isInteger(id); }, true);
  if (!found) return std::nullopt;
  const TypeId type = found->type;
  const std::uint64_t bit = std::uint64_t{1} << variableOf(*found).bit;
  const auto written = [&](Expr expr) {
    expr.effects.writes |= bit;
    expr.mayBeComponent = isComponent(*found);
    return expr;
  };
  const bool isBool = type == Types::of(Scalar::Bool);
  const std::size_t form = random_.below(isBool ? 2 : 8);
  if (form == 0) return assignment(type, depth);
  if (form >= 4 && form < 8) {
    static const std::vector<std::string> steps = {"$++", "++$", "$--", "--$"};
    return written(made("(" + steps[form - 4] + ")", type, listOf(target(*found, depth - 1))));
  }
  static const std::vector<std::string> operators = {
      "+=", "-=", "*=", "&=", "|=", "^=", "<<=", ">>=", "/=", "%="};
  std::size_t chosen = random_.below(operators.size());
  if (isBool) chosen = 3 + random_.below(3);
  Expr right = integer(depth - 1);
  const TypeId promoted = types_.promoted(right.type);
  if (chosen == 6 || chosen == 7)
    right = made("($ & " + types_.shiftMask(types_.promoted(type)) + ")", promoted, listOf(std::move(right)),
                 true);
  if (chosen >= 8) right = made("(($ & 63) + 1)", promoted, listOf(std::move(right)), true);
  Expr left = target(*found, depth - 1);
  return written(made("($ " + operators[chosen] + " $)", type, listOf(std::move(left), std::move(right))));
}

}  // namespace fuzz::cpp
