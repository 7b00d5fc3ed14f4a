// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <utility>

#include "ir/build.hpp"
#include "ir/evaluate.hpp"
#include "ir/lvalue.hpp"
#include "ir/operators.hpp"
#include "ir/walk.hpp"
#include "support/overloaded.hpp"
#include "transforms/condition.hpp"

namespace skc {
namespace {

using namespace ir;

/// For each variable of a function, its value in terms of the kernel's Spec variables; null if it depends on
/// anything else.
using PassedValues = std::vector<ExprPtr>;

/// Each call is analysed separately. If a program has more calls than this along its call tree, all its
/// streams count as needed.
constexpr int mostAnalysedCalls = 2000;
/// A switch with more counts as one on an unknown value: its conditions would be too long.
constexpr std::size_t mostCases = 60;

bool isFollowed(BinaryOp op, Type operands) {
  const bool givesBool = isComparison(op) || op == BinaryOp::LogicalAnd || op == BinaryOp::LogicalOr;
  return row(op).isInConditions && (givesBool ? !operands.is64Bit() : operands.isInteger());
}

/// True if control never reaches the end of a block.
bool leaves(const Block& block) {
  if (block.empty()) return false;
  const Stmt::Node& last = block.back().node;
  if (const auto* n = std::get_if<If>(&last)) return leaves(n->then) && leaves(n->otherwise);
  if (const auto* n = std::get_if<Scope>(&last)) return leaves(n->body);
  return std::holds_alternative<Return>(last) || std::holds_alternative<Break>(last) ||
         std::holds_alternative<Continue>(last);
}

template <class T>
std::size_t countOf(const Block& block) {
  std::size_t count = 0;
  walkStmts(block, [&](const Stmt& stmt) { count += std::holds_alternative<T>(stmt.node) ? 1 : 0; });
  return count;
}

bool returnsWithin(const Stmt& stmt) {
  bool found = std::holds_alternative<Return>(stmt.node);
  forEachBlock(stmt, [&](const Block& inner) { found = found || countOf<Return>(inner) > 0; });
  return found;
}

/// True if a case can only be left by its last statement, by a return, or by falling through.
bool isLeftAtItsEnd(const Block& body) {
  const bool breaks = !body.empty() && std::holds_alternative<Break>(body.back().node);
  return countOf<Break>(body) == (breaks ? 1 : 0);
}

/// Analyses one kernel and collects, for each parameter, the conditions of its uses.
class UseAnalysis {
 public:
  UseAnalysis(const Module& module, const Kernel& kernel)
      : module_(module), kernel_(kernel), uses_(kernel.params.size()) {}

  std::vector<AnyOf> run() {
    const Function& entry = module_.functions[kernel_.entry];
    PassedValues values(entry.variables.size());
    for (VarId i = 0; i < kernel_.params.size(); ++i) {
      if (kernel_.params[i].role == ParamRole::Spec) values[i] = varRef(entry, i);
    }
    analyse(kernel_.entry, std::move(values), *literal(true));
    return std::move(uses_);
  }

 private:
  /// The function being analysed.
  struct Frame {
    const Function& function;
    bool isEntry;
    std::vector<bool> changed;
    PassedValues values;
  };

  void analyse(FunctionId id, PassedValues values, const Expr& guard) {
    const Function& function = module_.functions[id];
    if (++calls_ > mostAnalysedCalls) {
      for (AnyOf& use : uses_) use.add(*literal(true));
      return;
    }
    Frame frame = frameOf(id, std::move(values));
    block(frame, function.body, guard);
  }

  Frame frameOf(FunctionId id, PassedValues values) const {
    const Function& function = module_.functions[id];
    Frame frame{function, id == kernel_.entry, assignedVariables(module_, function), std::move(values)};
    for (std::size_t i = 0; i < frame.values.size(); ++i) {
      if (frame.changed[i]) frame.values[i] = nullptr;
    }
    return frame;
  }

  // ---- statements -------------------------------------------------------------------------------

