// SPDX-License-Identifier: MIT
//
// Lowers calls of the user's functions. Arguments are evaluated in C++'s order: a parameter that is a value
// gets the argument's value at that time; a reference gets the object, whose indices are fixed at that time.
#include <algorithm>

#include <clang/AST/DeclCXX.h>
#include <clang/AST/ExprCXX.h>

#include "frontend/lower/function_lowering.hpp"
#include "ir/assigned.hpp"
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
  if (const auto* method = llvm::dyn_cast<clang::CXXMemberCallExpr>(e)) {
    const clang::Expr* object = method->getImplicitObjectArgument();
    arguments.push_back({object, namesObject(object)});
  }
  const auto* method = llvm::dyn_cast<clang::CXXMethodDecl>(callee);
  const bool startsWithObject =
      llvm::isa<clang::CXXOperatorCallExpr>(e) && method != nullptr && method->isInstance();
  for (unsigned i = 0; i < e->getNumArgs(); ++i) {
    const bool isObject = startsWithObject && i == 0;
    const unsigned parameter = i - (startsWithObject ? 1 : 0);
    const bool isReference = isObject || callee->getParamDecl(parameter)->getType()->isReferenceType();
    arguments.push_back({e->getArg(i), isReference && namesObject(e->getArg(i))});
  }
  return arguments;
}

/// Evaluates the arguments one after the other, and keeps those evaluated earlier from the effects of later ones.
void FunctionLowering::lowerArguments(std::vector<Argument>& arguments,
                                      const std::vector<ir::Variable>& parameters, bool rightToLeft) {
  for (std::size_t n = 0; n < arguments.size(); ++n) {
    const std::size_t i = rightToLeft ? arguments.size() - 1 - n : n;
    ir::Block effects;
    ir::Block* outer = std::exchange(out_, &effects);
    arguments[i].value = argument(arguments[i].source, parameters[i]);
    out_ = outer;
    if (effects.empty()) continue;
    const Variables changed = ir::assignedIn(effects);
    for (std::size_t k = 0; k < arguments.size(); ++k) {
      if (k == i || !arguments[k].value) continue;
      const ir::VarRole role = parameters[k].role;
      const bool isStream = role == ir::VarRole::Gather || role == ir::VarRole::AppendOutput ||
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
    if (parameters[i].role == ir::VarRole::InOut) changed.push_back(ir::rootOf(*arguments[i].value));
  }
  std::ranges::sort(changed);
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (parameters[i].role == ir::VarRole::InOut) keepLocation(arguments[i].value, changed);
  }
}

/// References are passed as copies. Reports two of one object if the callee could tell the difference.
void FunctionLowering::checkAliases(const std::vector<Argument>& arguments, ir::FunctionId callee) {
  const ir::Module& module = module_.module();
  const ir::Function& function = module.functions[callee];
  const auto isWritten = [&](std::size_t i) { return function.variables[i].role == ir::VarRole::InOut; };
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (!isWritten(i)) continue;
    const ir::Expr& written = *arguments[i].value;
    for (std::size_t k = 0; k < arguments.size(); ++k) {
      const bool isOther = isWritten(k) ? k > i : arguments[k].isReference;
      if (!isOther || !mayOverlap(module, *arguments[k].value, written)) continue;
      const bool matters = isWritten(k) || ir::readsAfterWriting(module, function, static_cast<ir::VarId>(k),
                                                                 static_cast<ir::VarId>(i),
                                                                 arguments[k].value->type == written.type);
      if (!matters) continue;
      module_.fail(Diag::AliasedArguments, arguments[std::max(i, k)].source->getBeginLoc(),
                   {function_.variables[ir::rootOf(written)].name});
    }
  }
}

/// Calls with reference parameters, or that may push or scatter, become statements; others stay expressions.
ExprPtr FunctionLowering::userCall(const clang::CallExpr* e, const clang::FunctionDecl* callee) {
  for (const clang::Stmt* part : e->children()) abandonIfUnknown(part);
  const SourceLocation where = e->getBeginLoc();
  const ir::FunctionId id = module_.function(callee, where);
  // copies: lowering an argument may add functions to the table
  const ir::Type resultType = module_.functionAt(id).result;
  const auto first = module_.functionAt(id).variables.begin();
  const std::vector<ir::Variable> parameters(first, first + module_.functionAt(id).parameterCount);

  std::vector<Argument> arguments = argumentsOf(e, callee);
  const auto* operation = llvm::dyn_cast<clang::CXXOperatorCallExpr>(e);
  lowerArguments(arguments, parameters, operation != nullptr && operation->isAssignmentOp());
  keepWritten(arguments, parameters);
  checkAliases(arguments, id);
  const bool hasEffects =
      resultType.isVoid() || std::ranges::any_of(parameters, [](const ir::Variable& parameter) {
        return parameter.role == ir::VarRole::InOut || parameter.role == ir::VarRole::AppendOutput;
      });
  Exprs values;
  for (Argument& argument : arguments) values.push_back(std::move(argument.value));
  if (!hasEffects) return make(resultType, where, ir::Call{id, std::move(values)});
  const Loc loc = module_.loc(where);
  if (returnsThis(callee)) {
    ExprPtr object = ir::clone(*values[0]);
    emit(loc, ir::CallStmt{id, std::move(values), nullptr});
    return object;
  }
  if (resultType.isVoid()) {
    emit(loc, ir::CallStmt{id, std::move(values), nullptr});
    return ir::literal(false, loc);  // never used: the call is void
  }
  const ir::VarId result = temporary(resultType, loc);
  emit(loc, ir::Declare{result, nullptr});
  emit(loc, ir::CallStmt{id, std::move(values), ir::varRef(function_, result, loc)});
  return ir::varRef(function_, result, loc);
}

}  // namespace skc::frontend
