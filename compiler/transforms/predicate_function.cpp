// SPDX-License-Identifier: MIT
#include "transforms/predicate_function.hpp"

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/op_weight.hpp"
#include "ir/walk.hpp"
#include "support/overloaded.hpp"
#include "transforms/hoist_expressions.hpp"

namespace skc {

using namespace ir;

namespace {

constexpr Type boolType = Type::of(Scalar::Bool);

ExprPtr both(ExprPtr a, ExprPtr b, Loc loc) {
  if (!a || !b) return a ? std::move(a) : std::move(b);
  return binary(BinaryOp::LogicalAnd, std::move(a), std::move(b), loc);
}
ExprPtr either(ExprPtr a, ExprPtr b, Loc loc) {
  if (!a || !b) return a ? std::move(a) : std::move(b);
  return binary(BinaryOp::LogicalOr, std::move(a), std::move(b), loc);
}
ExprPtr negated(ExprPtr a, Loc loc) { return unary(UnaryOp::LogicalNot, std::move(a), loc); }

/// Turns a local variable into the last parameter, which renumbers the other locals.
void makeParameter(Function& function, VarId var) {
  const VarId place = function.parameterCount;
  const auto moved = [&](VarId old) {
    return old == var ? place : old >= place && old < var ? old + 1 : old;
  };
  const auto first = function.variables.begin() + static_cast<std::ptrdiff_t>(place);
  const auto it = function.variables.begin() + static_cast<std::ptrdiff_t>(var);
  std::rotate(first, it, it + 1);
  function.variables[place].role = VarRole::In;
  ++function.parameterCount;
  walkStmts(function.body, [&](Stmt& stmt) {
    if (auto* n = std::get_if<Declare>(&stmt.node)) n->var = moved(n->var);
  });
  walkExprs(function.body, [&](Expr& expr) {
    if (auto* n = std::get_if<VarRef>(&expr.node)) n->var = moved(n->var);
  });
}

/// True if control never reaches the next statement.
bool isJump(const Stmt& stmt) {
  return std::holds_alternative<Break>(stmt.node) || std::holds_alternative<Continue>(stmt.node) ||
         std::holds_alternative<Return>(stmt.node);
}
bool endsInJump(const Block& block) {
  if (block.empty()) return false;
  if (const auto* inner = std::get_if<Scope>(&block.back().node)) return endsInJump(inner->body);
  return isJump(block.back());
}

bool isTrue(const Expr& expr) {
  const auto* n = std::get_if<Literal>(&expr.node);
  return n != nullptr && n->bits != 0;
}

/// The operands of a chain of `&&`.
void conjuncts(const Expr& expr, std::vector<const Expr*>& list) {
  const auto* n = std::get_if<Binary>(&expr.node);
  if (n == nullptr || n->op != BinaryOp::LogicalAnd) return list.push_back(&expr);
  conjuncts(*n->lhs, list);
  conjuncts(*n->rhs, list);
}

class Predicator {
 public:
  Predicator(const PredicateContext& context, FunctionId id)
      : context_(context),
        id_(id),
        source_(context.module.functions[id]),
        returnsEarly_(context.uniformity.returnsEarly(id)) {
    function_ = {.name = source_.name,
                 .result = source_.result,
                 .variables = source_.variables,
                 .parameterCount = source_.parameterCount,
                 .body = {},
                 .loc = source_.loc,
                 .table = source_.table,
                 .isLibrary = source_.isLibrary};
  }

  Function run() {
    Block& body = function_.body;
    const bool isMasked = context_.masked.contains(id_);
    if (isMasked || returnsEarly_) {
      const VarId active = addMask("active", source_.loc);
      if (!isMasked) body.push_back(declare(active, literal(true, source_.loc), source_.loc));
      masks_.push_back({active, Mask::Function});
    }
    if (returnsEarly_ && !source_.result.isVoid()) {
      result_ = addVariable(function_, "result", source_.result, VarRole::Local, source_.loc);
      body.push_back(declare(*result_, nullptr, source_.loc));
    }
    statements(source_.body, body);
    if (result_ && (body.empty() || !std::holds_alternative<Return>(body.back().node))) {
      body.push_back(returnStmt(ref(*result_, source_.loc), source_.loc));
    }
    if (isMasked) makeParameter(function_, masks_.front().var);
    return std::move(function_);
  }

