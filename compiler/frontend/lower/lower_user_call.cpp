// SPDX-License-Identifier: MIT
//
// Lowers calls of the user's functions. Arguments are evaluated in C++'s order: a parameter that is a value
// gets the argument's value at that time; a reference gets the object, whose indices are fixed at that time.
#include <algorithm>

#include <clang/AST/DeclCXX.h>
#include <clang/AST/ExprCXX.h>

#include "frontend/lower/function_lowering.hpp"
#include "frontend/lower/locations.hpp"
#include "ir/build.hpp"
#include "ir/lvalue.hpp"

namespace skc::frontend {

using clang::SourceLocation;
using ir::ExprPtr;

namespace {

/// True if the object that `e` names may share a number with the lvalue.
bool mayOverlap(const ir::Module& module, const ir::Expr& e, const ir::Expr& lvalue) {
  if (ir::isLValue(e)) return !ir::areDisjoint(module, e, lvalue);
  if (const auto* choice = std::get_if<ir::Select>(&e.node)) {
    return mayOverlap(module, *choice->yes, lvalue) || mayOverlap(module, *choice->no, lvalue);
  }
  if (const auto* member = std::get_if<ir::Member>(&e.node)) return mayOverlap(module, *member->base, lvalue);
  if (const auto* index = std::get_if<ir::Index>(&e.node)) return mayOverlap(module, *index->base, lvalue);
  if (const auto* swizzle = std::get_if<ir::Swizzle>(&e.node))
    return mayOverlap(module, *swizzle->base, lvalue);
  return false;
}

}  // namespace

/// The object of a method, if any, and the arguments, one for each parameter in the IR.
std::vector<FunctionLowering::Argument> FunctionLowering::argumentsOf(
    const clang::CallExpr* e, const clang::FunctionDecl* callee) const {
  std::vector<Argument> arguments;
  Bundles& bundles = module_.bundles();
  for (const Bundles::Source& source : bundles.parametersOf(callee->getDefinition())) {
    const clang::Expr* given = argumentFor(e, callee, source.parameter);
    const auto gather = gathers_.find({streamNamed(module_, given), source.parameter});
    if (gather != gathers_.end()) {
      arguments.push_back({given, false, nullptr, gather->second});
      continue;
    }
    if (source.member.empty()) {
      const bool isReference = source.parameter == nullptr || source.parameter->getType()->isReferenceType();
      arguments.push_back({given, isReference && namesObject(given)});
      continue;
    }
    std::optional<Bundles::Place> place = bundles.placeOf(given);
    if (!place) module_.fail(Diag::BundleMade, given->getBeginLoc(), {given->getType().getAsString()});
    place->path.insert(place->path.end(), source.member.begin(), source.member.end());
    arguments.push_back({given, false, nullptr, members_.at(*place)});
  }
  return arguments;
}

/// What is passed for a member of a bundle.
ExprPtr FunctionLowering::memberArgument(ir::VarId member, const clang::Expr* bundle) const {
  return ir::makeExpr(function_.variables[member].type, ir::VarRef{member},
                      module_.loc(bundle->getBeginLoc()));
}

/// Evaluates the arguments one after the other, and keeps those evaluated earlier from the effects of later ones.
void FunctionLowering::lowerArguments(std::vector<Argument>& arguments,
                                      const std::vector<ir::Variable>& parameters, bool rightToLeft) {
  for (std::size_t n = 0; n < arguments.size(); ++n) {
    const std::size_t i = rightToLeft ? arguments.size() - 1 - n : n;
    ir::Block effects;
    ir::Block* outer = std::exchange(out_, &effects);
    arguments[i].value = arguments[i].member ? memberArgument(*arguments[i].member, arguments[i].source)
                                             : argument(arguments[i].source, parameters[i]);
    out_ = outer;
    if (effects.empty()) continue;
    const Variables changed = ir::assignedIn(module_.module(), effects);
    for (std::size_t k = 0; k < arguments.size(); ++k) {
      if (k == i || !arguments[k].value) continue;
      const ir::VarRole role = parameters[k].role;
      const bool isStream = arguments[k].member || role == ir::VarRole::Gather ||
                            role == ir::VarRole::AppendOutput ||
                            (role == ir::VarRole::Element && streamVariable(arguments[k].source));
      if (isStream) continue;
      if (role == ir::VarRole::InOut || arguments[k].isReference)
        keepLocation(arguments[k].value, changed);
      else
        keepValue(arguments[k].value, changed);
    }
    append(std::move(effects));
  }
}

/// What the callee changes must not move the lvalues that it is written back to.
void FunctionLowering::keepWritten(std::vector<Argument>& arguments,
                                   const std::vector<ir::Variable>& parameters) {
  Variables changed;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (parameters[i].role == ir::VarRole::InOut)
      std::ranges::copy(rootsOf(*arguments[i].value), std::back_inserter(changed));
  }
  std::ranges::sort(changed);
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (parameters[i].role == ir::VarRole::InOut) keepLocation(arguments[i].value, changed);
  }
}

