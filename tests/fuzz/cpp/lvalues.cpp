// SPDX-License-Identifier: MIT
//
// Variables, their members, elements and components.
#include "cpp/body.hpp"

namespace fuzz::cpp {

Variable& Body::declare(std::string name, TypeId type, bool isMutable) {
  variables_.push_back({.name = std::move(name), .type = type, .isMutable = isMutable, .bit = bits_++ % 64});
  return variables_.back();
}

void Body::declareObject(TypeId type, bool isMutable) { declare("this", type, isMutable); }

void Body::declareConstants() {
  for (const Variable& constant : unit_.constants)
    declare(constant.name, constant.type, false).isReferable = false;
}

void Body::addPlaces(std::size_t variable, const Accepts& accepts, bool onlyReferable,
                     std::vector<Place>& places) {
  std::vector<Step> path;
  const std::function<void(TypeId, bool)> visit = [&](TypeId id, bool isReferable) {
    if (onlyReferable && !isReferable) return;
    if (accepts(id)) places.push_back({variable, path, id, isReferable});
    if (path.size() == (types_.isBundle(variables_[variable].type) ? 6 : 4)) return;
    const Type& type = types_[id];
    const auto follow = [&](Step step, TypeId next, bool mayRefer) {
      path.push_back(step);
      visit(next, isReferable && mayRefer);
      path.pop_back();
    };
    switch (type.kind) {
      case Type::Kind::Struct:
      case Type::Kind::Bundle:
        for (std::size_t i = 0; i < type.fields.size(); ++i)
          follow({Step::Kind::Field, static_cast<int>(i)}, types_[id].fields[i].type, true);
        break;
      case Type::Kind::Array: follow({Step::Kind::Index}, type.element, true); break;
      case Type::Kind::Matrix: follow({Step::Kind::Index}, type.element, false); break;
      case Type::Kind::Gather: follow({Step::Kind::Element}, type.element, false); break;
      case Type::Kind::Vector: follow({Step::Kind::Component}, type.element, false); break;
      default: break;
    }
  };
  visit(variables_[variable].type, variables_[variable].isReferable);
}

std::vector<Body::Place> Body::places(const Accepts& accepts, bool onlyMutable, bool onlyReferable) {
  std::vector<Place> all;
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    if (!onlyMutable || variables_[i].isMutable) addPlaces(i, accepts, onlyReferable, all);
  }
  return all;
}

std::optional<Body::Place> Body::place(const Accepts& accepts, bool onlyMutable) {
  std::vector<Place> all = places(accepts, onlyMutable);
  if (all.empty()) return std::nullopt;
  return std::move(all[random_.below(all.size())]);
}

Expr Body::index(int count, int depth) {
  if (random_.chance(1, 3) || isConstant_ || isFull())
    return made(std::to_string(random_.below(static_cast<std::size_t>(count))), Types::of(Scalar::Int), {});
  std::vector<const Variable*> counters;
  for (const Variable& variable : variables_) {
    if (variable.below != 0 && variable.below <= count) counters.push_back(&variable);
  }
  if (!counters.empty() && random_.chance(1, 2)) {
    const Variable& counter = *random_.pick(counters);
    Expr result = made(counter.name, Types::of(Scalar::Int), {}, true);
    result.effects.reads = std::uint64_t{1} << counter.bit;
    return result;
  }
  Expr any = integer(depth - 1);
  if ((count & (count - 1)) == 0) {
    const TypeId type = types_.promoted(any.type);
    return made("($ & " + std::to_string(count - 1) + ")", type, listOf(std::move(any)), true);
  }
  return made("(uint($) % " + std::to_string(count) + "u)", Types::of(Scalar::Uint), listOf(std::move(any)),
              true);
}

Expr Body::spelled(const Place& place, int depth) {
  const Variable& variable = variableOf(place);
  std::string text = variable.name;
  if (variable.name == "this") text = place.path.empty() ? "(*this)" : random_.chance(1, 3) ? "this->" : "";
  std::vector<Expr> parts;
  TypeId id = variable.type;
  for (std::size_t i = 0; i < place.path.size(); ++i) {
    const Type& type = types_[id];
    const Step& step = place.path[i];
    if (step.kind == Step::Kind::Field) {
      const Field& field = type.fields[static_cast<std::size_t>(step.field)];
      if (!(variable.name == "this" && i == 0)) text += ".";
      text += field.name;
      id = field.type;
      continue;
    }
    const TypeId element = type.element;
    if (step.kind == Step::Kind::Element) {
      access(text, parts, type.count, depth);
      id = element;
      continue;
    }
    if (step.kind == Step::Kind::Component && random_.chance(1, 2)) {
      text += std::string(".") +
              (random_.chance(1, 4) ? "rgba" : "xyzw")[random_.below(static_cast<std::size_t>(type.count))];
    } else {
      text += "[$]";
      parts.push_back(index(type.count, depth));
      // Vectors are no part of C++: whether Clang reads one before or after it computes the index depends on the context.
      const std::uint64_t bit = std::uint64_t{1} << variable.bit;
      if (step.kind == Step::Kind::Component && (parts.back().effects.written() & bit) != 0)
        parts.back() = made("0", Types::of(Scalar::Int), {});
    }
    id = element;
  }
  const std::uint64_t bit = std::uint64_t{1} << variable.bit;
  Expr result = made(std::move(text), place.type, std::move(parts));
  result.effects.reads |= bit;
  result.range = precisionOf(types_[place.type]).ofVariables();
  if (variable.below != 0) result.range = {4, 0};
  return result;
}

Expr Body::target(const Place& place, int depth) {
  Expr result = spelled(place, depth);
  const auto keep = [&] {
    result.node->simple.clear();
    result.node->isGuard = true;
  };
  keep();
  const TypeId type = place.type;
  if (mayHaveEffects() && depth > 0 && place.isReferable && unit_.with("lvalue_choices", 1, 16)) {
    const std::vector<Place> others = places([&](TypeId id) { return id == type; }, true, true);
    if (!others.empty()) {
      result = targetChoice(place, random_.pick(others), depth);
      result.effects.writes |= result.effects.reads;  // either of them, and what the condition reads
      return result;
    }
  }
  if (!mayHaveEffects() || depth <= 0 || !types_.isInteger(type) || !unit_.with("nested", 1, 10))
    return result;
  // An assignment is an lvalue, too: `(x = 3) += y`.
  if (type != Types::of(Scalar::Bool) && random_.chance(1, 2)) {
    result = made(random_.chance(1, 2) ? "(++$)" : "(--$)", type, listOf(std::move(result)));
  } else {
    Expr right = integer(depth - 1);
    result = made(random_.chance(1, 2) || type == Types::of(Scalar::Bool) ? "($ = $)" : "($ += $)", type,
                  listOf(std::move(result), std::move(right)));
  }
  keep();
  result.effects.writes |= std::uint64_t{1} << variableOf(place).bit;
  return result;
}

Expr Body::targetChoice(const Place& yes, const Place& no, int depth) {
  Expr test = condition(depth - 1), first = target(yes, 0), second = target(no, 0);
  Expr result =
      made("($ ? $ : $)", yes.type, listOf(std::move(test), std::move(first), std::move(second)), true);
  result.node->simple.clear();
  return result;
}

std::optional<Expr> Body::read(const Accepts& accepts, int depth) {
  if (isConstant_) return std::nullopt;
  const std::optional<Place> found = place(accepts, false);
  if (!found) return std::nullopt;
  return spelled(*found, depth);
}

}  // namespace fuzz::cpp
