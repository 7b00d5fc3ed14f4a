// SPDX-License-Identifier: MIT
#include "transforms/hoist_expressions.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/counted_loop.hpp"
#include "ir/walk.hpp"

namespace skc {

using namespace ir;

namespace {

class Hoister {
 public:
  Hoister(Function& function, FunctionRef<bool(const Expr&)> isHoisted)
      : function_(function), isHoisted_(isHoisted) {}

  void block(Block& statements) {
    Block result;
    for (Stmt& stmt : statements) {
      if (auto* loop = std::get_if<Loop>(&stmt.node)) {
        condition(*loop, stmt.loc);
      } else {
        forEachOperand(stmt, [&](ExprPtr& operand) { expression(operand, result); });
      }
      forEachBlock(stmt, [&](Block& inner) { block(inner); });
      result.push_back(std::move(stmt));
    }
    statements = std::move(result);
  }

 private:
  /// Whether the expression contains one to hoist.
  bool contains(const Expr& expr) const {
    bool found = false;
    walkExprs(expr, [&](const Expr& inner) { found = found || isHoisted_(inner); });
    return found;
  }

  /// Moves what cannot stay in the expression to statements before it.
  void expression(ExprPtr& slot, Block& before) {
    if (!contains(*slot)) return;
    if (Select* const n = branch(*slot)) return choice(slot, *n, before);
    if (auto* n = std::get_if<Binary>(&slot->node);
        n != nullptr && slot->type.isScalar() &&
        (n->op == BinaryOp::LogicalAnd || n->op == BinaryOp::LogicalOr) && contains(*n->rhs)) {
      return logical(slot, *n, before);
    }
    forEachOperand(*slot, [&](ExprPtr& operand) { expression(operand, before); });
  }

  /// The `?:` that must become a branch; null if the expression is another.
  Select* branch(Expr& expr) const {
    auto* n = std::get_if<Select>(&expr.node);
    if (n == nullptr || !n->cond->type.isScalar()) return nullptr;
    return isHoisted_(expr) || contains(*n->yes) || contains(*n->no) ? n : nullptr;
  }

  void choice(ExprPtr& slot, Select& n, Block& before) {
    const Loc loc = slot->loc;
    const VarId var = addVariable(function_, "chosen", slot->type, VarRole::Local, loc);
    before.push_back(declare(var, nullptr, loc));
    choose(var, n, loc, before);
    slot = varRef(function_, var, loc);
  }

  /// Sets the variable to the chosen side. A chain `a ? x : b ? y : z` sets one variable.
  void choose(VarId var, Select& n, Loc loc, Block& before) {
    expression(n.cond, before);
    const auto side = [&](ExprPtr& value) {
      Block statements;
      if (Select* const inner = branch(*value)) {
        choose(var, *inner, loc, statements);
      } else {
        expression(value, statements);
        statements.push_back(assign(varRef(function_, var, loc), std::move(value), loc));
      }
      return statements;
    };
    Block yes = side(n.yes), no = side(n.no);
    before.push_back(ifStmt(std::move(n.cond), std::move(yes), std::move(no), loc));
  }

  void logical(ExprPtr& slot, Binary& n, Block& before) {
    const Loc loc = slot->loc;
    expression(n.lhs, before);
    const VarId var = addVariable(function_, "decided", slot->type, VarRole::Local, loc);
    before.push_back(declare(var, std::move(n.lhs), loc));
    Block rest;
    expression(n.rhs, rest);
    rest.push_back(assign(varRef(function_, var, loc), std::move(n.rhs), loc));
    ExprPtr isOpen = varRef(function_, var, loc);
    if (n.op == BinaryOp::LogicalOr) isOpen = unary(UnaryOp::LogicalNot, std::move(isOpen), loc);
    before.push_back(ifStmt(std::move(isOpen), std::move(rest), {}, loc));
    slot = varRef(function_, var, loc);
  }

  /// Evaluates a loop's condition in each iteration: at the start of its body, or in the step for `do`.
  void condition(Loop& loop, Loc loc) {
    if (!loop.cond) return;
    Block before;
    expression(loop.cond, before);
    if (before.empty()) return;
    if (loop.kind == LoopKind::DoWhile) {
      const VarId again = addVariable(function_, "again", loop.cond->type, VarRole::Local, loc);
      loop.kind = LoopKind::For;
      loop.init = ir::block(declare(again, literal(true, loc), loc));
      loop.step = std::move(before);
      loop.step.push_back(assign(varRef(function_, again, loc), std::move(loop.cond), loc));
      loop.cond = varRef(function_, again, loc);
      return;
    }
    before.push_back(
        ifStmt(unary(UnaryOp::LogicalNot, std::move(loop.cond), loc), ir::block(breakStmt(loc)), {}, loc));
    std::move(loop.body.begin(), loop.body.end(), std::back_inserter(before));
    loop.body = std::move(before);
  }

  Function& function_;
  FunctionRef<bool(const Expr&)> isHoisted_;
};

}  // namespace

void hoistExpressions(Function& function, FunctionRef<bool(const Expr&)> isHoisted) {
  Hoister(function, isHoisted).block(function.body);
}

namespace {

bool hasOpenLoop(const Module& module, const Function& function) {
  bool found = false;
  walkStmts(function.body, [&](const Stmt& stmt) {
    const auto* loop = std::get_if<Loop>(&stmt.node);
    found = found || (loop != nullptr && !isCounted(module, *loop));
  });
  return found;
}

}  // namespace

std::set<FunctionId> longFunctions(const Module& module) {
  std::set<FunctionId> found;
  for (const Kernel& kernel : module.kernels) {
    for (const FunctionId id : functionsOf(module, kernel)) {  // callees first
      const Function& function = module.functions[id];
      const std::vector<FunctionId> called = callees(function);
      const bool callsLong =
          std::ranges::any_of(called, [&](FunctionId callee) { return found.contains(callee); });
      if (callsLong || hasOpenLoop(module, function)) found.insert(id);
    }
  }
  return found;
}

bool callsOneOf(const std::set<FunctionId>& functions, const Expr& expr) {
  bool found = false;
  walkExprs(expr, [&](const Expr& inner) {
    const auto* n = std::get_if<Call>(&inner.node);
    found = found || (n != nullptr && functions.contains(n->callee));
  });
  return found;
}

void hoistCalls(Function& function, const std::set<FunctionId>& functions) {
  hoistExpressions(function, [&](const Expr& expr) {
    const auto* n = std::get_if<Call>(&expr.node);
    return n != nullptr && functions.contains(n->callee);
  });
}

}  // namespace skc