  /// `if (!spec) return;` guards the statements after it.
  void block(Frame& frame, const Block& statements, const Expr& outer) {
    ExprPtr guard = clone(outer);
    for (const Stmt& stmt : statements) {
      match(stmt.node, [&](const auto& n) { statement(frame, n, *guard); });
      const auto* branch = std::get_if<If>(&stmt.node);
      if (branch == nullptr) continue;
      const ExprPtr cond = value(frame, *branch->cond);
      if (!cond || isTooLong(*guard)) continue;   // a shorter guard holds more often
      if (leaves(branch->then)) guard = andOf(*guard, *notOf(*cond));
      if (leaves(branch->otherwise)) guard = andOf(*guard, *cond);
    }
  }

  void statement(Frame& frame, const Declare& n, const Expr& guard) {
    if (!n.init) return;
    expression(frame, *n.init, guard);
    remember(frame, n);
  }
  void statement(Frame& frame, const Assign& n, const Expr& guard) {
    expression(frame, *n.place, guard);
    expression(frame, *n.value, guard);
  }
  void statement(Frame& frame, const CallStmt& n, const Expr& guard) {
    for (const ExprPtr& arg : n.args) expression(frame, *arg, guard);
    if (n.result) expression(frame, *n.result, guard);
    call(frame, n.callee, n.args, guard);
  }
  void statement(Frame& frame, const If& n, const Expr& guard) {
    expression(frame, *n.cond, guard);
    const ExprPtr cond = value(frame, *n.cond);
    block(frame, n.then, cond ? *andOf(guard, *cond) : guard);
    block(frame, n.otherwise, cond ? *andOf(guard, *notOf(*cond)) : guard);
  }
  void statement(Frame& frame, const Loop& n, const Expr& guard) {
    block(frame, n.init, guard);
    if (n.cond) expression(frame, *n.cond, guard);
    block(frame, n.body, guard);
    block(frame, n.step, guard);
  }
  /// A case runs for its own values, and if the case before falls through.
  void statement(Frame& frame, const Switch& n, const Expr& guard) {
    expression(frame, *n.value, guard);
    const ExprPtr chosen = value(frame, *n.value);
    if (!chosen || valuesOf(n) > mostCases) {
      for (const Case& one : n.cases) block(frame, one.body, guard);
      return;
    }
    ExprPtr falling = literal(false);
    for (const Case& one : n.cases) {
      const ExprPtr entered = orOf(*entersCase(n, one, *chosen), *falling);
      block(frame, one.body, *andOf(guard, *entered));
      falling = leaves(one.body) ? literal(false) : clone(*entered);
    }
  }
  void statement(Frame& frame, const Push& n, const Expr& guard) { expression(frame, *n.value, guard); }
  void statement(Frame& frame, const Scatter& n, const Expr& guard) {
    expression(frame, *n.index, guard);
    expression(frame, *n.value, guard);
  }
  void statement(Frame& frame, const Print& n, const Expr& guard) {
    for (const ExprPtr& one : n.values) expression(frame, *one, guard);
  }
  void statement(Frame&, const Break&, const Expr&) {}
  void statement(Frame&, const Continue&, const Expr&) {}
  void statement(Frame& frame, const Return& n, const Expr& guard) {
    if (n.value) expression(frame, *n.value, guard);
  }
  void statement(Frame& frame, const Scope& n, const Expr& guard) { block(frame, n.body, guard); }

  void remember(Frame& frame, const Declare& n) const {
    if (n.init && !frame.changed[n.var]) frame.values[n.var] = shortValue(frame, *n.init);
  }

  static std::size_t valuesOf(const Switch& choice) {
    std::size_t count = 0;
    for (const Case& one : choice.cases) count += one.values.size() + 1;
    return count;
  }

