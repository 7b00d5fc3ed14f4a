// SPDX-License-Identifier: MIT
//
// Vectors of int, uint and float: operators by component, swizzles, and what they are made from.
#include "cpp/body.hpp"

namespace fuzz::cpp {
namespace {

/// Components in a random order; without repetition if they are written.
std::string swizzle(Random& random, int width, int count, bool isWritten) {
  std::string letters = random.chance(1, 5) ? "rgba" : "xyzw", result;
  letters.resize(static_cast<std::size_t>(width));
  for (int i = 0; i < count; ++i) {
    const std::size_t chosen = random.below(letters.size());
    result += letters[chosen];
    if (isWritten) letters.erase(chosen, 1);
  }
  return result;
}

}  // namespace

Scalar Body::pickVectorScalar() {
  for (;;) {
    const auto scalar = static_cast<Scalar>(random_.between(1, scalarCount - 1));
    const bool isNarrow = scalar < Scalar::Int;
    if (isNarrow && (!unit_.has("narrow_vectors") || random_.chance(1, 2))) continue;
    if (types_.isWideInteger(Types::of(scalar)) && !unit_.mayHave(Types::of(scalar))) continue;
    if (scalar == Scalar::Float && !unit_.has("floats")) continue;
    if (scalar == Scalar::Double && !unit_.has("doubles")) continue;
    return scalar;
  }
}

Expr Body::vectorOf(TypeId type, int depth) {
  if (depth <= 0 || isFull()) return vectorParts(type, 0);
  const Type info = types_[type];
  switch (random_.below(9)) {
    case 0:
    case 1: return vectorBinary(type, depth);
    case 8:
      if (unit_.has("intrinsics") && !isConstant_) return vectorIntrinsic(type, depth);
      return vectorParts(type, depth);
    case 2: {  // components of another vector
      const int width = random_.between(2, 4);
      Expr whole = value(Types::vector(info.scalar, width), depth - 1);
      const Range range = whole.range;
      Expr result =
          made("$." + swizzle(random_, width, info.count, false), type, listOf(std::move(whole)), true);
      result.range = range;
      return result;
    }
    case 3: {
      Expr any = vectorOf(type, depth - 1);
      const Range range = any.range;
      Expr result = made(
          info.scalar < Scalar::Float && unit_.has("vector_bits") && random_.chance(1, 2) ? "(~$)" : "(-$)",
          type, listOf(std::move(any)));
      result.range = range;
      return result;
    }
    case 4:
      if (info.scalar == Scalar::Int) {  // a comparison's mask
        const Scalar compared = random_.pick(std::vector<Scalar>{Scalar::Int, Scalar::Uint, Scalar::Float});
        if (compared != Scalar::Float || unit_.has("floats")) return mask(compared, info.count, depth);
      }
      if (unit_.has("masks")) {
        Expr test = mask(info.scalar, info.count, depth - 1), yes = value(type, depth - 1),
             no = value(type, depth - 1);
        const Range range = {std::max(yes.range.magnitude, no.range.magnitude),
                             std::max(yes.range.fraction, no.range.fraction)};
        const bool isPlain = (test.effects | yes.effects | no.effects).written() == 0;
        const std::string name = types_.spell(type), both = name + "($) : " + name + "($))";
        Expr result = made(isPlain && random_.chance(1, 2) ? "($ ? " + both : "select($, $, $)", type,
                           listOf(std::move(test), std::move(yes), std::move(no)));
        result.range = range;
        return result;
      }
      return vectorParts(type, depth);
    case 5:
      if (std::optional<Expr> found = read([&](TypeId id) { return id == type; }, depth))
        return std::move(*found);
      return vectorParts(type, depth);
    default: return vectorParts(type, depth);
  }
}

/// A comparison of vectors: -1 where true. Its type is that of its numbers, of as many bits.
Expr Body::mask(Scalar scalar, int count, int depth) {
  static const std::vector<std::string> operators = {"==", "!=", "<", "<=", ">", ">="};
  const TypeId type = Types::vector(scalar, count);
  Expr a = value(type, depth - 1);
  Expr b = unsequenced(a, value(type, depth - 1));
  const TypeId result = scalar == Scalar::Float || scalar == Scalar::Uint ? Types::vector(Scalar::Int, count)
                        : scalar == Scalar::Ulong                         ? Types::vector(Scalar::Long, count)
                                                                          : type;
  Expr test = made("($ " + random_.pick(operators) + " $)", result, listOf(std::move(a), std::move(b)), true);
  if (types_[result].scalar != Scalar::Int) test.node->simple.clear();
  return test;
}

Expr Body::vectorBinary(TypeId type, int depth) {
  const Type info = types_[type];
  const bool isFloat = types_.hasFloats(type);
  static const std::vector<std::string> ofFloats = {"+", "-", "*"};
  static const std::vector<std::string> ofIntegers = {"+", "-", "*", "&", "|", "^"};
  const bool hasBits = !isFloat && unit_.has("vector_bits");
  const std::string& op = random_.pick(hasBits ? ofIntegers : ofFloats);
  Expr a = value(type, depth - 1);
  Expr b = random_.chance(1, 3) ? value(info.element, depth - 1) : value(type, depth - 1);
  b = unsequenced(a, std::move(b));
  if (hasBits && random_.chance(1, 6) && !(types_.isNarrow(type) && types_.isScalar(b.type))) {
    const std::string most = std::to_string(factsOf(info.scalar).bits - 1);
    const std::string mask = types_.isScalar(b.type) ? most : types_.spell(type) + "(" + most + ")";
    const TypeId count = b.type;
    Expr masked = made(
        "($ & " + std::string(info.scalar == Scalar::Uint && types_.isScalar(b.type) ? "31u" : mask) + ")",
        count, listOf(std::move(b)), true);
    return made(random_.chance(1, 2) ? "($ << $)" : "($ >> $)", type,
                listOf(std::move(a), std::move(masked)));
  }
  Range range = {};
  if (isFloat) {
    a = limited(std::move(a), 7);
    b = limited(std::move(b), 7);
    range = op == "*" ? Range{a.range.magnitude + b.range.magnitude, a.range.fraction + b.range.fraction}
                      : Range{std::max(a.range.magnitude, b.range.magnitude) + 1,
                              std::max(a.range.fraction, b.range.fraction)};
  }
  Expr result = made("($ " + op + " $)", type, listOf(std::move(a), std::move(b)));
  result.range = range;
  return result;
}

/// A function of whole vectors, which are int, uint or float: others have none, or not all.
Expr Body::vectorIntrinsic(TypeId type, int depth) {
  const Type info = types_[type];
  if (info.scalar == Scalar::Float || info.scalar == Scalar::Double) {
    if (unit_.with("functions", 1, 3)) return roundingFunction(type, depth);
    if (random_.chance(1, 2)) {
      Expr a = limited(value(type, depth - 1), 7);
      const Range range = a.range;
      Expr result = made(random_.chance(1, 2) ? "floor($)" : "abs($)", type, listOf(std::move(a)), true);
      result.range = {range.magnitude + 1, range.fraction};
      return result;
    }
  } else if (info.scalar != Scalar::Int && info.scalar != Scalar::Uint) {
    return vectorParts(type, depth);
  } else if (random_.chance(1, 2)) {
    static const std::vector<std::string> ofBits = {"popcount($)", "clz($)", "ctz($)"};
    if (info.scalar == Scalar::Int && random_.chance(1, 2)) {
      const Scalar argument = random_.chance(1, 2) ? Scalar::Int : Scalar::Uint;
      Expr a = value(Types::vector(argument, info.count), depth - 1);
      return made(random_.pick(ofBits), type, listOf(std::move(a)), true);
    }
    Expr a = value(type, depth - 1), b = value(type, depth - 1);
    return made("mulhi($, $)", type, listOf(std::move(a), std::move(b)), true);
  }
  Expr a = value(type, depth - 1), b = value(type, depth - 1);
  const Range range = {std::max(a.range.magnitude, b.range.magnitude),
                       std::max(a.range.fraction, b.range.fraction)};
  Expr result =
      made(random_.chance(1, 2) ? "min($, $)" : "max($, $)", type, listOf(std::move(a), std::move(b)), true);
  result.range = range;
  return result;
}

/// float4(v.xy, 1, 2), or the same number everywhere.
Expr Body::vectorParts(TypeId type, int depth) {
  const Type info = types_[type];
  std::string text = types_.spell(type) + "(";
  std::vector<Expr> parts;
  const auto number = [&] {
    if (depth <= 0) return literal(info.element);
    return limited(value(info.element, depth - 1), 0);
  };
  Range range = {};
  const auto add = [&](Expr part) {
    text += parts.empty() ? "$" : ", $";
    range = {std::max(range.magnitude, part.range.magnitude), std::max(range.fraction, part.range.fraction)};
    parts.push_back(std::move(part));
  };
  if (random_.chance(1, 6)) {
    add(number());
  } else {
    for (int left = info.count; left > 0;) {
      if (left >= 2 && depth > 0 && random_.chance(1, 4) && left < info.count) {
        const int width = random_.between(2, left);
        add(limited(value(Types::vector(info.scalar, width), depth - 1), 0));
        left -= width;
      } else {
        add(number());
        --left;
      }
    }
  }
  Expr result = made(text + ")", type, std::move(parts));
  result.range = range;
  return result;
}

/// `v.zx = w`, `v.yx += w`: as a statement.
std::optional<Expr> Body::swizzleAssignment(int depth) {
  const std::optional<Place> found =
      place([&](TypeId id) { return types_[id].kind == Type::Kind::Vector; }, true);
  if (!found) return std::nullopt;
  const Type info = types_[found->type];
  const bool isFloat = types_.hasFloats(found->type);
  const int count = random_.between(2, info.count);
  const TypeId type = Types::vector(info.scalar, count);
  const std::string components = swizzle(random_, info.count, count, true);
  const bool isPlain = random_.chance(1, 2);
  Expr right =
      limited(random_.chance(1, 4) && !isPlain ? value(info.element, depth - 1) : value(type, depth - 1),
              isPlain ? 0 : 7);
  Expr left = target(*found, depth - 1);
  static const std::vector<std::string> ofFloats = {"+=", "-="};
  static const std::vector<std::string> ofIntegers = {"+=", "-=", "*=", "&=", "|=", "^="};
  const std::string op =
      isPlain ? "=" : random_.pick(isFloat || !unit_.has("vector_bits") ? ofFloats : ofIntegers);
  Expr result =
      made("$." + components + " " + op + " $", type, listOf(std::move(left), std::move(right)), true);
  result.node->simple.clear();
  result.effects.writes |= std::uint64_t{1} << variableOf(*found).bit;
  return result;
}

}  // namespace fuzz::cpp