/// True if argument `i` names one of two objects, and only a branch can tell the call which one: the function changes it, or
/// may see it change.
bool FunctionLowering::needsBranch(const std::vector<Argument>& arguments, std::size_t i,
                                   ir::FunctionId callee) const {
  if (choiceIn(*arguments[i].value) == nullptr) return false;
  const ir::Module& module = module_.module();
  const ir::Function& function = module.functions[callee];
  const auto isWritten = [&](std::size_t p) { return function.variables[p].role == ir::VarRole::InOut; };
  if (isWritten(i)) return true;
  if (!arguments[i].isReference) return false;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    // A choice that the call writes has its branch first.
    const bool isObject = isWritten(k) && choiceIn(*arguments[k].value) == nullptr;
    if (isObject && mayOverlap(module, *arguments[i].value, *arguments[k].value)) return true;
  }
  return false;
}

/// References are passed as copies. Finds those that name parts of one object, where the function could tell the
/// difference.
std::vector<FunctionLowering::Group> FunctionLowering::aliasedGroups(const std::vector<Argument>& arguments,
                                                                     ir::FunctionId callee) {
  const ir::Module& module = module_.module();
  const ir::Function& function = module.functions[callee];
  const auto isWritten = [&](std::uint32_t i) { return function.variables[i].role == ir::VarRole::InOut; };
  std::vector<Group> groups;
  const auto groupOf = [&](std::uint32_t i) {
    return std::ranges::find_if(groups, [&](const Group& g) { return std::ranges::find(g, i) != g.end(); });
  };
  for (std::uint32_t i = 0; i < arguments.size(); ++i) {
    if (!isWritten(i)) continue;
    const ir::Expr& written = *arguments[i].value;
    for (std::uint32_t k = 0; k < arguments.size(); ++k) {
      const bool isOther = isWritten(k) ? k > i : arguments[k].isReference;
      if (!isOther || !mayOverlap(module, *arguments[k].value, written)) continue;
      if (!isWritten(k) &&
          !ir::readsAfterWriting(module, function, k, i, arguments[k].value->type == written.type)) {
        continue;
      }
      const auto first = groupOf(i), second = groupOf(k);
      if (first == groups.end() && second == groups.end()) {
        groups.push_back({i, k});
      } else if (first == groups.end()) {
        second->push_back(i);
      } else if (second == groups.end()) {
        first->push_back(k);
      } else if (first != second) {
        first->insert(first->end(), second->begin(), second->end());
        groups.erase(second);
      }
    }
  }
  return groups;
}