  ExprPtr entersCase(const Switch& choice, const Case& one, const Expr& chosen) const {
    const auto isOneOf = [&](const std::vector<std::int64_t>& values) {
      ExprPtr any = literal(false);
      for (const std::int64_t value : values) {
        ExprPtr wanted = makeExpr(chosen.type, Literal{static_cast<std::uint32_t>(value)});
        any = orOf(*any, *combined(BinaryOp::Equal, clone(chosen), std::move(wanted)));
      }
      return any;
    };
    ExprPtr entered = isOneOf(one.values);
    if (!one.isDefault) return entered;
    ExprPtr others = literal(false);
    for (const Case& other : choice.cases) {
      if (!other.isDefault) others = orOf(*others, *isOneOf(other.values));
    }
    return notOf(*others);
  }

  // ---- expressions ------------------------------------------------------------------------------

  void expression(Frame& frame, const Expr& expr, const Expr& guard) {
    if (const auto* n = std::get_if<Select>(&expr.node)) return branches(frame, *n, guard);
    if (const auto* n = std::get_if<Binary>(&expr.node);
        n != nullptr && (n->op == BinaryOp::LogicalAnd || n->op == BinaryOp::LogicalOr)) {
      return shortened(frame, *n, guard);
    }
    if (const auto* n = std::get_if<VarRef>(&expr.node);
        n != nullptr && frame.isEntry && n->var < uses_.size()) {
      uses_[n->var].add(guard);
    }
    if (const auto* n = std::get_if<Call>(&expr.node)) call(frame, n->callee, n->args, guard);
    if (const auto* n = std::get_if<GatherRead>(&expr.node)) use(n->stream, guard);
    if (const auto* n = std::get_if<NeighborRead>(&expr.node)) use(n->stream, guard);
    if (const auto* n = std::get_if<Sample>(&expr.node)) use(n->stream, guard);
    if (const auto* n = std::get_if<IndexOf>(&expr.node)) use(n->stream, guard);
    if (const auto* n = std::get_if<ExtentOf>(&expr.node)) use(n->stream, guard);
    forEachOperand(expr, [&](const ExprPtr& operand) { expression(frame, *operand, guard); });
  }

  void branches(Frame& frame, const Select& n, const Expr& guard) {
    expression(frame, *n.cond, guard);
    const ExprPtr cond = value(frame, *n.cond);
    expression(frame, *n.yes, cond ? *andOf(guard, *cond) : guard);
    expression(frame, *n.no, cond ? *andOf(guard, *notOf(*cond)) : guard);
  }

  void shortened(Frame& frame, const Binary& n, const Expr& guard) {
    expression(frame, *n.lhs, guard);
    const ExprPtr first = value(frame, *n.lhs);
    if (!first) return expression(frame, *n.rhs, guard);
    expression(frame, *n.rhs, *andOf(guard, n.op == BinaryOp::LogicalAnd ? *first : *notOf(*first)));
  }

  void use(StreamRef stream, const Expr& guard) {
    if (stream.space == StreamRef::Space::KernelParameter) uses_[stream.id].add(guard);
  }

  void call(Frame& frame, FunctionId callee, const std::vector<ExprPtr>& args, const Expr& guard) {
    analyse(callee, passed(frame, callee, args), guard);
  }

  PassedValues passed(const Frame& frame, FunctionId callee, const std::vector<ExprPtr>& args) const {
    PassedValues values(module_.functions[callee].variables.size());
    for (std::size_t i = 0; i < args.size(); ++i) values[i] = shortValue(frame, *args[i]);
    return values;
  }

  /// The value if it is short: one that stands for a variable may be repeated in the next.
  ExprPtr shortValue(const Frame& frame, const Expr& expr) const {
    ExprPtr known = value(frame, expr);
    return known && !isTooLong(*known) ? std::move(known) : nullptr;
  }