 private:
  /// A variable that is true in the active lanes. Each mask implies the masks around it.
  struct Mask {
    VarId var;
    enum Kind : std::uint8_t { Function, Branch, Loop, Round, Switch } kind;
  };

  // ---- masks ------------------------------------------------------------------------------------

  VarId addMask(std::string name, Loc loc) {
    return addVariable(function_, std::move(name), boolType, VarRole::Local, loc);
  }
  ExprPtr ref(VarId var, Loc loc) const { return varRef(function_, var, loc); }
  /// The innermost mask; null if all lanes are active.
  ExprPtr mask(Loc loc) const { return masks_.empty() ? nullptr : ref(masks_.back().var, loc); }
  ExprPtr maskOrTrue(Loc loc) const { return masks_.empty() ? literal(true, loc) : mask(loc); }
  ExprPtr anyLane(ExprPtr of, Loc loc) const {
    return intrinsic(Intrinsic::AnyLane, exprs(std::move(of)), loc);
  }

  bool isVarying(const Expr& expr) const {
    return context_.uniformity.of(id_, expr) != analysis::Shape::Uniform;
  }
  bool diverges(const Stmt& stmt) const { return context_.uniformity.diverges(id_, stmt); }
  bool blends(const Stmt& stmt, const Expr& place) const {
    return context_.uniformity.blends(id_, stmt, rootOf(place));
  }

  /// Clears the active lanes in all masks up to the nearest of these kinds.
  void leave(std::initializer_list<Mask::Kind> kinds, Loc loc, Block& out) {
    const auto isLast = [&](const Mask& one) { return std::ranges::find(kinds, one.kind) != kinds.end(); };
    const auto last = std::find_if(masks_.rbegin(), masks_.rend(), isLast);
    for (auto one = std::next(masks_.rbegin()); last != masks_.rbegin() && one != std::next(last); ++one) {
      out.push_back(assign(ref(one->var, loc), both(ref(one->var, loc), negated(mask(loc), loc), loc), loc));
    }
    out.push_back(assign(mask(loc), literal(false, loc), loc));
  }

  // ---- statements -------------------------------------------------------------------------------

  Block statements(std::span<const Stmt> list) {
    Block out;
    statements(list, out);
    return out;
  }

  /// Runs the statements after one that lanes may leave under the mask; skips long ones if no lane is active.
  void statements(std::span<const Stmt> list, Block& out) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      match(list[i].node, [&](const auto& node) { write(list[i], node, out); });
      if (isJump(list[i])) return;
      if (i + 1 == list.size() || !mayLeave(list[i])) continue;
      return guarded(list.subspan(i + 1), list[i].loc, out);
    }
  }

  /// Writes statements under the innermost mask.
  void guarded(std::span<const Stmt> list, Loc loc, Block& out) {
    if (isShort(context_.module, list)) return statements(list, out);
    out.push_back(ifStmt(anyLane(mask(loc), loc), statements(list), {}, loc));
  }

  /// The jumps, besides returns, that leave a statement.
  struct Jumps {
    bool breaks, continues;
  };
  /// True if some lanes may not reach the next statement.
  bool mayLeave(const Stmt& stmt) const { return mayLeave(stmt, {.breaks = true, .continues = true}); }
  bool mayLeave(const Stmt& stmt, Jumps jumps) const {
    if (std::holds_alternative<Return>(stmt.node)) return diverges(stmt);
    if (std::holds_alternative<Break>(stmt.node)) return jumps.breaks && diverges(stmt);
    if (std::holds_alternative<Continue>(stmt.node)) return jumps.continues && diverges(stmt);
    const bool isLoop = std::holds_alternative<ir::Loop>(stmt.node);
    if (isLoop || std::holds_alternative<ir::Switch>(stmt.node)) jumps.breaks = false;
    if (isLoop) jumps.continues = false;
    bool may = false;
    forEachBlock(stmt, [&](const Block& inner) {
      may = may || std::ranges::any_of(inner, [&](const Stmt& one) { return mayLeave(one, jumps); });
    });
    return may;
  }

  void write(const Stmt& stmt, const Declare& n, Block& out) {
    if (!lifted_.contains(n.var)) return out.push_back(declare(n.var, value(n.init), stmt.loc));
    if (n.init) out.push_back(assign(ref(n.var, stmt.loc), value(n.init), stmt.loc));
  }