/// Makes the first argument of a group the object that has all of them as parts, and the second the indices within.
void FunctionLowering::joinAliases(const Group& group, std::vector<Argument>& arguments, Aliases& aliases) {
  std::vector<std::vector<const ir::Expr*>> chains;
  for (const std::uint32_t i : group) chains.push_back(chainOf(*arguments[i].value));
  const std::size_t common = commonSteps(chains);
  const std::uint32_t whole = group[0], second = group[1];
  Exprs indices;
  for (std::size_t g = 0; g < group.size(); ++g) {
    Alias alias{whole, second, {}};
    for (std::size_t at = common; at < chains[g].size(); ++at) {
      if (const auto* member = std::get_if<ir::Member>(&chains[g][at]->node)) {
        alias.steps.push_back({AliasStep::Kind::Field, member->field});
        continue;
      }
      const ir::ExprPtr& index = std::get<ir::Index>(chains[g][at]->node).index;
      const auto* literal = std::get_if<ir::Literal>(&index->node);
      if (literal && index->type.scalar == ir::Scalar::Int) {
        alias.steps.push_back({AliasStep::Kind::Element, literal->bits});
      } else {
        alias.steps.push_back({AliasStep::Kind::Index, static_cast<std::uint32_t>(indices.size())});
        indices.push_back(ir::clone(*index));
      }
    }
    aliases.parts.emplace(group[g], std::move(alias));
  }
  const SourceLocation where = arguments[second].source->getBeginLoc();
  const Loc loc = arguments[whole].value->loc;
  const ir::VarId root = ir::rootOf(*arguments[whole].value);
  ExprPtr object = common == 0 ? ir::varRef(function_, root, loc) : ir::clone(*chains[0][common - 1]);
  aliases.wholes.emplace(whole, object->type);
  arguments[whole].value = std::move(object);
  aliases.indices.emplace(second, indexType(indices.size(), where));
  arguments[second].value = packed(std::move(indices), where);
  for (std::size_t g = 2; g < group.size(); ++g) {  // no longer needed
    aliases.indices.emplace(group[g], indexType(0, where));
    arguments[group[g]].value = packed({}, where);
  }
}

/// The type of what passes indices: an int, a vector of ints, or an array of them.
ir::Type FunctionLowering::indexType(std::size_t count, SourceLocation where) {
  constexpr std::size_t widest = 4;
  if (count > widest) return module_.arrayType(ir::Type::of(ir::Scalar::Int), count, where);
  return ir::Type::of(ir::Scalar::Int, static_cast<int>(std::max<std::size_t>(count, 1)));
}

/// The indices as one value.
ExprPtr FunctionLowering::packed(Exprs indices, SourceLocation where) {
  const Loc loc = module_.loc(where);
  for (ExprPtr& index : indices) {
    if (index->type.scalar == ir::Scalar::Uint) {  // an index beyond the last int is the last element, too
      ExprPtr most = ir::literal(std::uint32_t{0x7fffffff}, loc);
      index = ir::intrinsic(ir::Intrinsic::Min, ir::exprs(std::move(index), std::move(most)), loc);
    }
    index = intIndex(std::move(index));
  }
  if (indices.empty()) return ir::literal(0, loc);
  if (indices.size() == 1) return std::move(indices[0]);
  const ir::Type type = indexType(indices.size(), where);
  return ir::construct(type, std::move(indices), loc);
}

/// Turns parameters into the objects, indices and parts that a call with aliases passes.
void FunctionLowering::aliasParameters(const Aliases& aliases) {
  for (const auto& [parameter, type] : aliases.wholes) {
    ir::Variable& variable = function_.variables[parameter];
    variable.type = type;
    variable.role = ir::VarRole::InOut;
    variable.isConst = false;
  }
  for (const auto& [parameter, type] : aliases.indices) {
    ir::Variable& variable = function_.variables[parameter];
    variable.name += "_index";
    variable.type = type;
    variable.role = ir::VarRole::In;
    variable.isConst = true;
  }
  for (const auto& [parameter, alias] : aliases.parts) {
    const Loc loc = function_.variables[parameter].loc;
    ExprPtr part = ir::varRef(function_, alias.whole, loc);
    for (const AliasStep& step : alias.steps) {
      switch (step.kind) {
        case AliasStep::Kind::Field:
          part = ir::member(module_.module(), std::move(part), step.value, loc);
          break;
        case AliasStep::Kind::Element:
          part = ir::index(module_.module(), std::move(part),
                           ir::literal(static_cast<std::int32_t>(step.value), loc), loc);
          break;
        case AliasStep::Kind::Index: {
          ExprPtr index = ir::varRef(function_, alias.indices, loc);
          if (index->type.isVector())
            index = ir::swizzle(std::move(index), std::string_view("xyzw").substr(step.value, 1), loc);
          else if (!index->type.isScalar())
            index = ir::index(module_.module(), std::move(index),
                              ir::literal(static_cast<std::int32_t>(step.value), loc), loc);
          part = ir::index(module_.module(), std::move(part), std::move(index), loc);
          break;
        }
      }
    }
    aliases_.emplace(parameter, std::move(part));
  }
}

