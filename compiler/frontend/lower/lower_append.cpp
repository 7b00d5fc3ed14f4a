// SPDX-License-Identifier: MIT
//
// Statements that write streams: push(r, v), and operations on an element of a scatter output, which cannot
// be read, only assigned or combined with a value.
//
//   r[i] = v;   r[i] += v;   r[i] -= v;   ++r[i];   r[i] = min(r[i], v);   r[i] = max(v, r[i]);
#include <llvm/ADT/FoldingSet.h>

#include <clang/AST/ASTContext.h>
#include <clang/AST/ExprCXX.h>

#include "frontend/lower/function_lowering.hpp"
#include "ir/build.hpp"
#include "ir/lvalue.hpp"

namespace skc::frontend {

using clang::SourceLocation;
using ir::ExprPtr;

ir::VarId FunctionLowering::appendVariable(const clang::Expr* e) {
  const auto stream = streamVariable(e);
  if (!stream || function_.variables[*stream].role != ir::VarRole::AppendOutput) {
    module_.fail(Diag::NotAnAppendOutput, e->getBeginLoc());
  }
  return *stream;
}

ExprPtr FunctionLowering::push(const clang::CallExpr* e) {
  const Loc loc = module_.loc(e->getBeginLoc());
  const ir::VarId stream = appendVariable(e->getArg(0));
  ExprPtr pushed = value(e->getArg(1));
  if (!checks_ || isInCondition_)
    emit(loc, ir::Push{{ir::StreamRef::Space::Variable, stream}, std::move(pushed)});
  return ir::literal(false, loc);   // never used: push is void
}

// ---- scatter outputs ----------------------------------------------------------------------------

std::optional<FunctionLowering::ScatterTarget> FunctionLowering::scatterTarget(const clang::Expr* e) const {
  const auto* call = llvm::dyn_cast<clang::CXXOperatorCallExpr>(e->IgnoreParenImpCasts());
  if (!call || call->getOperator() != clang::OO_Subscript) return std::nullopt;
  Subscripts subscripts = subscriptsOf(call);
  const auto stream = streamVariable(subscripts.object);
  if (!stream || function_.variables[*stream].role != ir::VarRole::AppendOutput) return std::nullopt;
  return ScatterTarget{std::move(subscripts), *stream};
}

bool FunctionLowering::scatters(const clang::Expr* e) {
  const auto at = [&](const clang::Expr* left) { return scatterTarget(left); };
  if (const auto* compound = llvm::dyn_cast<clang::CompoundAssignOperator>(e)) {
    const auto target = at(compound->getLHS());
    if (target) scatterCompound(*target, compound);
    return target.has_value();
  }
  if (const auto* operation = llvm::dyn_cast<clang::BinaryOperator>(e);
      operation && operation->getOpcode() == clang::BO_Assign) {
    const auto target = at(operation->getLHS());
    if (target) scatterStore(*target, operation->getLHS(), operation->getRHS());
    return target.has_value();
  }
  if (const auto* call = llvm::dyn_cast<clang::CXXOperatorCallExpr>(e);
      call && call->getOperator() == clang::OO_Equal) {   // assignment of a struct
    const auto target = at(call->getArg(0));
    if (target) scatterStore(*target, call->getArg(0), call->getArg(1));
    return target.has_value();
  }
  if (const auto* operation = llvm::dyn_cast<clang::UnaryOperator>(e);
      operation && operation->isIncrementDecrementOp()) {
    const auto target = at(operation->getSubExpr());
    if (!target) return false;
    const ir::Type type = function_.variables[target->stream].type;
    const Loc loc = module_.loc(operation->getOperatorLoc());
    ExprPtr one = ir::literalOf(type, operation->isIncrementOp() ? 1 : -1, loc);
    scatter(*target, ir::ScatterOp::Add, combinedValue(*target, std::move(one), operation->getOperatorLoc()));
    return true;
  }
  return false;
}

namespace {

std::optional<ir::ScatterOp> extremeOf(llvm::StringRef name) {
  if (name == "min" || name == "fmin") return ir::ScatterOp::Min;
  if (name == "max" || name == "fmax") return ir::ScatterOp::Max;
  return std::nullopt;
}

}  // namespace

/// `r[i] = v`, or `r[i] = min(r[i], v)`, where both lvalues must be the same expression.
void FunctionLowering::scatterStore(const ScatterTarget& target, const clang::Expr* left,
                                    const clang::Expr* right) {
  // C++ evaluates both lvalues, which are one element only if evaluating them changes nothing
  ir::Block effects;
  ir::Block* outer = std::exchange(out_, &effects);
  indexFrom(target.subscripts, target.stream);
  out_ = outer;
  const bool hasEffects = !effects.empty();
  const auto isSame = [&](const clang::Expr* e) {
    llvm::FoldingSetNodeID a, b;
    left->IgnoreParens()->Profile(a, module_.context(), true);
    e->IgnoreParenImpCasts()->Profile(b, module_.context(), true);
    return a == b && !hasEffects;
  };
  const auto* call = llvm::dyn_cast<clang::CallExpr>(right->IgnoreParenImpCasts());
  const clang::FunctionDecl* callee = call ? call->getDirectCallee() : nullptr;
  if (callee && module_.isPrelude(callee) && callee->getIdentifier() && call->getNumArgs() == 2) {
    const auto op = extremeOf(callee->getName());
    const bool isFirst = op && isSame(call->getArg(0));
    if (isFirst || (op && isSame(call->getArg(1)))) {
      const clang::Expr* other = call->getArg(isFirst ? 1 : 0);
      return scatter(target, *op, combinedValue(target, value(other), call->getBeginLoc()));
    }
  }
  scatter(target, ir::ScatterOp::Store, value(right));
}

void FunctionLowering::scatterCompound(const ScatterTarget& target, const clang::CompoundAssignOperator* e) {
  const SourceLocation where = e->getOperatorLoc();
  const bool isSum = e->getOpcode() == clang::BO_AddAssign;
  const ir::Type computed = module_.type(e->getComputationResultType(), where);
  const ir::Variable& appendOutput = function_.variables[target.stream];
  if ((!isSum && e->getOpcode() != clang::BO_SubAssign) || !computed.isArithmetic() ||
      computed.scalar != appendOutput.type.scalar) {
    module_.fail(Diag::ScatterOperation, where, {appendOutput.name, module_.spelling(appendOutput.type)});
  }
  ExprPtr added = combinedValue(target, value(e->getRHS()), where);
  if (!isSum) added = ir::unary(ir::UnaryOp::Negate, std::move(added), module_.loc(where));
  scatter(target, ir::ScatterOp::Add, std::move(added));
}

/// Checks a value to combine with elements: of their component type, one number for all or one each.
ExprPtr FunctionLowering::combinedValue(const ScatterTarget& target, ExprPtr value, SourceLocation where) {
  const ir::Variable& appendOutput = function_.variables[target.stream];
  const ir::Type type = appendOutput.type;
  if (type.is64Bit()) module_.fail(Diag::WideScatter, where, {appendOutput.name, module_.spelling(type)});
  const bool isNumber = type.isFloat() || type.isInteger();
  if (!isNumber || !value->type.isArithmetic() || value->type.scalar != type.scalar ||
      (value->type.width != 1 && value->type.width != type.width)) {
    module_.fail(Diag::ScatterOperation, where, {appendOutput.name, module_.spelling(type)});
  }
  return splat(std::move(value), type.width);
}

/// Evaluates the value before the index, as in any assignment.
void FunctionLowering::scatter(const ScatterTarget& target, ir::ScatterOp op, ExprPtr value) {
  ir::Block effects;
  ir::Block* outer = std::exchange(out_, &effects);
  ExprPtr index = indexFrom(target.subscripts, target.stream);
  out_ = outer;
  if (!effects.empty()) {
    keepValue(value, ir::assignedIn(module_.module(), effects));
    append(std::move(effects));
  }
  if (checks_ && !isInCondition_) return;
  emit(module_.loc(target.subscripts.where),
       ir::Scatter{{ir::StreamRef::Space::Variable, target.stream}, op, std::move(index), std::move(value)});
}

}  // namespace skc::frontend