  void write(const Stmt& stmt, const Assign& n, Block& out) {
    if (!blends(stmt, *n.place)) {
      out.push_back({stmt.loc, Assign{value(n.place), n.op, value(n.value)}});
      return;
    }
    ExprPtr assigned = value(n.value);
    if (n.op) assigned = binary(*n.op, value(n.place), std::move(assigned), stmt.loc);
    out.push_back(blended(value(n.place), std::move(assigned), stmt.loc));
  }

  Stmt blended(ExprPtr place, ExprPtr assigned, Loc loc) const {
    ExprPtr old = clone(place);
    return assign(std::move(place), select(mask(loc), std::move(assigned), std::move(old), loc), loc);
  }

  /// Arguments and results that need a masked store go through copies. The call does not change their indices.
  void write(const Stmt& stmt, const CallStmt& n, Block& out) {
    const Loc loc = stmt.loc;
    const Function& callee = context_.module.functions[n.callee];
    std::vector<ExprPtr> args;
    Block after;
    for (std::size_t i = 0; i < n.args.size(); ++i) {
      const bool isCopied = callee.variables[i].role == VarRole::InOut && blends(stmt, *n.args[i]);
      ExprPtr arg = value(n.args[i]);
      if (isCopied) {
        const VarId copy = addVariable(function_, "copy", arg->type, VarRole::Local, loc);
        out.push_back(declare(copy, clone(arg), loc));
        after.push_back(blended(std::move(arg), ref(copy, loc), loc));
        arg = ref(copy, loc);
      }
      args.push_back(std::move(arg));
    }
    if (context_.masked.contains(n.callee)) args.push_back(maskOrTrue(loc));
    ExprPtr place = value(n.result);
    if (n.result && blends(stmt, *n.result)) {
      const VarId copy = addVariable(function_, "copy", callee.result, VarRole::Local, loc);
      out.push_back(declare(copy, nullptr, loc));
      after.push_back(blended(std::move(place), ref(copy, loc), loc));
      place = ref(copy, loc);
    }
    out.push_back(callStmt(n.callee, std::move(args), std::move(place), loc));
    std::ranges::move(after, std::back_inserter(out));
  }

  void write(const Stmt& stmt, const If& n, Block& out) {
    const Loc loc = stmt.loc;
    if (!diverges(stmt)) {
      out.push_back(ifStmt(value(n.cond), statements(n.then), statements(n.otherwise), loc));
      return;
    }
    const VarId taken = addMask("mask", loc);
    out.push_back(declare(taken, both(mask(loc), value(n.cond), loc), loc));
    branch(taken, n.then, loc, out);
    if (n.otherwise.empty()) return;
    const VarId others = addMask("mask", loc);
    out.push_back(declare(others, both(mask(loc), negated(ref(taken, loc), loc), loc), loc));
    branch(others, n.otherwise, loc, out);
  }

  void branch(VarId taken, const Block& body, Loc loc, Block& out) {
    masks_.push_back({taken, Mask::Branch});
    guarded(body, loc, out);
    masks_.pop_back();
    if (!out.empty() && isCleared(out.back(), taken)) out.pop_back();  // the mask is not read again
  }
  static bool isCleared(const Stmt& stmt, VarId var) {
    const auto* n = std::get_if<Assign>(&stmt.node);
    const auto* place = n == nullptr ? nullptr : std::get_if<VarRef>(&n->place->node);
    return place != nullptr && place->var == var && std::holds_alternative<Literal>(n->value->node);
  }

  // ---- loops ------------------------------------------------------------------------------------

  void write(const Stmt& stmt, const ir::Loop& n, Block& out) {
    if (diverges(stmt)) return divergentLoop(stmt, n, out);
    out.push_back(
        {stmt.loc, ir::Loop{n.kind, statements(n.init), value(n.cond), statements(n.step), round(stmt, n)}});
  }

  /// `for (init, live = condition; AnyLane(live); step, live = live && condition) body`. Uniform operands of
  /// the condition stay in the loop's condition.
  void divergentLoop(const Stmt& stmt, const ir::Loop& n, Block& out) {
    const Loc loc = stmt.loc;
    ir::Loop loop{LoopKind::For, statements(n.init), nullptr, {}, {}};
    const Condition condition = split(n);
    ExprPtr entered = n.kind == LoopKind::DoWhile ? nullptr : all(condition.varying, loc);
    entered = both(mask(loc), std::move(entered), loc);
    const VarId live = addMask("live", loc);
    loop.init.push_back(declare(live, entered ? std::move(entered) : literal(true, loc), loc));
    masks_.push_back({live, Mask::Loop});
    loop.body = round(stmt, n);
    loop.step = step(n, condition, loc);
    loop.cond = both(all(condition.uniform, loc), anyLane(mask(loc), loc), loc);
    masks_.pop_back();
    out.push_back({loc, std::move(loop)});
  }

