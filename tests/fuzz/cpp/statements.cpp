// SPDX-License-Identifier: MIT
//
// Statements: declarations, effects, branches, loops with every jump, and switches that fall through.
#include "cpp/body.hpp"

namespace fuzz::cpp {

TypeId Body::pickType(bool mayBeArray) {
  if (isOfAnyRank_ && random_.chance(1, 6)) return Types::indexOfAnyRank();
  for (;;) {
    const auto id = static_cast<TypeId>(random_.below(static_cast<std::size_t>(types_.size())));
    const Type& type = types_[id];
    if (type.kind == Type::Kind::Array && !mayBeArray) continue;
    if (types_.leaves(id) > 24) continue;
    if (type.kind == Type::Kind::Matrix && random_.chance(2, 3)) continue;
    if (!unit_.mayHave(id)) continue;
    return id;
  }
}

NodePtr Body::statements(int count) {
  NodePtr list = makeList();
  for (int i = 0; i < count && !isFull(); ++i) list->children.push_back(statement());
  NodePtr body = makeStatement("$", std::move(list));
  if (returnsObject_) {
    body->text += "\nreturn *this;";
  } else if (result_ >= 0) {
    Expr result = limited(convertible(result_, 2), 0);
    body->text += "\nreturn $;";
    body->children.push_back(std::move(result.node));
  }
  return body;
}

NodePtr Body::block(int count) {
  const std::size_t outer = variables_.size();
  ++nesting_;
  NodePtr list = makeList();
  for (int i = 0; i < count && !isFull(); ++i) list->children.push_back(statement());
  --nesting_;
  leave(outer);
  return list;
}

NodePtr Body::statement() {
  const std::size_t chosen = random_.below(nesting_ >= 3 ? 12 : 20);
  if (chosen < 3) return declaration();
  if (chosen < 11) return effect();
  if (chosen < 12) return jump();
  if (chosen < 15) return branch();
  if (chosen < 17 && unit_.has("loops")) return loop();
  if (chosen < 19 && unit_.has("switch")) return selection();
  return makeStatement("{\n$}", block(pickCount()));
}

/// `auto [x, y] = s;`
NodePtr Body::bindings() {
  const TypeId type = pickType(true);
  const Type info = types_[type];
  const bool isArray = info.kind == Type::Kind::Array;
  if ((!isArray && info.kind != Type::Kind::Struct) || isFull()) return nullptr;
  bool isConst = random_.chance(1, 4);
  std::optional<Expr> whole;
  if (isArray) {
    std::vector<Place> all = places([&](TypeId id) { return id == type; }, false);
    std::erase_if(all, [&](const Place& place) { return place.path.empty() && variableOf(place).isPointer; });
    if (all.empty()) return nullptr;
    const Place& chosen = random_.pick(all);
    isConst |= !variableOf(chosen).isMutable;  // elements stay const
    whole = target(chosen, 0);
  } else {
    whole = value(type, 2);
  }
  std::string names;
  std::vector<TypeId> parts(static_cast<std::size_t>(info.count), info.element);
  if (!isArray) {
    parts.clear();
    for (const Field& field : info.fields) parts.push_back(field.type);
  }
  for (const TypeId part : parts) {
    const std::string name = unit_.newName("x");
    names += names.empty() ? name : ", " + name;
    declare(name, part, !isConst);
  }
  const std::size_t form = isArray ? 0 : random_.below(4);
  const std::string end = form == 3 ? "]{$};" : form == 2 ? "]($);" : "] = $;";
  return makeStatement((isConst ? "const auto [" : "auto [") + names + end, std::move(whole->node));
}

NodePtr Body::declaration() {
  if (unit_.with("bindings", 1, 4)) {
    if (NodePtr node = bindings()) return node;
  }
  const TypeId type = pickType(true);
  const Type::Kind kind = types_[type].kind;
  const bool isArray = kind == Type::Kind::Array;
  const std::string name = unit_.newName("x");
  const bool isConst = random_.chance(1, 6);
  std::string prefix = isConst ? "const " : "";
  NodePtr node;
  if (kind == Type::Kind::Struct && !isConst && unit_.with("defaults", 1, 5)) {
    bool isAll = true;  // members without an initialiser would stay unwritten
    const std::function<void(TypeId)> check = [&](TypeId id) {
      for (const Field& field : types_[id].fields) {
        if (field.hasDefault) continue;
        TypeId element = field.type;
        while (types_[element].kind == Type::Kind::Array) element = types_[element].element;
        if (types_[element].kind == Type::Kind::Struct) {
          check(element);
        } else {
          isAll = false;
        }
      }
    };
    check(type);
    if (isAll) {
      node = makeStatement(types_.declare(type, name) + ";");
      spend(1);
    }
  }
  if (!node) {
    const std::size_t form = kind == Type::Kind::Index ? 4 : random_.below(4);
    if (isArray || form == 0) {
      Expr value = initialiser(type, 2);
      node = makeStatement(prefix + types_.declare(type, name) + " = $;", std::move(value.node));
    } else if (form == 1 && kind != Type::Kind::Struct && kind != Type::Kind::Matrix) {
      Expr initial = limited(value(type, 2), 0);
      node = makeStatement(prefix + types_.declare(type, name) + "{$};", std::move(initial.node));
    } else if (form == 2) {
      Expr initial = limited(value(type, 2), 0);
      // Without more parentheses, `int x(int(y));` would declare a function.
      node = makeStatement(prefix + types_.declare(type, name) + "(($));", std::move(initial.node));
    } else if (form == 3 && unit_.has("auto") && kind != Type::Kind::Vector) {
      Expr initial = limited(value(type, 2), 0);
      node = makeStatement(prefix + "auto " + name + " = $;", std::move(initial.node));
    } else {
      Expr initial = limited(convertible(type, 2), 0);
      node = makeStatement(prefix + types_.declare(type, name) + " = $;", std::move(initial.node));
    }
  }
  declare(name, type, !isConst);
  return node;
}

Expr Body::effectExpression(int depth) {
  switch (random_.below(6)) {
    case 0:
    case 1:
      if (std::optional<Expr> found = integerAssignment(depth)) return std::move(*found);
      break;
    case 2:
      if (hasFloating()) {
        if (std::optional<Expr> found = floatAssignment(pickFloating(), depth)) return std::move(*found);
      }
      break;
    case 3:
    case 4:
      if (std::optional<Expr> found = callStatement(depth)) return std::move(*found);
      break;
    default: break;
  }
  if (std::optional<Expr> found = assignment(pickType(false), depth)) return std::move(*found);
  return integer(depth);
}

NodePtr Body::effect() {
  const int depth = random_.between(1, 3);
  if (unit_.with("vectors", 1, 8)) {
    if (std::optional<Expr> found = swizzleAssignment(depth))
      return makeStatement("$;", std::move(found->node));
  }
  if (unit_.has("order")) {
    Expr expr = effectExpression(depth);
    // `int(y);` would be a declaration.
    const char first = expr.node->text.front();
    const bool isSafe = first == '(' || first == '$' || expr.node->isGuard;
    return makeStatement(isSafe ? "$;" : "($);", std::move(expr.node));
  }
  // One effect a statement: an assignment of what has none.
  const TypeId type = pickType(false);
  const std::optional<Place> found = place(type, true);
  if (!found) return makeStatement(";");
  Expr right = limited(convertible(type, depth), 0), left = target(*found, 0);
  return makeStatement("$ = $;", std::move(left.node), std::move(right.node));
}

NodePtr Body::branch() {
  const std::size_t outer = variables_.size();
  std::string head = "if (";
  std::vector<NodePtr> parts;
  if (unit_.with("inits", 1, 5)) {
    const std::string name = unit_.newName("q");
    Expr initial = converted(integer(2), Types::of(Scalar::Int), true);
    const bool isCondition = random_.chance(1, 2);
    head += "int " + name + (isCondition ? " = $" : " = $; $");
    parts.push_back(std::move(initial.node));
    declare(name, Types::of(Scalar::Int), true);
    if (!isCondition) parts.push_back(condition(2).node);
  } else {
    head += "$";
    parts.push_back(condition(2).node);
  }
  parts.push_back(block(pickCount()));
  head += ") {\n$}";
  if (random_.chance(1, 2)) {
    head += " else {\n$}";
    parts.push_back(block(pickCount()));
  }
  leave(outer);
  NodePtr node = makeStatement(head);
  node->children = std::move(parts);
  return node;
}

/// `for (int d = 0; d < N; ++d)`
NodePtr Body::loopOverAxes() {
  const std::size_t outer = variables_.size();
  const std::string name = unit_.newName("d");
  constexpr int trips = highestRank;
  variables_.push_back(
      {.name = name, .type = Types::of(Scalar::Int), .isAxis = true, .bit = bits_++ % 64, .below = trips});
  multiplier_ *= trips;
  ++loops_;
  ++breakables_;
  NodePtr node =
      makeStatement("for (int " + name + " = 0; " + name + " < N; ++" + name + ") {\n$}", block(pickCount()));
  --breakables_;
  --loops_;
  multiplier_ /= trips;
  leave(outer);
  return node;
}

NodePtr Body::loop() {
  const int trips = random_.between(1, 6);
  if (cost_ + multiplier_ * trips * 20 > limit_ || loops_ >= 3) return effect();
  if (isOfAnyRank_ && random_.chance(1, 2)) return loopOverAxes();
  const std::string name = unit_.newName("i");
  const std::string count = std::to_string(trips);
  const std::size_t outer = variables_.size();
  Variable counter{.name = name, .type = Types::of(Scalar::Int), .bit = bits_++ % 64};
  multiplier_ *= trips + 1;
  ++loops_;
  ++breakables_;
  std::string text;
  std::vector<NodePtr> parts;
  switch (unit_.with("conditions", 1, 4) ? 5 + random_.below(2) : random_.below(5)) {
    case 5: {  // the body sees the variable, and so may the step
      const std::string left = unit_.newName("left");
      counter.below = trips;
      variables_.push_back(counter);
      variables_.push_back({.name = left, .type = counter.type, .bit = bits_++ % 64, .below = trips + 1});
      const std::string step = random_.chance(1, 2) ? "++" + name : name + " += " + left + " > 0 ? 1 : 2";
      text = "for (int " + name + " = 0; " + (random_.chance(1, 2) ? "const int " : "int ") + left + " = " +
             count + " - " + name + "; " + step + ") {\n$}";
      break;
    }
    case 6: {
      const std::string left = unit_.newName("left");
      counter.below = trips + 1;
      variables_.push_back(counter);
      variables_.push_back({.name = left, .type = counter.type, .bit = bits_++ % 64, .below = trips + 1});
      text = "{\nint " + name + " = 0;\nwhile (int " + left + " = " + count + " - " + name + "++) {\n$}\n}";
      break;
    }
    case 0:
    case 1:
      counter.below = trips;
      variables_.push_back(counter);
      text = "for (int " + name + " = 0; " + name + " < " + count;
      if (random_.chance(1, 3)) {
        text += " && $";
        parts.push_back(condition(2).node);
      }
      text += random_.chance(1, 2) ? "; ++" + name : "; " + name + "++";
      if (mayHaveEffects() && unit_.with("comma", 1, 4)) {
        text += ", $";
        const std::size_t position = variables_.size() - 1;
        variables_[position].below = trips + 1;  // it has been incremented
        parts.push_back(effectExpression(2).node);
        variables_[position].below = trips;
      }
      text += ") {\n$}";
      break;
    case 2:
      counter.below = trips;
      variables_.push_back(counter);
      text = "for (int " + name + " = " + std::to_string(trips - 1) + "; " + name + " >= 0; --" + name +
             ") {\n$}";
      break;
    case 3:
      counter.below = trips + 1;
      variables_.push_back(counter);
      text = "{\nint " + name + " = 0;\nwhile (" + name + "++ < " + count;
      if (random_.chance(1, 2)) {
        text += " && $";
        parts.push_back(condition(2).node);
      }
      text += ") {\n$}\n}";
      break;
    default:
      counter.below = trips + 1;
      variables_.push_back(counter);
      text = "{\nint " + name + " = 0;\ndo {\n$} while (++" + name + " < " + count;
      parts.push_back(block(pickCount()));
      if (random_.chance(1, 2)) {
        text += " && $";
        parts.push_back(condition(2).node);
      }
      text += ");\n}";
      break;
  }
  if (!text.starts_with("{\nint " + name + " = 0;\ndo")) parts.push_back(block(pickCount()));
  --breakables_;
  --loops_;
  multiplier_ /= trips + 1;
  leave(outer);
  NodePtr node = makeStatement(text);
  node->children = std::move(parts);
  return node;
}

NodePtr Body::selection() {
  std::vector<TypeId> enums;
  for (TypeId id = 0; id < types_.size(); ++id) {
    if (types_[id].kind == Type::Kind::Enum) enums.push_back(id);
  }
  std::vector<std::string> labels;
  Expr chosen;
  if (!enums.empty() && random_.chance(1, 2)) {
    const TypeId type = random_.pick(enums);
    labels = types_[type].enumerators;
    chosen = value(type, 2);
  } else {
    chosen = integer(2);
    const TypeId type = types_.promoted(chosen.type);
    const bool isUint = !factsOf(types_[type].scalar).isSigned;
    if (random_.chance(3, 4)) {
      chosen = made("($ & 7)", type, listOf(std::move(chosen)));
    } else if (random_.chance(1, 2)) {
      chosen = made(isUint ? "($ % 5u)" : "($ % 5)", type, listOf(std::move(chosen)));
    }
    const int first = isUint ? 0 : random_.between(-3, 0);
    for (int i = 0; i < 6; ++i) labels.push_back(std::to_string(first + i) + (isUint ? "u" : ""));
  }
  ++breakables_;
  NodePtr cases = makeList();
  bool hasDefault = false;
  const std::size_t count = random_.below(5) + 1;
  for (std::size_t i = 0; i < count; ++i) {
    std::string text = unit_.with("likely", 1, 6) ? "[[likely]] " : "";
    const std::size_t labelCount = random_.chance(1, 4) ? 2 : 1;
    for (std::size_t l = 0; l < labelCount; ++l) {
      if (!hasDefault && random_.chance(1, 5)) {
        text += "default:\n";
        hasDefault = true;
      } else if (!labels.empty()) {
        const std::size_t taken = random_.below(labels.size());
        text += "case " + labels[taken] + ":\n";
        labels.erase(labels.begin() + static_cast<std::ptrdiff_t>(taken));
      }
    }
    if (!text.ends_with('\n')) break;
    text += random_.chance(1, 2) ? "{\n$}" : "{\n$}\nbreak;";
    cases->children.push_back(makeStatement(text, block(pickCount())));
  }
  --breakables_;
  if (unit_.with("conditions", 1, 4)) {
    const std::string name = unit_.newName("chosen");
    const std::string head =
        random_.chance(1, 2) ? "auto " + name + " = $" : "auto " + name + " = $; " + name;
    return makeStatement("switch (" + head + ") {\n$}", std::move(chosen.node), std::move(cases));
  }
  return makeStatement("switch ($) {\n$}", std::move(chosen.node), std::move(cases));
}

NodePtr Body::returning() {
  if (returnsObject_) return makeStatement("if ($) return *this;", condition(2).node);
  if (result_ < 0) return makeStatement("if ($) return;", condition(2).node);
  Expr test = condition(2), result = limited(convertible(result_, 2), 0);
  return makeStatement("if ($) return $;", std::move(test.node), std::move(result.node));
}

NodePtr Body::jump() {
  if (!unit_.has("jumps") || nesting_ == 0) return effect();
  const std::size_t chosen = random_.below(3);
  if (chosen == 0 || (breakables_ == 0 && loops_ == 0)) return returning();
  const bool isBreak = breakables_ > 0 && (chosen == 1 || loops_ == 0);
  if (random_.chance(1, 4)) return makeStatement(isBreak ? "break;" : "continue;");
  return makeStatement(isBreak ? "if ($) break;" : "if ($) continue;", condition(2).node);
}

NodePtr Body::variable(TypeId type) {
  const std::string name = unit_.newName("x");
  Expr initial = initialiser(type, 1);
  declare(name, type, true);
  return makeStatement(types_.declare(type, name) + " = $;", std::move(initial.node));
}

bool Body::addCall(Node& list, const Function& function) {
  if (!canCall(function)) return false;
  if (!rankFor(function)) return false;
  if (function.owner >= 0 && !types_.isBundle(function.owner))
    list.children.push_back(variable(function.owner));
  for (const Parameter& parameter : function.parameters) {
    const bool isArray = types_[parameter.type].kind == Type::Kind::Array;
    if (parameter.passing == Passing::Reference || isArray) list.children.push_back(variable(parameter.type));
  }
  std::optional<Expr> called = callOf(function, 2);
  if (!called) return false;
  if (called->type < 0) {
    list.children.push_back(makeStatement("$;", std::move(called->node)));
  } else {
    const std::string name = unit_.newName("x");
    list.children.push_back(
        makeStatement(types_.declare(called->type, name) + " = $;", std::move(called->node)));
    declare(name, function.result, true);
  }
  return true;
}

NodePtr Body::foldOf(const std::string& text, TypeId type) {
  if (type == Types::of(Scalar::Float)) return makeStatement("r2 = lim(r2 * 0.5f + lim(" + text + "));");
  if (type == Types::of(Scalar::Double))
    return makeStatement("r0 = r0 * 31 + int(" + text + ") + int(lim(" + text + ") * 4096.0);");
  if (types_.isWideInteger(type))
    return makeStatement("r0 = r0 * 31 + int(" + text + ") + 7 * int(" + text + " >> 32);");
  if (types_.isIndex(type))
    return makeStatement("r0 = r0 * 31 + at<N>(" + text + ", 0) + 7 * at<N>(" + text + ", N - 1);");
  if (type == Types::of(Scalar::Uint)) return makeStatement("r1 = r1 * 31u + " + text + ";");
  return makeStatement("r0 = r0 * 31 + int(" + text + ");");
}

void Body::addFolds(Node& list, const std::string& text, TypeId id, int& budget) {
  if (budget <= 0) return;
  const Type type = types_[id];
  switch (type.kind) {
    case Type::Kind::Struct:
      for (const Field& field : type.fields) addFolds(list, text + "." + field.name, field.type, budget);
      return;
    case Type::Kind::Array:
    case Type::Kind::Matrix:
      for (int i = 0; i < type.count; ++i)
        addFolds(list, text + "[" + std::to_string(i) + "]", type.element, budget);
      return;
    case Type::Kind::Vector:
      for (int i = 0; i < type.count; ++i) addFolds(list, text + "." + "xyzw"[i], type.element, budget);
      return;
    default: break;
  }
  --budget;
  list.children.push_back(foldOf(text, id));
}

void Body::foldInto(Node& list) {
  for (const Variable& variable : variables_) {
    int budget = 12;
    if (variable.name[0] == 'x') addFolds(list, variable.name, variable.type, budget);
  }
}

}  // namespace fuzz::cpp