  /// A scalar in terms of the kernel's Spec variables; null if it depends on anything else.
  ExprPtr value(const Frame& frame, const Expr& expr) const {
    if (!expr.type.isScalar()) return nullptr;
    if (const auto bits = evaluate(module_, expr, Constants::LookThrough)) {
      return makeExpr(expr.type, Literal{*bits}, expr.loc);
    }
    if (const auto* n = std::get_if<VarRef>(&expr.node)) {
      return frame.values[n->var] ? clone(*frame.values[n->var]) : nullptr;
    }
    if (const auto* n = std::get_if<Unary>(&expr.node)) {
      ExprPtr operand = n->op == UnaryOp::LogicalNot ? value(frame, *n->operand) : nullptr;
      return operand ? notOf(*operand) : nullptr;
    }
    if (const auto* n = std::get_if<Convert>(&expr.node)) return converted(frame, expr.type, *n->operand);
    if (const auto* n = std::get_if<Select>(&expr.node)) return selected(frame, *n);
    if (const auto* n = std::get_if<Call>(&expr.node)) return returned(frame, *n);
    const auto* n = std::get_if<Binary>(&expr.node);
    if (n == nullptr || !isFollowed(n->op, n->lhs->type)) return nullptr;
    ExprPtr lhs = value(frame, *n->lhs);
    ExprPtr rhs = value(frame, *n->rhs);
    if (!lhs || !rhs) return nullptr;
    if (n->op == BinaryOp::LogicalAnd) return andOf(*lhs, *rhs);
    if (n->op == BinaryOp::LogicalOr) return orOf(*lhs, *rhs);
    return combined(n->op, std::move(lhs), std::move(rhs));
  }

  /// The operator applied to each of the values that operands choose from.
  ExprPtr combined(BinaryOp op, ExprPtr lhs, ExprPtr rhs) const {
    if (const auto* n = std::get_if<Select>(&lhs->node)) {
      return choiceOf(*n->cond, *combined(op, clone(*n->yes), clone(*rhs)),
                      *combined(op, clone(*n->no), clone(*rhs)));
    }
    if (const auto* n = std::get_if<Select>(&rhs->node)) {
      return choiceOf(*n->cond, *combined(op, clone(*lhs), clone(*n->yes)),
                      *combined(op, clone(*lhs), clone(*n->no)));
    }
    ExprPtr result = comparison(op, std::move(lhs), std::move(rhs));
    const auto bits = evaluate(module_, *result, Constants::LookThrough);
    return bits ? makeExpr(result->type, Literal{*bits}) : std::move(result);
  }

  /// `if (n)` is `n != 0`; conversions between the other types, except float, keep the bits.
  ExprPtr converted(const Frame& frame, Type to, const Expr& operand) const {
    const bool rounds = to.isFloat() || to.is64Bit() || to.isNarrow() || operand.type.isNarrow();
    ExprPtr from = rounds ? nullptr : value(frame, operand);
    return from ? convertedTo(to, std::move(from)) : nullptr;
  }

  ExprPtr convertedTo(Type to, ExprPtr from) const {
    const Type type = from->type;
    if (type.isFloat() && !to.isBool()) return nullptr;
    if (to.isBool()) return combined(BinaryOp::NotEqual, std::move(from), makeExpr(type, Literal{0}));
    if (const auto* n = std::get_if<Select>(&from->node)) {
      return choiceOf(*n->cond, *convertedTo(to, clone(*n->yes)), *convertedTo(to, clone(*n->no)));
    }
    ExprPtr result = convert(to.scalar, std::move(from));
    const auto bits = evaluate(module_, *result, Constants::LookThrough);
    return bits ? makeExpr(to, Literal{*bits}) : std::move(result);
  }

  ExprPtr selected(const Frame& frame, const Select& n) const {
    const ExprPtr cond = value(frame, *n.cond), yes = value(frame, *n.yes), no = value(frame, *n.no);
    return cond && yes && no ? choiceOf(*cond, *yes, *no) : nullptr;
  }

  // ---- what functions return ----------------------------------------------------------------------

  /// A value that a function returns if the condition holds, and none of those before it.
  struct Returned {
    ExprPtr condition, value;
  };

