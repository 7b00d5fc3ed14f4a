// SPDX-License-Identifier: MIT
//
// Calls of functions, methods and operators. No two references of a call get the same variable, or parts of it that
// overlap, as language.md says.
#include <algorithm>

#include "cpp/body.hpp"

namespace fuzz::cpp {

void Body::finish(Function function) {
  function.cost = cost_ + 1;
  function.size = size_ + 1;
  function.callees = callees_;
  unit_.functions.push_back(std::move(function));
}

bool Body::canCall(const Function& function) const {
  return !isConstant_ && cost_ + multiplier_ * function.cost <= limit_ && size_ + function.size <= sizeLimit_;
}

bool Body::hasPlaceOf(TypeId type) {
  return !places([&](TypeId id) { return id == type; }, false).empty();
}

/// The rank of a template over N, at which there is something for each of its gathers and bundles.
std::optional<int> Body::rankFor(const Function& function) {
  std::vector<int> ranks;
  for (int rank = isOfAnyRank_ ? anyRank : 1; rank <= highestRank; ++rank) {
    const auto has = [&](TypeId type) {
      return !types_.isOfStreams(type) || hasPlaceOf(types_.atRank(type, rank));
    };
    if (function.isOfAnyRank || rank <= 1) {
      bool hasAll = function.owner < 0 || has(function.owner);
      for (const Parameter& parameter : function.parameters) hasAll = hasAll && has(parameter.type);
      if (hasAll) ranks.push_back(rank);
    }
  }
  if (ranks.empty()) return std::nullopt;
  return random_.pick(ranks);
}

std::optional<Expr> Body::call(const Accepts& acceptsResult, int depth) {
  std::vector<const Function*> candidates;
  for (const Function& function : unit_.functions) {
    if (function.result >= 0 && acceptsResult(function.result) && canCall(function))
      candidates.push_back(&function);
  }
  if (candidates.empty()) return std::nullopt;
  return callOf(*random_.pick(candidates), depth);
}

std::optional<Expr> Body::callStatement(int depth) {
  std::vector<const Function*> candidates;
  for (const Function& function : unit_.functions) {
    if (canCall(function)) candidates.push_back(&function);
  }
  if (candidates.empty()) return std::nullopt;
  return callOf(*random_.pick(candidates), depth);
}

std::optional<Expr> Body::callOf(const Function& function, int depth) {
  const std::optional<int> rank = rankFor(function);
  if (!rank) return std::nullopt;
  const auto typeOf = [&](std::size_t p) { return types_.atRank(function.parameters[p].type, *rank); };
  // References first: they need variables of their own.
  const std::size_t count = function.parameters.size();
  std::vector<std::optional<Place>> bound(count + 1);  // the last: the object of a method
  std::uint64_t taken = 0;
  std::vector<std::optional<Place>> others(count + 1);  // of choices among two
  std::vector<const Place*> mutableOnes;
  const auto bindsApart = [&](const Place& candidate) {
    for (const Place* other : mutableOnes) {
      const std::uint64_t bit = std::uint64_t{1} << variableOf(candidate).bit;
      if (bit != std::uint64_t{1} << variableOf(*other).bit) continue;
      if (candidate.variable != other->variable || !unit_.has("parts")) return false;
      const bool areMembers = !candidate.path.empty() && !other->path.empty() &&
                              candidate.path[0].kind == Step::Kind::Field &&
                              other->path[0].kind == Step::Kind::Field;
      if (!areMembers || candidate.path[0].field == other->path[0].field) return false;
    }
    return true;
  };
  const auto bind = [&](std::size_t p, TypeId type) {
    std::vector<Place> all;
    for (Place& candidate : places([&](TypeId id) { return id == type; }, true, true)) {
      if (bindsApart(candidate)) all.push_back(std::move(candidate));
    }
    if (all.empty()) return false;
    bound[p] = std::move(all[random_.below(all.size())]);
    mutableOnes.push_back(&*bound[p]);
    taken |= std::uint64_t{1} << variableOf(*bound[p]).bit;
    std::erase_if(all, [&](const Place& candidate) { return !bindsApart(candidate); });
    if (!all.empty() && unit_.with("lvalue_choices", 1, 6)) {
      others[p] = std::move(all[random_.below(all.size())]);
      mutableOnes.push_back(&*others[p]);
      taken |= std::uint64_t{1} << variableOf(*others[p]).bit;
    }
    return true;
  };
  const bool isMutableMethod = function.owner >= 0 && !function.isConst;
  const bool isOfTemporary = isMutableMethod && unit_.with("temporaries", 1, 5);
  if (isMutableMethod && !isOfTemporary && !bind(count, function.owner)) return std::nullopt;
  for (std::size_t p = 0; p < count; ++p) {
    if (function.parameters[p].passing == Passing::Reference && !bind(p, function.parameters[p].type))
      return std::nullopt;
  }
  // Gathers and bundles have no other expressions.
  const auto bindStreams = [&](std::size_t p, TypeId type) {
    std::vector<Place> all = places([&](TypeId id) { return id == type; }, false);
    bound[p] = std::move(all[random_.below(all.size())]);
  };
  const bool isOfBundle = function.owner >= 0 && types_.isBundle(function.owner);
  if (isOfBundle) bindStreams(count, types_.atRank(function.owner, *rank));
  // Arrays that do not change: a copy in .sk, where C++ passes a pointer.
  for (std::size_t p = 0; p < count; ++p) {
    const Parameter& parameter = function.parameters[p];
    if (types_.isOfStreams(parameter.type)) bindStreams(p, typeOf(p));
    if (types_[parameter.type].kind != Type::Kind::Array || parameter.passing == Passing::Reference) continue;
    const bool mayShare = parameter.passing == Passing::ConstReference && unit_.has("aliasing");
    std::vector<Place> all = places([&](TypeId id) { return id == parameter.type; }, !parameter.takesConst);
    std::erase_if(all, [&](const Place& candidate) {
      const bool isPointer = candidate.path.empty() && variableOf(candidate).isPointer;
      if (isPointer && parameter.passing == Passing::ConstReference) return true;
      return !mayShare && (taken & std::uint64_t{1} << variableOf(candidate).bit) != 0;
    });
    if (all.empty()) return std::nullopt;
    bound[p] = std::move(all[random_.below(all.size())]);
  }

  std::vector<Expr> parts;
  std::string text;
  std::uint64_t heldByConst = 0;
  const auto isConflict = [&](const Expr& part) { return (part.effects.written() & heldByConst) != 0; };
  const auto add = [&](Expr part) {
    parts.push_back(isConflict(part) ? literal(part.type) : std::move(part));
  };
  const auto addTarget = [&](std::size_t p) {
    const Place& place = *bound[p];
    if (others[p]) {
      Expr part = targetChoice(place, *others[p], isFull() ? 0 : depth - 1);
      parts.push_back(isConflict(part) ? targetChoice(place, *others[p], 0) : std::move(part));
      return;
    }
    Expr part = target(place, depth - 1);
    parts.push_back(isConflict(part) ? target(place, 0) : std::move(part));
  };
  const bool isSubscript = function.name == "[]", isCall = function.name == "()";
  const bool isNamed = !function.isInfix && !isSubscript && !isCall;
  if (function.owner >= 0) {
    const std::string begin = isSubscript        ? "$["
                              : isCall           ? "$("
                              : function.isInfix ? "($ " + function.name + " "
                                                 : "$." + function.name + "(";
    if (isOfTemporary) {
      std::optional<Expr> object;
      if (random_.chance(1, 2)) object = call([&](TypeId id) { return id == function.owner; }, depth - 1);
      if (!object) object = structOf(function.owner, depth - 1);
      text = begin;
      add(std::move(*object));
    } else if (isMutableMethod) {
      const bool isOwn = variableOf(*bound[count]).name == "this" && bound[count]->path.empty();
      if (isOwn && isNamed && !others[count] && random_.chance(2, 3)) {
        text = function.name + "(";
      } else {
        text = begin;
        addTarget(count);
      }
    } else if (isOfBundle) {
      const bool isOwn = variableOf(*bound[count]).name == "this" && bound[count]->path.empty();
      text = isOwn ? function.name + "(" : begin;
      if (!isOwn) parts.push_back(target(*bound[count], 0));
    } else {
      Expr object = value(function.owner, depth - 1);
      if (!unit_.has("constrefs")) heldByConst |= object.effects.reads;
      text = begin;
      add(std::move(object));
    }
  } else if (function.isInfix) {
    text = "(";
  } else {
    text = function.name;
    // Deduced, or given.
    const bool isDeduced = std::ranges::any_of(function.parameters, [&](const Parameter& parameter) {
      return types_.isOfStreams(parameter.type) && types_.isOfAnyRank(parameter.type);
    });
    if (function.isOfAnyRank && (!isDeduced || random_.chance(1, 3)))
      text += *rank == anyRank ? "<N>" : "<" + std::to_string(*rank) + ">";
    text += "(";
  }
  const auto addArguments = [&] {
    for (std::size_t p = 0; p < count; ++p) {
      const Parameter& parameter = function.parameters[p];
      if (parameter.hasDefault && random_.chance(1, 2)) break;
      if (p > 0) text += function.isInfix ? " " + function.name + " " : ", ";
      text += "$";
      if (parameter.passing == Passing::Reference) {
        addTarget(p);
        continue;
      }
      if (bound[p]) {
        Expr array = target(*bound[p], 0);
        const bool isHeld = !types_.isOfStreams(parameter.type) &&
                            (parameter.passing == Passing::Value || !unit_.has("constrefs"));
        if (isHeld) heldByConst |= array.effects.reads;
        parts.push_back(std::move(array));
        continue;
      }
      Expr argument = function.isExact || parameter.passing == Passing::ConstReference
                          ? value(typeOf(p), depth - 1)
                          : convertible(typeOf(p), depth - 1);
      argument = limited(std::move(argument), 0);
      if (parameter.passing == Passing::ConstReference) {
        // What a const reference shows must not change, unless C++ and skc agree about it.
        const bool isShared = (argument.effects.reads & taken) != 0;
        if (isShared && !unit_.has("aliasing")) argument = literal(typeOf(p));
        if (!unit_.has("constrefs")) heldByConst |= argument.effects.reads;
        argument = noComponent(std::move(argument));
        argument.node->isGuard = true;  // else the reducer may leave a component
      }
      add(std::move(argument));
    }
    text += isSubscript ? "]" : ")";
  };
  addArguments();
  const bool hasReferences = std::ranges::any_of(function.parameters, [](const Parameter& parameter) {
    return parameter.passing == Passing::Reference;
  });
  if (function.returnsObject && isNamed && !hasReferences && random_.chance(1, 3)) {
    text += "." + function.name + "(";
    addArguments();
    cost_ += multiplier_ * function.cost;
  }
  const TypeId type = function.result >= 0 ? function.result : Types::of(Scalar::Int);
  Expr result = made(std::move(text), type, std::move(parts), true);
  if (function.result < 0) {
    result.type = -1;
    result.node->type = -1;
    result.node->simple.clear();
  }
  result.effects.calls |= taken;
  callees_.insert(static_cast<std::size_t>(&function - unit_.functions.data()));
  size_ += function.size;
  cost_ += multiplier_ * function.cost;
  return result;
}

}  // namespace fuzz::cpp