  struct Condition {
    std::vector<const Expr*> uniform, varying;
  };
  Condition split(const ir::Loop& n) const {
    if (!n.cond) return {};
    if (n.kind == LoopKind::DoWhile) return {{}, {n.cond.get()}};  // not evaluated before the first iteration
    Condition condition;
    std::vector<const Expr*> operands;
    conjuncts(*n.cond, operands);
    for (const Expr* operand : operands) {
      if (isTrue(*operand)) continue;
      const bool isUniform = !isVarying(*operand) && !callsOneOf(context_.isLong, *operand);
      (isUniform ? condition.uniform : condition.varying).push_back(operand);
    }
    return condition;
  }
  ExprPtr all(const std::vector<const Expr*>& operands, Loc loc) const {
    ExprPtr result;
    for (const Expr* operand : operands) result = both(std::move(result), value(*operand), loc);
    return result;
  }

  /// Runs under the loop's mask. Skips what may take long when no lane is left.
  Block step(const ir::Loop& n, const Condition& condition, Loc loc) {
    Block result = statements(n.step);
    if (!condition.varying.empty()) {
      result.push_back(assign(mask(loc), both(mask(loc), all(condition.varying, loc), loc), loc));
    }
    bool isLong = n.cond && callsOneOf(context_.isLong, *n.cond);
    walkStmts(n.step, [&](const Stmt& stmt) {
      const auto* call = std::get_if<CallStmt>(&stmt.node);
      isLong = isLong || (call != nullptr && context_.isLong.contains(call->callee));
    });
    walkExprs(n.step, [&](const Expr& expr) {
      const auto* call = std::get_if<Call>(&expr.node);
      isLong = isLong || (call != nullptr && context_.isLong.contains(call->callee));
    });
    return isLong ? ir::block(ifStmt(anyLane(mask(loc), loc), std::move(result), {}, loc))
                  : std::move(result);
  }

  /// The body; lanes that skip the rest of an iteration are active again in the next.
  Block round(const Stmt& stmt, const ir::Loop& n) {
    if (!context_.uniformity.skips(id_, stmt)) return statements(n.body);
    const VarId active = addMask("round", stmt.loc);
    Block body = ir::block(declare(active, maskOrTrue(stmt.loc), stmt.loc));
    masks_.push_back({active, Mask::Round});
    statements(n.body, body);
    masks_.pop_back();
    return body;
  }

  // ---- switches ---------------------------------------------------------------------------------

  void write(const Stmt& stmt, const ir::Switch& n, Block& out) {
    if (diverges(stmt)) return divergentSwitch(stmt, n, out);
    ir::Switch copy{value(n.value), {}};
    for (const Case& one : n.cases)
      copy.cases.push_back({one.values, one.isDefault, statements(one.body), one.loc});
    out.push_back({stmt.loc, std::move(copy)});
  }

  /// The active lanes are those that matched this case or fell through from the one before. A lane that has
  /// left has had its case, and does not match again.
  void divergentSwitch(const Stmt& stmt, const ir::Switch& n, Block& out) {
    const Loc loc = stmt.loc;
    const VarId chosen = addVariable(function_, "chosen", n.value->type, VarRole::Local, loc);
    out.push_back(declare(chosen, value(n.value), loc));
    for (const Case& one : n.cases) liftDeclarations(one.body, out);
    const VarId running = addMask("running", loc);
    const Case* before = nullptr;
    for (const Case& one : n.cases) {
      ExprPtr joins = both(mask(loc), comesTo(n, one, chosen, loc), loc);
      if (before == nullptr) {
        out.push_back(declare(running, std::move(joins), loc));
      } else {
        const bool fallsThrough = !endsInJump(before->body);
        out.push_back(assign(ref(running, loc),
                             either(fallsThrough ? ref(running, loc) : nullptr, std::move(joins), loc), loc));
      }
      masks_.push_back({running, Mask::Switch});
      guarded(one.body, loc, out);
      masks_.pop_back();
      before = &one;
    }
  }