/// Emits a call as a statement, in the branches that its arguments need.
void FunctionLowering::emitCall(const UserCall& call, std::vector<Argument> arguments) {
  const Loc loc = module_.loc(call.where);
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (!needsBranch(arguments, i, call.id)) continue;
    ExprPtr location = std::move(arguments[i].value);
    return withObject(std::move(location), [&](ExprPtr object) {
      std::vector<Argument> chosen;
      for (std::size_t k = 0; k < arguments.size(); ++k) {
        const Argument& other = arguments[k];
        chosen.push_back({other.source, other.isReference,
                          k == i ? std::move(object) : ir::clone(*other.value), other.member});
      }
      emitCall(call, std::move(chosen));
    });
  }
  Aliases aliases;
  for (const Group& group : aliasedGroups(arguments, call.id)) joinAliases(group, arguments, aliases);
  const ir::FunctionId id =
      aliases.empty() ? call.id : module_.function(call.callee, call.where, aliases, call.checks);
  Exprs values;
  for (Argument& argument : arguments) values.push_back(std::move(argument.value));
  if (call.checks) values.push_back(ir::varRef(function_, *failed_, loc));
  emit(loc,
       ir::CallStmt{id, std::move(values), call.result ? ir::varRef(function_, *call.result, loc) : nullptr});
}

/// Calls with reference parameters, or that may push, scatter or print, become statements; others stay expressions.
ExprPtr FunctionLowering::userCall(const clang::CallExpr* e, const clang::FunctionDecl* callee) {
  for (const clang::Stmt* part : e->children()) abandonIfUnknown(part);
  const SourceLocation where = e->getBeginLoc();
  const bool checks = checks_ && module_.hasCheckedVersion(callee);
  const ir::FunctionId id = module_.function(callee, where, {}, checks);
  std::vector<Argument> arguments = argumentsOf(e, callee);
  // copies: lowering an argument may add functions to the table
  const ir::Type resultType = module_.functionAt(id).result;
  const auto first = module_.functionAt(id).variables.begin();
  const std::vector<ir::Variable> parameters(first, first + static_cast<std::ptrdiff_t>(arguments.size()));

  const auto* operation = llvm::dyn_cast<clang::CXXOperatorCallExpr>(e);
  lowerArguments(arguments, parameters, operation != nullptr && operation->isAssignmentOp());
  keepWritten(arguments, parameters);
  const bool hasEffects =
      checks || resultType.isVoid() || module_.marksOf(callee).print != nullptr ||
      std::ranges::any_of(parameters, [](const ir::Variable& parameter) {
        return parameter.role == ir::VarRole::InOut || parameter.role == ir::VarRole::AppendOutput;
      });
  if (!hasEffects) {
    Exprs values;
    for (Argument& argument : arguments) values.push_back(std::move(argument.value));
    return make(resultType, where, ir::Call{id, std::move(values)});
  }
  const Loc loc = module_.loc(where);
  if (returnsThis(callee)) {
    ExprPtr object = ir::clone(*arguments[0].value);
    emitCall({callee, where, id, std::nullopt, checks}, std::move(arguments));
    return object;
  }
  if (resultType.isVoid()) {
    emitCall({callee, where, id, std::nullopt, checks}, std::move(arguments));
    return ir::literal(false, loc);  // never used: the call is void
  }
  const ir::VarId result = temporary(resultType, loc);
  emit(loc, ir::Declare{result, nullptr});
  emitCall({callee, where, id, result, checks}, std::move(arguments));
  return ir::varRef(function_, result, loc);
}

}  // namespace skc::frontend
