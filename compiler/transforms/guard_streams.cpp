// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <utility>

#include "ir/build.hpp"
#include "ir/evaluate.hpp"
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
  return row(op).isInConditions && (givesBool ? !operands.isDouble() : operands.isInteger());
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

/// Variables that may change after their declaration.
std::vector<bool> changedVariables(const Module& module, const Function& function) {
  std::vector<bool> changed(function.variables.size(), false);
  walkStmts(function.body, [&](const Stmt& stmt) {
    if (const auto* n = std::get_if<Assign>(&stmt.node)) changed[rootOf(*n->place)] = true;
    if (const auto* n = std::get_if<CallStmt>(&stmt.node)) {
      if (n->result) changed[rootOf(*n->result)] = true;
      const Function& callee = module.functions[n->callee];
      for (std::size_t i = 0; i < n->args.size(); ++i) {
        if (callee.variables[i].role == VarRole::InOut) changed[rootOf(*n->args[i])] = true;
      }
    }
  });
  return changed;
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
    Frame frame{function, id == kernel_.entry, changedVariables(module_, function), std::move(values)};
    for (std::size_t i = 0; i < frame.values.size(); ++i) {
      if (frame.changed[i]) frame.values[i] = nullptr;
    }
    block(frame, function.body, guard);
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
    if (!frame.changed[n.var]) frame.values[n.var] = shortValue(frame, *n.init);
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
  void statement(Frame&, const Break&, const Expr&) {}
  void statement(Frame&, const Continue&, const Expr&) {}
  void statement(Frame& frame, const Return& n, const Expr& guard) {
    if (n.value) expression(frame, *n.value, guard);
  }
  void statement(Frame& frame, const Scope& n, const Expr& guard) { block(frame, n.body, guard); }

  static std::size_t valuesOf(const Switch& choice) {
    std::size_t count = 0;
    for (const Case& one : choice.cases) count += one.values.size() + 1;
    return count;
  }

  static ExprPtr entersCase(const Switch& choice, const Case& one, const Expr& chosen) {
    const auto isOneOf = [&](const std::vector<std::int64_t>& values) {
      ExprPtr any = literal(false);
      for (const std::int64_t value : values) {
        ExprPtr wanted = makeExpr(chosen.type, Literal{static_cast<std::uint32_t>(value)});
        any = orOf(*any, *comparison(BinaryOp::Equal, clone(chosen), std::move(wanted)));
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
    PassedValues values(module_.functions[callee].variables.size());
    for (std::size_t i = 0; i < args.size(); ++i) values[i] = shortValue(frame, *args[i]);
    analyse(callee, std::move(values), guard);
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
    const auto* n = std::get_if<Binary>(&expr.node);
    if (n == nullptr || !isFollowed(n->op, n->lhs->type)) return nullptr;
    ExprPtr lhs = value(frame, *n->lhs);
    ExprPtr rhs = value(frame, *n->rhs);
    if (!lhs || !rhs) return nullptr;
    if (n->op == BinaryOp::LogicalAnd) return andOf(*lhs, *rhs);
    if (n->op == BinaryOp::LogicalOr) return orOf(*lhs, *rhs);
    return comparison(n->op, std::move(lhs), std::move(rhs));
  }

  /// `if (n)` is `n != 0`; conversions between the other types, except float, keep the bits.
  ExprPtr converted(const Frame& frame, Type to, const Expr& operand) const {
    const bool rounds = to.isFloat() || to.isDouble() || to.isNarrow() || operand.type.isNarrow();
    ExprPtr from = rounds ? nullptr : value(frame, operand);
    if (!from || (from->type.isFloat() && !to.isBool())) return nullptr;
    if (!to.isBool()) return convert(to.scalar, std::move(from));
    const Type type = from->type;
    return binary(BinaryOp::NotEqual, std::move(from), makeExpr(type, Literal{0}));
  }

  const Module& module_;
  const Kernel& kernel_;
  std::vector<AnyOf> uses_;
  int calls_ = 0;
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