  /// A table replaces its function by approximate values.
  ExprPtr returned(const Frame& frame, const Call& n) const {
    const Function& callee = module_.functions[n.callee];
    if (callee.table || ++followedCalls_ > mostAnalysedCalls) return nullptr;
    Frame inner = frameOf(n.callee, passed(frame, n.callee, n.args));
    std::vector<Returned> all;
    if (!addReturned(inner, callee.body, *literal(true), all)) return nullptr;
    ExprPtr isReturned = literal(false), result;
    for (const Returned& one : all) isReturned = orOf(*isReturned, *one.condition);
    if (!skc::isLiteral(*isReturned, true)) return nullptr;
    for (; !all.empty(); all.pop_back()) {
      Returned& one = all.back();
      if (result && isTooLong(*result)) return nullptr;
      result = result ? choiceOf(*one.condition, *one.value, *result) : std::move(one.value);
    }
    return result;
  }

  /// Adds what the statements return; false if that depends on anything but Spec variables.
  bool addReturned(Frame& frame, const Block& statements, const Expr& guard,
                   std::vector<Returned>& all) const {
    for (const Stmt& stmt : statements) {
      if (const auto* n = std::get_if<Declare>(&stmt.node)) remember(frame, *n);
      if (!returnsWithin(stmt)) continue;
      if (const auto* n = std::get_if<Return>(&stmt.node)) {
        ExprPtr result = n->value ? shortValue(frame, *n->value) : nullptr;
        if (!result || isTooLong(guard)) return false;
        all.push_back({clone(guard), std::move(result)});
        return true;
      }
      if (!addReturnedWithin(frame, stmt, guard, all)) return false;
    }
    return true;
  }

  bool addReturnedWithin(Frame& frame, const Stmt& stmt, const Expr& guard,
                         std::vector<Returned>& all) const {
    if (const auto* n = std::get_if<Scope>(&stmt.node)) return addReturned(frame, n->body, guard, all);
    if (const auto* n = std::get_if<Switch>(&stmt.node)) return addReturnedBy(frame, *n, guard, all);
    const auto* n = std::get_if<If>(&stmt.node);
    const ExprPtr cond = n == nullptr ? nullptr : value(frame, *n->cond);
    return cond && addReturned(frame, n->then, *andOf(guard, *cond), all) &&
           addReturned(frame, n->otherwise, *andOf(guard, *notOf(*cond)), all);
  }

  bool addReturnedBy(Frame& frame, const Switch& n, const Expr& guard, std::vector<Returned>& all) const {
    const ExprPtr chosen = value(frame, *n.value);
    if (!chosen || valuesOf(n) > mostCases) return false;
    ExprPtr falling = literal(false);
    for (const Case& one : n.cases) {
      const ExprPtr entered = orOf(*entersCase(n, one, *chosen), *falling);
      if (!isLeftAtItsEnd(one.body)) return false;
      if (!addReturned(frame, one.body, *andOf(guard, *entered), all)) return false;
      falling = leaves(one.body) ? literal(false) : clone(*entered);
    }
    return true;
  }

  const Module& module_;
  const Kernel& kernel_;
  std::vector<AnyOf> uses_;
  int calls_ = 0;
  mutable int followedCalls_ = 0;  ///< limited, since functions that call others twice repeat all their work
};

bool mayBeOmitted(const KernelParam& param) {
  return param.role == ParamRole::Input || param.role == ParamRole::Output || param.role == ParamRole::Gather;
}

}  // namespace

void guardStreams(Module& module, Diagnostics&) {
  for (Kernel& kernel : module.kernels) {
    const bool hasSpec = std::any_of(kernel.params.begin(), kernel.params.end(),
                                     [](const KernelParam& param) { return param.role == ParamRole::Spec; });
    if (!hasSpec) continue;
    std::vector<AnyOf> uses = UseAnalysis(module, kernel).run();
    for (std::size_t i = 0; i < uses.size(); ++i) {
      if (mayBeOmitted(kernel.params[i])) kernel.params[i].neededIf = uses[i].take();
    }
  }
}

}  // namespace skc
