// SPDX-License-Identifier: MIT
//
// Expressions of all types: literals, conversions, choices, assignments as values, braces.
#include "cpp/body.hpp"

namespace fuzz::cpp {

Expr Body::made(std::string text, TypeId type, std::vector<Expr> parts, bool isGuard) {
  Expr result{.node = makeNode(Node::Kind::Expression, std::move(text)), .type = type};
  result.node->type = type;
  result.node->isGuard = isGuard;
  result.node->simple = types_.simplest(type);
  for (Expr& part : parts) {
    result.effects = result.effects | part.effects;
    result.node->children.push_back(std::move(part.node));
  }
  if (types_.hasFloats(type)) result.range = precisionOf(types_[type]).ofVariables();
  spend(1);
  return result;
}

Expr Body::literal(TypeId type) {
  static const std::vector<std::pair<std::string, Range>> floats = {
      {"0.0f", {0, 0}},    {"1.0f", {0, 0}},     {"2.0f", {1, 0}}, {"3.0f", {2, 0}},
      {"0.5f", {0, 1}},    {"0.25f", {0, 2}},    {"4.0f", {2, 0}}, {"7.5f", {3, 1}},
      {"(-1.0f)", {0, 0}}, {"(-2.25f)", {2, 2}}, {"13.0f", {4, 0}}};
  const Type& info = types_[type];
  switch (info.kind) {
    case Type::Kind::Enum: return made(random_.pick(info.enumerators), type, {});
    case Type::Kind::Scalar: break;
    case Type::Kind::Matrix: return matrixOf(type, 0);
    case Type::Kind::Index:
      return made(random_.chance(1, 2) ? "axis<N>(" + axis() + ")"
                                       : "index<N>(" + std::to_string(random_.between(-3, 5)) + ")",
                  type, {});
    default: return made(types_.simplest(type), type, {});
  }
  const ScalarFacts& facts = factsOf(info.scalar);
  if (types_.isFloating(type)) {
    const auto& [single, range] = random_.pick(floats);
    // In .sk, a literal alone is a float.
    const std::string number = single.substr(0, single.rfind('f'));
    const std::string text = info.scalar == Scalar::Float ? single
                             : number.front() == '('      ? "double" + number + ")"
                                                          : "double(" + number + ")";
    Expr result = made(text, type, {});
    result.range = range;
    return result;
  }
  const std::string& text = random_.pick(facts.literals);
  return made(types_.isNarrow(type) ? types_.spell(type) + "(" + text + ")" : text, type, {});
}

Expr Body::unsequenced(const Expr& first, Expr second) {
  const bool isConflict = (first.effects.writes & second.effects.all()) != 0 ||
                          (second.effects.writes & first.effects.all()) != 0;
  return isConflict ? literal(second.type) : std::move(second);
}

Expr Body::converted(Expr expr, TypeId type, bool mayStayImplicit) {
  if (expr.type == type) return expr;
  const Type& from = types_[expr.type];
  const bool toFloat = types_.isFloating(type), fromFloat = types_.isFloating(expr.type);
  Range range = {};
  if (toFloat && fromFloat) {
    range = expr.range;
    const bool isNarrower = type == Types::of(Scalar::Float);
    if (isNarrower && !singlePrecision.holds(range)) {
      expr = made("lim($)", expr.type, listOf(std::move(expr)), true);
      range = expr.range = doublePrecision.limited();
    }
    // What is stored has few bits.
    const bool isFine =
        range.fraction <= singlePrecision.fraction && range.magnitude <= singlePrecision.stored;
    if (isNarrower && !isFine) mayStayImplicit = false;
  } else if (toFloat) {  // only few bits
    const bool isSmall = factsOf(from.scalar).bits < 32;
    range = {isSmall ? (from.scalar == Scalar::Short || from.scalar == Scalar::Ushort ? 16 : 8) : 7, 0};
    if (from.kind == Type::Kind::Enum || !isSmall || range.magnitude > 8) {
      const TypeId promoted = types_.promoted(expr.type);
      const bool isLong = !mayStayImplicit && type == Types::of(Scalar::Double) && random_.chance(1, 2);
      const std::string mask = isLong ? "0x3ffffff" : "127";
      expr = made((from.isScoped ? "(int($) & " : "($ & ") + mask + ")",
                  from.isScoped ? Types::of(Scalar::Int) : promoted, listOf(std::move(expr)), true);
      range = {isLong ? 26 : 7, 0};
    }
  } else if (fromFloat && type != Types::of(Scalar::Bool) && type != Types::of(Scalar::Int)) {
    expr = made("int($)", Types::of(Scalar::Int), listOf(std::move(expr)), true);
    if (types_[type].kind == Type::Kind::Enum) return literal(type);
  }
  if (types_[type].kind == Type::Kind::Enum) mayStayImplicit = false;
  const TypeId underlying = Types::of(types_[type].scalar);
  if (types_[type].isWide && expr.type != underlying)
    expr = made(types_.spell(underlying) + "($)", underlying, listOf(std::move(expr)), true);
  if (types_[expr.type].kind == Type::Kind::Enum && types_[expr.type].isScoped) mayStayImplicit = false;
  if (expr.type == type) return expr;
  if (mayStayImplicit && random_.chance(2, 3)) {
    expr.range = range;
    return expr;
  }
  const std::string name = types_.spell(type);
  const std::size_t form = random_.below(4);
  Expr result = made(form == 0   ? "((" + name + ")$)"
                     : form == 1 ? "static_cast<" + name + ">($)"
                                 : name + "($)",
                     type, listOf(std::move(expr)), toFloat);
  result.range = range;
  return result;
}

Expr Body::convertible(TypeId type, int depth) {
  if (!types_.isScalar(type)) return value(type, depth);
  if (types_.isFloating(type)) {
    if (random_.chance(1, 5)) return converted(integer(depth - 1), type, true);
    if (random_.chance(1, 5)) return converted(floating(depth - 1), type, true);
    return floating(type, depth);
  }
  if (type == Types::of(Scalar::Bool) && random_.chance(2, 3)) return condition(depth);
  if (type == Types::of(Scalar::Int) && random_.chance(1, 8))
    return converted(floating(depth - 1), type, true);
  return converted(integer(depth), type, true);
}

Expr Body::value(TypeId type, int depth) {
  const Type::Kind kind = types_[type].kind;
  if (depth <= 0 || isFull()) {
    if (!isFull() || random_.chance(1, 2)) {
      if (std::optional<Expr> found = read([&](TypeId id) { return id == type; }, 0))
        return std::move(*found);
    }
    if (kind != Type::Kind::Matrix) return literal(type);
  }
  if (kind != Type::Kind::Scalar || random_.chance(1, 3)) {
    switch (random_.below(7)) {
      case 0:
      case 1:
        if (std::optional<Expr> found = read([&](TypeId id) { return id == type; }, depth))
          return std::move(*found);
        break;
      case 2:
        if ((kind != Type::Kind::Vector && kind != Type::Kind::Index) || unit_.has("vector_choices"))
          return choice(type, depth);
        break;
      case 3:
        if (std::optional<Expr> found = assignment(type, depth)) return std::move(*found);
        break;
      case 4:
        if (std::optional<Expr> found = call([&](TypeId id) { return id == type; }, depth))
          return std::move(*found);
        break;
      case 5:
        if (std::optional<Expr> found = memberOf(type, depth)) return std::move(*found);
        break;
      default: break;
    }
  }
  switch (kind) {
    case Type::Kind::Vector: return vectorOf(type, depth);
    case Type::Kind::Struct: return structOf(type, depth);
    case Type::Kind::Enum: return enumOf(type, depth);
    case Type::Kind::Matrix: return matrixOf(type, depth);
    case Type::Kind::Array: return braces(type, depth);
    case Type::Kind::Index: return ofAnyRank(depth);
    case Type::Kind::Gather:  // these are no values
    case Type::Kind::Bundle:
    case Type::Kind::Scalar: break;
  }
  if (types_.isFloating(type)) return floating(type, depth);
  if (type == Types::of(Scalar::Bool)) return converted(condition(depth), type, false);
  return converted(integer(depth), type, false);
}

Expr Body::choice(TypeId type, int depth) {
  Expr test = condition(depth - 1), yes = value(type, depth - 1), no = value(type, depth - 1);
  const Range range = {std::max(yes.range.magnitude, no.range.magnitude),
                       std::max(yes.range.fraction, no.range.fraction)};
  Expr result = made("($ ? $ : $)", type,
                     listOf(std::move(test), noComponent(std::move(yes)), noComponent(std::move(no))));
  result.range = range;
  return result;
}

/// Clang 19 gives the old value where it binds a reference to a component that is assigned, and refuses to choose such lvalues.
Expr Body::noComponent(Expr expr) {
  if (!expr.mayBeComponent) return expr;
  const Range range = expr.range;
  const TypeId type = expr.type;
  Expr result = made(types_.spell(type) + "($)", type, listOf(std::move(expr)), true);
  result.range = range;
  return result;
}

std::optional<Expr> Body::assignment(TypeId type, int depth) {
  if (!mayHaveEffects()) return std::nullopt;
  const std::optional<Place> found = place(type, true);
  if (!found) return std::nullopt;
  if (found->path.empty() && variableOf(*found).name == "this" && !unit_.has("whole_objects"))
    return std::nullopt;
  Expr right = limited(convertible(type, depth - 1), 0), left = target(*found, depth - 1);
  Expr result = made("($ = $)", type, listOf(std::move(left), std::move(right)));
  result.mayBeComponent = isComponent(*found);
  result.effects.writes |= std::uint64_t{1} << variableOf(*found).bit;
  return result;
}

/// A member of a struct that is no variable.
std::optional<Expr> Body::memberOf(TypeId type, int depth) {
  std::vector<std::pair<TypeId, const Field*>> members;
  for (TypeId id = 0; id < types_.size(); ++id) {
    if (types_[id].kind != Type::Kind::Struct) continue;
    for (const Field& field : types_[id].fields) {
      if (field.type == type) members.emplace_back(id, &field);
    }
  }
  if (members.empty() || isConstant_) return std::nullopt;
  const auto& [id, field] = random_.pick(members);
  const std::string name = field->name;
  std::optional<Expr> whole =
      random_.chance(1, 3) ? structOf(id, depth - 1)
                           : call([&, wanted = id](TypeId result) { return result == wanted; }, depth - 1);
  if (!whole) return std::nullopt;
  return made("$." + name, type, listOf(std::move(*whole)));
}

Expr Body::comparison(int depth) {
  static const std::vector<std::string> operators = {"==", "!=", "<", "<=", ">", ">="};
  if (hasFloating() && random_.chance(1, 4)) {
    Expr a = floating(depth - 1);
    Expr b = unsequenced(a, floating(depth - 1));
    return made("($ " + random_.pick(operators) + " $)", Types::of(Scalar::Bool),
                listOf(std::move(a), std::move(b)));
  }
  Expr a = integer(depth - 1);
  Expr b = unsequenced(a, integer(depth - 1));
  return made("($ " + random_.pick(operators) + " $)", Types::of(Scalar::Bool),
              listOf(std::move(a), std::move(b)));
}

Expr Body::condition(int depth) {
  const TypeId type = Types::of(Scalar::Bool);
  if (depth <= 0 || isFull()) {
    if (std::optional<Expr> found = read([&](TypeId id) { return types_.isLikeInteger(id); }, 0))
      return std::move(*found);
    return literal(type);
  }
  switch (random_.below(10)) {
    case 9:
      if (unit_.has("vectors") && unit_.has("masks")) {
        Expr test = mask(pickVectorScalar(), random_.between(2, 4), depth - 1);
        return made(random_.chance(1, 2) ? "any($)" : "all($)", type, listOf(std::move(test)));
      }
      return comparison(depth);
    case 0: return made("!$", type, listOf(condition(depth - 1)));
    case 1:
    case 2: {
      Expr a = condition(depth - 1), b = condition(depth - 1);
      return made(random_.chance(1, 2) ? "($ && $)" : "($ || $)", type, listOf(std::move(a), std::move(b)));
    }
    case 3: return integer(depth - 1);
    case 4:
      if (hasFloating()) return floating(depth - 1);
      return comparison(depth);
    case 5:
      if (std::optional<Expr> found = call([&](TypeId id) { return id == type; }, depth))
        return std::move(*found);
      return comparison(depth);
    default: return comparison(depth);
  }
}

Expr Body::structOf(TypeId type, int depth) {
  if (depth <= 0 || isFull()) return literal(type);
  Expr list = braces(type, depth - 1);
  list.node->text = types_.spell(type) + list.node->text;
  return list;
}

Expr Body::enumOf(TypeId type, int depth) {
  if (!types_[type].isFixed || random_.chance(1, 2)) return literal(type);
  return converted(integer(depth - 1), type, false);
}

Expr Body::matrixOf(TypeId type, int depth) {
  const int count = types_[type].count;
  const TypeId row = types_[type].element;
  std::string text = types_.spell(type) + "(";
  std::vector<Expr> parts;
  const bool isByRows = random_.chance(1, 2);
  for (int i = 0; i < (isByRows ? count : count * count); ++i) {
    text += i == 0 ? "$" : ", $";
    parts.push_back(isByRows ? value(row, depth - 1) : limited(literal(Types::of(Scalar::Float)), 0));
  }
  return made(text + ")", type, std::move(parts));
}

Expr Body::initialiser(TypeId type, int depth) {
  if (types_[type].kind == Type::Kind::Array) return braces(type, depth);
  if (types_[type].kind == Type::Kind::Struct && random_.chance(1, 2)) return braces(type, depth);
  return limited(convertible(type, depth), 0);
}

Expr Body::braces(TypeId type, int depth) {
  const Type info = types_[type];
  const std::size_t all =
      info.kind == Type::Kind::Struct ? info.fields.size() : static_cast<std::size_t>(info.count);
  std::size_t count = all;
  if (unit_.with("braces", 1, 3)) count = random_.below(all + 1);
  const bool isNamed = info.kind == Type::Kind::Struct && unit_.with("designators", 1, 6);
  std::string text = "{";
  std::vector<Expr> parts;
  for (std::size_t i = 0; i < count; ++i) {
    const TypeId element = info.kind == Type::Kind::Struct ? info.fields[i].type : info.element;
    if (isNamed && random_.chance(1, 3)) continue;
    text += parts.empty() ? "" : ", ";
    if (isNamed) text += "." + info.fields[i].name + " = ";
    text += "$";
    const bool isNested = types_[element].kind == Type::Kind::Array ||
                          (types_[element].kind == Type::Kind::Struct && random_.chance(1, 2));
    parts.push_back(isNested ? braces(element, depth - 1) : limited(value(element, depth - 1), 0));
  }
  Expr result = made(text + "}", type, std::move(parts));
  result.node->simple = "{}";
  return result;
}

}  // namespace fuzz::cpp