  /// Moves declarations in front: the cases share one scope, but their bodies may get a branch each.
  void liftDeclarations(const Block& body, Block& out) {
    for (const Stmt& stmt : body) {
      const auto* n = std::get_if<Declare>(&stmt.node);
      if (n == nullptr) continue;
      lifted_.insert(n->var);
      function_.variables[n->var].isConst = false;
      out.push_back(declare(n->var, nullptr, stmt.loc));
    }
  }

  ExprPtr comesTo(const ir::Switch& n, const Case& one, VarId chosen, Loc loc) const {
    const auto isOneOf = [&](const Case& some) {
      ExprPtr any;
      for (const std::int64_t number : some.values) {
        ExprPtr label = makeExpr(n.value->type, Literal{static_cast<std::uint32_t>(number)}, loc);
        any = either(std::move(any), binary(BinaryOp::Equal, ref(chosen, loc), std::move(label), loc), loc);
      }
      return any;
    };
    if (!one.isDefault) return isOneOf(one);
    ExprPtr others;
    for (const Case& other : n.cases) {
      if (!other.isDefault) others = either(std::move(others), isOneOf(other), loc);
    }
    return others ? negated(std::move(others), loc) : literal(true, loc);
  }

  // ---- jumps ------------------------------------------------------------------------------------

  void write(const Stmt& stmt, const Break&, Block& out) {
    if (!diverges(stmt)) return out.push_back(breakStmt(stmt.loc));
    leave({Mask::Loop, Mask::Switch}, stmt.loc, out);
  }
  void write(const Stmt& stmt, const Continue&, Block& out) {
    if (!diverges(stmt)) return out.push_back(continueStmt(stmt.loc));
    leave({Mask::Round}, stmt.loc, out);
  }
  void write(const Stmt& stmt, const Return& n, Block& out) {
    const Loc loc = stmt.loc;
    if (diverges(stmt)) {
      if (n.value) out.push_back(blended(ref(*result_, loc), value(n.value), loc));
      return leave({Mask::Function}, loc, out);
    }
    ExprPtr returned = value(n.value);
    if (result_) returned = select(mask(loc), std::move(returned), ref(*result_, loc), loc);
    out.push_back(returnStmt(std::move(returned), loc));
  }

  // ---- other statements and expressions -----------------------------------------------------------

  void write(const Stmt& stmt, const Scope& n, Block& out) {
    out.push_back(scope(statements(n.body), stmt.loc));
  }
  void write(const Stmt& stmt, const Push& n, Block& out) {
    out.push_back({stmt.loc, Push{n.stream, value(n.value), mask(stmt.loc)}});
  }
  void write(const Stmt& stmt, const Scatter& n, Block& out) {
    out.push_back({stmt.loc, Scatter{n.stream, n.op, value(n.index), value(n.value), mask(stmt.loc)}});
  }
  void write(const Stmt& stmt, const Print& n, Block& out) {
    Print print{n.format, {}, mask(stmt.loc)};
    for (const ExprPtr& one : n.values) print.values.push_back(value(one));
    out.push_back({stmt.loc, std::move(print)});
  }

  ExprPtr value(const ExprPtr& expr) const { return expr ? value(*expr) : nullptr; }
  /// A copy whose calls pass on the mask.
  ExprPtr value(const Expr& expr) const {
    ExprPtr copy = clone(expr);
    walkExprs(*copy, [&](Expr& inner) {
      auto* n = std::get_if<Call>(&inner.node);
      if (n != nullptr && context_.masked.contains(n->callee)) n->args.push_back(maskOrTrue(inner.loc));
    });
    return copy;
  }

  const PredicateContext& context_;
  FunctionId id_;
  const Function& source_;
  Function function_;
  bool returnsEarly_;
  std::optional<VarId> result_;
  std::vector<Mask> masks_;
  std::set<VarId> lifted_;  ///< declared in front of their switch
};

}  // namespace

bool isShort(const Module& module, std::span<const Stmt> statements) {
  constexpr std::uint32_t limit = 12;  // roughly the operations that a mispredicted branch costs
  // most intrinsics are a few operations; a gather is one per lane
  constexpr OpWeights weights = {
      .operation = 1, .intrinsic = 4, .gather = limit, .sample = limit, .append = limit};
  return weigh(module, statements, weights, limit) < limit;
}

Function predicated(const PredicateContext& context, FunctionId id) { return Predicator(context, id).run(); }

}  // namespace skc
