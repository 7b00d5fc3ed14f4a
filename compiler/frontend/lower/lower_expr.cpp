// SPDX-License-Identifier: MIT
//
// Lowers the effects of expressions (assignments, increments, temporaries, order of evaluation) and
// operators. Leaves, casts and initialisers are in lower_value.cpp, calls in lower_call.cpp.
#include <algorithm>
#include <cassert>

#include <clang/AST/ExprCXX.h>

#include "frontend/lower/function_lowering.hpp"
#include "frontend/lower/locations.hpp"
#include "ir/build.hpp"
#include "ir/lvalue.hpp"
#include "ir/operators.hpp"

namespace skc::frontend {

using clang::SourceLocation;
using ir::ExprPtr;

namespace {

std::optional<ir::BinaryOp> binaryOpOf(clang::BinaryOperatorKind kind) {
  switch (kind) {
    case clang::BO_Add:
    case clang::BO_AddAssign: return ir::BinaryOp::Add;
    case clang::BO_Sub:
    case clang::BO_SubAssign: return ir::BinaryOp::Sub;
    case clang::BO_Mul:
    case clang::BO_MulAssign: return ir::BinaryOp::Mul;
    case clang::BO_Div:
    case clang::BO_DivAssign: return ir::BinaryOp::Div;
    case clang::BO_Rem:
    case clang::BO_RemAssign: return ir::BinaryOp::Rem;
    case clang::BO_And:
    case clang::BO_AndAssign: return ir::BinaryOp::BitAnd;
    case clang::BO_Or:
    case clang::BO_OrAssign: return ir::BinaryOp::BitOr;
    case clang::BO_Xor:
    case clang::BO_XorAssign: return ir::BinaryOp::BitXor;
    case clang::BO_Shl:
    case clang::BO_ShlAssign: return ir::BinaryOp::ShiftLeft;
    case clang::BO_Shr:
    case clang::BO_ShrAssign: return ir::BinaryOp::ShiftRight;
    case clang::BO_LT: return ir::BinaryOp::Less;
    case clang::BO_LE: return ir::BinaryOp::LessEqual;
    case clang::BO_GT: return ir::BinaryOp::Greater;
    case clang::BO_GE: return ir::BinaryOp::GreaterEqual;
    case clang::BO_EQ: return ir::BinaryOp::Equal;
    case clang::BO_NE: return ir::BinaryOp::NotEqual;
    case clang::BO_LAnd: return ir::BinaryOp::LogicalAnd;
    case clang::BO_LOr: return ir::BinaryOp::LogicalOr;
    default: return std::nullopt;
  }
}

bool isArithmeticOp(ir::BinaryOp op) { return op <= ir::BinaryOp::Rem; }
bool isShift(ir::BinaryOp op) { return op == ir::BinaryOp::ShiftLeft || op == ir::BinaryOp::ShiftRight; }

/// The equivalent of an operator on two bool vectors; nullopt for arithmetic operators.
std::optional<ir::BinaryOp> ofBools(ir::BinaryOp op) {
  if (op == ir::BinaryOp::BitAnd) return ir::BinaryOp::LogicalAnd;
  if (op == ir::BinaryOp::BitOr) return ir::BinaryOp::LogicalOr;
  if (op == ir::BinaryOp::BitXor) return ir::BinaryOp::NotEqual;
  if (op == ir::BinaryOp::Equal || op == ir::BinaryOp::NotEqual) return op;
  return std::nullopt;
}

/// Removes the splat from `v * float4(2.0)`, as Clang represents `v * 2.0`.
ExprPtr withoutSplat(ExprPtr e) {
  auto* construct = std::get_if<ir::Construct>(&e->node);
  if (!construct || !e->type.isVector() || construct->args.size() != 1 ||
      !construct->args[0]->type.isScalar())
    return e;
  return std::move(construct->args[0]);
}

bool isStable(const ExprPtr& e, const ir::Function& function) {
  if (std::holds_alternative<ir::Literal>(e->node) || std::holds_alternative<ir::ConstantRef>(e->node))
    return true;
  const auto* reference = std::get_if<ir::VarRef>(&e->node);
  return reference && function.variables[reference->var].isConst;
}

}  // namespace

// ---- effects ------------------------------------------------------------------------------------

ExprPtr FunctionLowering::value(const clang::Expr* e) {
  const Level level(depth_);
  checkDepth(e->getExprLoc());
  return Visit(e);
}

void FunctionLowering::checkDepth(SourceLocation where) {
  if (depth_ > deepestNesting) module_.fail(Diag::NestedTooDeep, where, {std::to_string(deepestNesting)});
}

/// Lowers an expression whose value is unused: only its effects remain.
void FunctionLowering::discarded(const clang::Expr* e) {
  e = e->IgnoreParens();
  if (scatters(e)) return;
  if (const auto* cleanups = llvm::dyn_cast<clang::ExprWithCleanups>(e))
    return discarded(cleanups->getSubExpr());
  if (const auto* cast = llvm::dyn_cast<clang::CastExpr>(e); cast && cast->getType()->isVoidType()) {
    return discarded(cast->getSubExpr());
  }
  if (const auto* compound = llvm::dyn_cast<clang::CompoundAssignOperator>(e)) {
    compoundAssign(compound, false);
    return;
  }
  if (const auto* operation = llvm::dyn_cast<clang::BinaryOperator>(e)) {
    if (operation->getOpcode() == clang::BO_Assign) {
      assign(operation, false);
      return;
    }
    if (operation->getOpcode() == clang::BO_Comma) {
      discarded(operation->getLHS());
      return discarded(operation->getRHS());
    }
  }
  if (const auto* operation = llvm::dyn_cast<clang::UnaryOperator>(e);
      operation && operation->isIncrementDecrementOp()) {
    increment(operation, false);
    return;
  }
  if (const auto* choice = llvm::dyn_cast<clang::ConditionalOperator>(e);
      choice && choice->getType()->isVoidType()) {
    ir::If result;
    result.cond = condition(choice->getCond());
    ir::Block* outer = std::exchange(out_, &result.then);
    discarded(choice->getTrueExpr());
    out_ = &result.otherwise;
    discarded(choice->getFalseExpr());
    out_ = outer;
    return emit(module_.loc(e->getBeginLoc()), std::move(result));
  }
  value(e);
}

ExprPtr FunctionLowering::valueInto(const clang::Expr* e, ir::Block& block, bool asDouble) {
  ir::Block* outer = std::exchange(out_, &block);
  ExprPtr result;
  try {
    result = asDouble && isLiterals(e) ? literalsAsDouble(e) : value(e);
  } catch (const Abandoned&) {
    out_ = outer;
    throw;
  }
  out_ = outer;
  return result;
}

FunctionLowering::Exprs FunctionLowering::valuesInOrder(llvm::ArrayRef<const clang::Expr*> expressions,
                                                        unsigned asDoubles) {
  Exprs values;
  for (const auto& [i, e] : llvm::enumerate(expressions)) {
    ir::Block effects;
    ExprPtr result = valueInto(e, effects, (asDoubles >> i & 1U) != 0);
    if (!effects.empty()) {
      const Variables changed = ir::assignedIn(module_.module(), effects);
      for (ExprPtr& earlier : values) keepValue(earlier, changed);
      append(std::move(effects));
    }
    values.push_back(std::move(result));
  }
  return values;
}

/// Saves the present value of `e` in a temporary.
void FunctionLowering::spill(ExprPtr& e) {
  if (isStable(e, function_)) return;
  const Loc loc = e->loc;
  const ir::VarId kept = temporary(e->type, loc);
  emit(loc, ir::Declare{kept, std::move(e)});
  e = ir::varRef(function_, kept, loc);
}

/// Saves the value of `e` if the coming effects could change it.
void FunctionLowering::keepValue(ExprPtr& e, const Variables& changed) {
  if (ir::readsAny(*e, changed)) spill(e);
}

/// Fixes which object `e` names, not its value: saves the indices and conditions that the coming effects could change.
void FunctionLowering::keepLocation(ExprPtr& e, const Variables& changed) {
  if (!isLocation(*e)) return keepValue(e, changed);
  if (auto* index = std::get_if<ir::Index>(&e->node)) {
    keepLocation(index->base, changed);
    keepValue(index->index, changed);
  } else if (auto* member = std::get_if<ir::Member>(&e->node)) {
    keepLocation(member->base, changed);
  } else if (auto* swizzle = std::get_if<ir::Swizzle>(&e->node)) {
    keepLocation(swizzle->base, changed);
  } else if (auto* choice = std::get_if<ir::Select>(&e->node)) {
    keepValue(choice->cond, changed);
    keepLocation(choice->yes, changed);
    keepLocation(choice->no, changed);
  } else if (!std::holds_alternative<ir::VarRef>(e->node)) {
    keepValue(e, changed);
  }
}

/// Adds the effects of an expression, after what they could change has been kept.
void FunctionLowering::append(ir::Block effects) {
  for (ir::Stmt& s : effects) out_->push_back(std::move(s));
}

ir::VarId FunctionLowering::temporary(ir::Type type, Loc loc) {
  ir::Variable variable;
  variable.name = "t";
  variable.type = type;
  variable.loc = loc;
  function_.variables.push_back(std::move(variable));
  return static_cast<ir::VarId>(function_.variables.size() - 1);
}

/// Lowers `e` as a location. Clang has checked that it is assignable.
ExprPtr FunctionLowering::place(const clang::Expr* e) {
  ExprPtr result = value(e);
  if (const auto* read = std::get_if<ir::GatherRead>(&result->node)) {  // of structs, which C++ can assign to
    const std::string& gather = function_.variables[read->stream.id].name;
    module_.fail(Diag::GatherAssigned, e->getBeginLoc(), {gather + "[...]", gather});
  }
  if (!isWritable(*result)) module_.fail(Diag::NotAPlace, e->getBeginLoc());
  for (const ir::VarId root : rootsOf(*result)) {  // by a cast, which takes const away
    const ir::Variable& variable = function_.variables[root];
    if (!ir::isAssignable(variable)) module_.fail(Diag::ConstantAssigned, e->getBeginLoc(), {variable.name});
  }
  return result;
}

/// Evaluates the target of an assignment after its right side, as C++17 does.
FunctionLowering::Sides FunctionLowering::sidesOf(const clang::Expr* left, ExprPtr right) {
  ir::Block effects;
  ir::Block* outer = std::exchange(out_, &effects);
  ExprPtr target = place(left);
  out_ = outer;
  if (!effects.empty()) {
    keepValue(right, ir::assignedIn(module_.module(), effects));
    append(std::move(effects));
  }
  return {std::move(target), std::move(right)};
}

/// Lets `use` emit statements for the object that a location names: once, or once in each branch of a choice.
void FunctionLowering::withObject(ExprPtr location, FunctionRef<void(ExprPtr)> use) {
  ir::Select* choice = choiceIn(*location);
  if (choice == nullptr) return use(std::move(location));
  const Loc loc = location->loc;
  ir::If branch;
  branch.cond = std::move(choice->cond);
  choice->cond = ir::literal(true, loc);
  ExprPtr other = ir::clone(*location);
  choose(location, true);
  choose(other, false);
  ir::Block* outer = std::exchange(out_, &branch.then);
  withObject(std::move(location), use);
  out_ = &branch.otherwise;
  withObject(std::move(other), use);
  out_ = outer;
  emit(loc, std::move(branch));
}

/// Emits `target (op)= right`, and returns the target as a value if it is wanted, else null.
ExprPtr FunctionLowering::store(Sides sides, std::optional<ir::BinaryOp> op, Loc loc, bool wantValue) {
  ExprPtr result;
  if (wantValue) {
    keepLocation(sides.target, rootsOf(*sides.target));
    result = ir::clone(*sides.target);
  }
  assign(std::move(sides), op, loc);
  return result;
}

void FunctionLowering::assign(Sides sides, std::optional<ir::BinaryOp> op, Loc loc) {
  if (choiceIn(*sides.target) != nullptr) spill(sides.right);
  withObject(std::move(sides.target),
             [&](ExprPtr object) { emit(loc, ir::Assign{std::move(object), op, ir::clone(*sides.right)}); });
}

ExprPtr FunctionLowering::assign(const clang::BinaryOperator* e, bool wantValue) {
  return store(sidesOf(e->getLHS(), value(e->getRHS())), std::nullopt, module_.loc(e->getBeginLoc()),
               wantValue);
}

ExprPtr FunctionLowering::compoundAssign(const clang::CompoundAssignOperator* e, bool wantValue) {
  const ir::BinaryOp op = *binaryOpOf(e->getOpcode());
  Sides sides = sidesOf(e->getLHS(), value(e->getRHS()));
  const ir::Type type = sides.target->type;
  const ir::Type computed = module_.type(e->getComputationResultType(), e->getOperatorLoc());
  const Loc loc = module_.loc(e->getBeginLoc());
  const bool isSignedRemainder =
      op == ir::BinaryOp::Rem && computed.scalar == ir::Scalar::Int;  // is a function in GLSL
  const bool isNumber = computed.isArithmetic() && !computed.isBool() && !computed.isNarrow();
  if (isNumber && computed.scalar == type.scalar && !isSignedRemainder) {
    if (isShift(op)) sides.right = shiftCount(std::move(sides.right));
    if (isArithmeticOp(op)) sides.right = withoutSplat(std::move(sides.right));
    return store(std::move(sides), op, loc, wantValue);
  }
  // `i += 0.5f` computes in float and converts back; a storage type computes in its arithmetic type
  ExprPtr left = convert(ir::clone(*sides.target), computed.scalar);
  ExprPtr wide = binary(op, std::move(left), std::move(sides.right), e->getOperatorLoc());
  sides.right = convert(std::move(wide), type.scalar);
  return store(std::move(sides), std::nullopt, loc, wantValue);
}

ExprPtr FunctionLowering::increment(const clang::UnaryOperator* e, bool wantValue) {
  Sides sides{place(e->getSubExpr()), nullptr};
  const Loc loc = module_.loc(e->getBeginLoc());
  const ir::Type type = sides.target->type;
  if (type.isBool()) module_.fail(Diag::Statement, e->getBeginLoc(), {"++ of a bool"});
  ExprPtr before;
  if (wantValue && e->isPostfix()) {
    before = ir::clone(*sides.target);
    spill(before);
  }
  const ir::BinaryOp op = e->isIncrementOp() ? ir::BinaryOp::Add : ir::BinaryOp::Sub;
  sides.right = ir::literalOf(type.arithmeticType().component(), 1, loc);
  const bool wantAfter = wantValue && e->isPrefix();
  ExprPtr after;
  if (type.isNarrow()) {
    ExprPtr wide = binary(op, ir::clone(*sides.target), std::move(sides.right), e->getOperatorLoc());
    sides.right = convert(std::move(wide), type.scalar);
    after = store(std::move(sides), std::nullopt, loc, wantAfter);
  } else {
    after = store(std::move(sides), op, loc, wantAfter);
  }
  return before ? std::move(before) : std::move(after);
}

// ---- operators ----------------------------------------------------------------------------------

ExprPtr FunctionLowering::VisitUnaryOperator(const clang::UnaryOperator* e) {
  const SourceLocation where = e->getOperatorLoc();
  switch (e->getOpcode()) {
    case clang::UO_PreInc:
    case clang::UO_PreDec:
    case clang::UO_PostInc:
    case clang::UO_PostDec: return increment(e, true);
    case clang::UO_Plus: return value(e->getSubExpr());
    case clang::UO_Minus: {
      ExprPtr operand = value(e->getSubExpr());
      const ir::Type written = operand->type;
      operand = convert(std::move(operand), ir::arithmeticScalar(written.scalar));
      if (const auto* constant = std::get_if<ir::Literal>(&operand->node);
          constant && !operand->type.isBool()) {
        // reads -1 as a literal: flips the sign bit of a float, negates an integer with wrap-around
        if (operand->type.isDouble()) {
          return make(operand->type, where, ir::Literal{constant->bits, constant->high ^ 0x80000000u});
        }
        // what the text of a float has beyond the float belongs to its magnitude
        if (operand->type.arithmeticType().isFloat())
          return make(operand->type, where, ir::Literal{constant->bits ^ 0x80000000u, 0, constant->text});
        return literal(operand->type, 0u - constant->wide(), where);
      }
      const ir::Type type = operand->type;
      if (type.isBool()) module_.fail(Diag::Statement, where, {"arithmetic of bool vectors"});
      return convert(make(type, where, ir::Unary{ir::UnaryOp::Negate, std::move(operand)}), written.scalar);
    }
    case clang::UO_Not: {
      ExprPtr operand = value(e->getSubExpr());
      const ir::Type written = operand->type;
      operand = convert(std::move(operand), ir::arithmeticScalar(written.scalar));
      const ir::Type type = operand->type;
      const ir::UnaryOp op = type.isBool() ? ir::UnaryOp::LogicalNot : ir::UnaryOp::BitNot;
      return convert(make(type, where, ir::Unary{op, std::move(operand)}), written.scalar);
    }
    case clang::UO_LNot: {
      ExprPtr operand = toBool(value(e->getSubExpr()));
      const ir::Type type = operand->type;
      ExprPtr result = make(type, where, ir::Unary{ir::UnaryOp::LogicalNot, std::move(operand)});
      const ir::Type wanted = module_.type(e->getType(), where);
      return type.isVector() && !wanted.isBool() ? convert(mask(std::move(result)), wanted.scalar)
                                                 : std::move(result);
    }
    case clang::UO_Deref:
      if (const auto* self = llvm::dyn_cast<clang::CXXThisExpr>(e->getSubExpr()->IgnoreParenImpCasts())) {
        return VisitCXXThisExpr(self);
      }
      value(e->getSubExpr());  // reports a more specific error, if there is one
      module_.fail(Diag::Pointer, where, {e->getSubExpr()->getType().getAsString()});
    case clang::UO_AddrOf: module_.fail(Diag::Pointer, where, {e->getType().getAsString()});
    case clang::UO_Extension: return value(e->getSubExpr());
    case clang::UO_Real:
    case clang::UO_Imag:
    case clang::UO_Coawait: break;
  }
  return VisitExpr(e);
}

ExprPtr FunctionLowering::VisitBinaryOperator(const clang::BinaryOperator* e) {
  if (e->getOpcode() == clang::BO_Assign) return assign(e, true);
  if (e->getOpcode() == clang::BO_Comma) {
    discarded(e->getLHS());
    return value(e->getRHS());
  }
  if (e->isLogicalOp()) return logical(e);
  const auto op = binaryOpOf(e->getOpcode());
  if (!op) return VisitExpr(e);
  Exprs operands = valuesInOrder({e->getLHS(), e->getRHS()});
  ExprPtr result = binary(*op, std::move(operands[0]), std::move(operands[1]), e->getOperatorLoc());
  // vectors of a storage type are rounded to it after each operation
  return convert(std::move(result), module_.type(e->getType(), e->getOperatorLoc()).scalar);
}

ExprPtr FunctionLowering::VisitCompoundAssignOperator(const clang::CompoundAssignOperator* e) {
  return compoundAssign(e, true);
}

/// A count of 64 bits as an int: counts are taken modulo the width, which the low bits tell.
ExprPtr FunctionLowering::shiftCount(ExprPtr count) {
  return count->type.isLong() ? convert(std::move(count), ir::Scalar::Int) : std::move(count);
}

ExprPtr FunctionLowering::binary(ir::BinaryOp op, ExprPtr lhs, ExprPtr rhs, SourceLocation where) {
  assert(lhs->type.isArithmetic() && rhs->type.isArithmetic());  // otherwise Clang finds no operator
  lhs = convert(std::move(lhs), ir::arithmeticScalar(lhs->type.scalar));
  rhs = convert(std::move(rhs), ir::arithmeticScalar(rhs->type.scalar));
  if (isShift(op)) rhs = shiftCount(std::move(rhs));
  if (isArithmeticOp(op) && lhs->type.isVector()) {
    // keep `2 * v` as written; two splats stay vectors
    ExprPtr bare = withoutSplat(std::move(rhs));
    if (bare->type.isVector()) lhs = withoutSplat(std::move(lhs));
    rhs = std::move(bare);
  }
  const bool compares = ir::isComparison(op) && lhs->type.isVector();
  const bool haveBools = lhs->type.isBool() || rhs->type.isBool();
  if (haveBools && (lhs->type.isVector() || rhs->type.isVector())) {
    const auto logical = ofBools(op);
    if (!logical || lhs->type.isBool() != rhs->type.isBool())
      module_.fail(Diag::Statement, where, {"arithmetic of bool vectors"});
    op = *logical;
  }
  ExprPtr result = ir::binary(op, std::move(lhs), std::move(rhs), module_.loc(where));
  return compares ? mask(std::move(result)) : std::move(result);
}

/// && and ||: the right side's effects happen only if its value is needed.
ExprPtr FunctionLowering::logical(const clang::BinaryOperator* e) {
  const SourceLocation where = e->getOperatorLoc();
  const bool isAnd = e->getOpcode() == clang::BO_LAnd;
  const ir::BinaryOp op = isAnd ? ir::BinaryOp::LogicalAnd : ir::BinaryOp::LogicalOr;
  if (e->getType()->isVectorType()) {
    Exprs operands = valuesInOrder({e->getLHS(), e->getRHS()});
    ExprPtr both =
        ir::binary(op, toBool(std::move(operands[0])), toBool(std::move(operands[1])), module_.loc(where));
    return convert(mask(std::move(both)), module_.type(e->getType(), where).scalar);
  }
  ExprPtr lhs = condition(e->getLHS());
  ir::Block effects;
  ExprPtr rhs = toBool(valueInto(e->getRHS(), effects));
  if (effects.empty()) return ir::binary(op, std::move(lhs), std::move(rhs), module_.loc(where));
  const Loc loc = module_.loc(where);
  const ir::VarId result = temporary(ir::Type::of(ir::Scalar::Bool), loc);
  emit(loc, ir::Declare{result, std::move(lhs)});
  effects.push_back(ir::assign(ir::varRef(function_, result, loc), std::move(rhs), loc));
  ExprPtr cond = ir::varRef(function_, result, loc);
  if (!isAnd) cond = ir::unary(ir::UnaryOp::LogicalNot, std::move(cond), loc);
  emit(loc, ir::If{std::move(cond), std::move(effects), {}});
  return ir::varRef(function_, result, loc);
}

/// Declares the block's variables in front of it, so that they can be used behind it.
void FunctionLowering::hoistDeclarations(ir::Block& block) {
  ir::Block rest;
  for (ir::Stmt& s : block) {
    auto* declare = std::get_if<ir::Declare>(&s.node);
    if (declare == nullptr) {
      rest.push_back(std::move(s));
      continue;
    }
    ExprPtr initial = std::move(declare->init);
    emit(s.loc, ir::Declare{declare->var, nullptr});
    if (initial)
      rest.push_back(ir::assign(ir::varRef(function_, declare->var, s.loc), std::move(initial), s.loc));
  }
  block = std::move(rest);
}

ExprPtr FunctionLowering::VisitConditionalOperator(const clang::ConditionalOperator* e) {
  const SourceLocation where = e->getQuestionLoc();
  ExprPtr cond = condition(e->getCond());
  if (cond->type.isVector()) {
    Exprs sides = valuesInOrder({e->getTrueExpr(), e->getFalseExpr()});
    return select(std::move(cond), std::move(sides[0]), std::move(sides[1]), where);
  }
  ir::Block yesEffects, noEffects;
  ExprPtr yes = valueInto(e->getTrueExpr(), yesEffects);
  ExprPtr no = valueInto(e->getFalseExpr(), noEffects);
  if (yesEffects.empty() && noEffects.empty())
    return select(std::move(cond), std::move(yes), std::move(no), where);
  const Loc loc = module_.loc(where);
  if (e->isGLValue() && isLocation(*yes) && isLocation(*no)) {  // names one of two objects after the effects
    spill(cond);
    hoistDeclarations(yesEffects);
    hoistDeclarations(noEffects);
    emit(loc, ir::If{ir::clone(*cond), std::move(yesEffects), std::move(noEffects)});
    return select(std::move(cond), std::move(yes), std::move(no), where);
  }
  const ir::VarId result = temporary(yes->type, loc);
  emit(loc, ir::Declare{result, nullptr});
  yesEffects.push_back(ir::assign(ir::varRef(function_, result, loc), std::move(yes), loc));
  noEffects.push_back(ir::assign(ir::varRef(function_, result, loc), std::move(no), loc));
  emit(loc, ir::If{std::move(cond), std::move(yesEffects), std::move(noEffects)});
  return ir::varRef(function_, result, loc);
}

ExprPtr FunctionLowering::select(ExprPtr cond, ExprPtr yes, ExprPtr no, SourceLocation where) {
  const ir::Type type = yes->type;
  return make(type, where, ir::Select{std::move(cond), std::move(yes), std::move(no)});
}

bool FunctionLowering::namesObject(const clang::Expr* e) {
  while (true) {
    e = e->IgnoreParens();
    const auto* cast = llvm::dyn_cast<clang::ImplicitCastExpr>(e);
    if (!cast || cast->getCastKind() != clang::CK_NoOp) break;
    e = cast->getSubExpr();
  }
  const bool isThis = e->getType()->isPointerType();  // the object of a call within a method
  return isThis || (e->isLValue() && !llvm::isa<clang::MaterializeTemporaryExpr>(e));
}

ExprPtr FunctionLowering::argument(const clang::Expr* e, const ir::Variable& parameter) {
  switch (parameter.role) {
    case ir::VarRole::AppendOutput:
    case ir::VarRole::Gather: {
      const ir::VarId stream = parameter.role == ir::VarRole::Gather ? gatherVariable(e) : appendVariable(e);
      return ir::makeExpr(function_.variables[stream].type, ir::VarRef{stream},
                          module_.loc(e->getBeginLoc()));
    }
    case ir::VarRole::InOut: {
      if (namesObject(e)) return place(e);  // Clang binds references only to the same type
      // a method that changes its object may be called on a value
      ExprPtr object = value(e);
      const Loc loc = object->loc;
      const ir::VarId kept = temporary(object->type, loc);
      emit(loc, ir::Declare{kept, std::move(object)});
      return ir::varRef(function_, kept, loc);
    }
    case ir::VarRole::Element:
      // an argument of another type is a value, and is converted
      if (const auto stream = streamVariable(e);
          stream && function_.variables[*stream].type == parameter.type) {
        return ir::makeExpr(function_.variables[*stream].type, ir::VarRef{*stream},
                            module_.loc(e->getBeginLoc()));
      }
      return value(e);
    case ir::VarRole::In:
    case ir::VarRole::Local: break;
  }
  return value(e);
}

/// Abandons the statement if it uses a variable whose declaration was an error: one message is enough.
void FunctionLowering::abandonIfUnknown(const clang::Stmt* s) const {
  const auto* expression = llvm::dyn_cast_or_null<clang::Expr>(s);
  if (!expression) return;
  expression = expression->IgnoreParenImpCasts();
  if (const auto* member = llvm::dyn_cast<clang::MemberExpr>(expression))
    return abandonIfUnknown(member->getBase());
  const auto* reference = llvm::dyn_cast<clang::DeclRefExpr>(expression);
  const auto* variable = reference ? llvm::dyn_cast<clang::VarDecl>(reference->getDecl()) : nullptr;
  if (!variable || !variable->isLocalVarDeclOrParm() || variables_.contains(variable)) return;
  if (module_.bundles().placeOf(reference)) return;
  if (variable->isStaticLocal() && variable->getType().isConstQualified()) return;
  if (initialising_.contains(variable))
    module_.fail(Diag::OwnInitialValue, s->getBeginLoc(), {ModuleLowering::nameOf(variable)});
  throw Abandoned{};
}

}  // namespace skc::frontend
