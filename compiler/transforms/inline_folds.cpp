// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "ir/build.hpp"
#include "ir/lvalue.hpp"
#include "ir/walk.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {
namespace {

using namespace ir;

/// The caller's expressions for a callee's variables.
using Substitution = std::map<VarId, ExprPtr>;

/// Nobody writes a fold with more calls in one body.
constexpr int mostCalls = 64;

void substitute(ExprPtr& slot, const Substitution& values) {
  rewriteExprs(slot, [&](ExprPtr& inner) {
    const auto* n = std::get_if<VarRef>(&inner->node);
    if (n != nullptr) inner = clone(*values.at(n->var));
  });
}

void substitute(Block& block, const Substitution& values) {
  rewriteExprs(block, [&](ExprPtr& inner) {
    const auto* n = std::get_if<VarRef>(&inner->node);
    if (n != nullptr) inner = clone(*values.at(n->var));
  });
}

/// True if the only return of a block is at its very end.
bool returnsAtEnd(const Block& block) {
  bool isOutside = false;
  walkStmts(block, [&](const Stmt& stmt) {
    isOutside = isOutside || (std::holds_alternative<Return>(stmt.node) && &stmt != &block.back());
  });
  return !isOutside;
}

/// The number of times that an expression uses a variable.
int uses(const Expr& expr, VarId var) {
  int count = 0;
  walkExprs(expr, [&](const Expr& inner) {
    const auto* n = std::get_if<VarRef>(&inner.node);
    if (n != nullptr && n->var == var) ++count;
  });
  return count;
}

/// Inlines calls in the body of one reduce.
class Inliner {
 public:
  Inliner(const Module& module, const Kernel& kernel, Function& function)
      : module_(module),
        kernel_(kernel),
        function_(function),
        assigned_(assignedVariables(module, function)) {}

  /// Returns true if it changed anything.
  bool run() {
    while (calls_ < mostCalls && block(function_.body)) {
    }
    return calls_ > 0;
  }

 private:
  bool namesAccumulator(const Expr& expr) const {
    bool names = false;
    walkExprs(expr, [&](const Expr& inner) {
      const auto* n = std::get_if<VarRef>(&inner.node);
      names = names || (n != nullptr && isAccumulator(kernel_, n->var));
    });
    return names;
  }
  bool anyNamesAccumulator(const std::vector<ExprPtr>& args) const {
    return std::ranges::any_of(args, [&](const ExprPtr& arg) { return namesAccumulator(*arg); });
  }

  /// Inlines the first call that it can.
  bool block(Block& statements) {
    for (std::size_t i = 0; i < statements.size(); ++i) {
      std::optional<Block> inlined = statement(statements[i]);
      if (inlined) {
        ++calls_;
        statements.erase(statements.begin() + static_cast<std::ptrdiff_t>(i));
        statements.insert(statements.begin() + static_cast<std::ptrdiff_t>(i),
                          std::make_move_iterator(inlined->begin()), std::make_move_iterator(inlined->end()));
        return true;
      }
      bool isDone = false;
      forEachBlock(statements[i], [&](Block& inner) { isDone = isDone || block(inner); });
      if (isDone) return true;
    }
    return false;
  }

  /// Equivalent statements with one call less.
  std::optional<Block> statement(Stmt& stmt) {
    if (const auto* n = std::get_if<CallStmt>(&stmt.node)) return callStatement(*n, stmt.loc);
    auto* n = std::get_if<Assign>(&stmt.node);
    if (n == nullptr) return std::nullopt;
    if (const auto* call = std::get_if<Call>(&n->value->node); call != nullptr && !n->op) {
      if (std::optional<Block> body = updatingCall(*n, *call, stmt.loc)) return body;
    }
    return valueOfCall(stmt, *n);
  }

  /// `f(e, x);`, where f takes a reference to e.
  std::optional<Block> callStatement(const CallStmt& call, Loc loc) {
    if (!anyNamesAccumulator(call.args)) return std::nullopt;
    return body(call.callee, call.args, std::nullopt, call.result.get(), loc);
  }

  /// `e = f(x, e);`, where f changes its copy of e and returns the copy.
  std::optional<Block> updatingCall(const Assign& assign, const Call& call, Loc loc) {
    const Function& callee = module_.functions[call.callee];
    if (callee.body.empty()) return std::nullopt;
    const auto* end = std::get_if<Return>(&callee.body.back().node);
    const auto* result = end != nullptr && end->value ? std::get_if<VarRef>(&end->value->node) : nullptr;
    if (result == nullptr || result->var >= callee.parameterCount) return std::nullopt;
    const std::optional<StaticLValue> lvalue = staticLValue(*assign.place);
    if (!lvalue || !isAccumulator(kernel_, lvalue->root) || staticLValue(*call.args[result->var]) != lvalue)
      return std::nullopt;
    return body(call.callee, call.args, result->var, nullptr, loc);
  }

  /// The callee's statements. `updated` is a parameter whose final value its argument receives.
  std::optional<Block> body(FunctionId id, const std::vector<ExprPtr>& args, std::optional<VarId> updated,
                            const Expr* result, Loc loc) {
    const Function& callee = module_.functions[id];
    if (callee.table || !returnsAtEnd(callee.body)) return std::nullopt;
    Block statements = clone(callee.body);
    ExprPtr returned;
    if (!statements.empty()) {
      if (auto* end = std::get_if<Return>(&statements.back().node)) {
        returned = std::move(end->value);
        statements.pop_back();
      }
    }
    const std::vector<bool> changed = assignedVariables(module_, callee);
    const bool isShort = statements.size() == 1 && std::holds_alternative<Assign>(statements[0].node);
    Block all;
    Substitution values;
    for (VarId var = 0; var < callee.variables.size(); ++var) {
      const Variable& variable = callee.variables[var];
      const bool isParameter = var < callee.parameterCount;
      const bool stands = isParameter && (variable.role == VarRole::InOut || updated == var ||
                                          (!changed[var] && keeps(*args[var], isShort)));
      if (stands) {
        values[var] = clone(*args[var]);
        continue;
      }
      const VarId copy = addVariable(function_, variable.name, variable.type, VarRole::Local, variable.loc);
      assigned_.push_back(true);
      if (isParameter) all.push_back(declare(copy, clone(*args[var]), loc));
      values[var] = varRef(function_, copy, loc);
      copies_[var] = copy;
    }
    substitute(statements, values);
    walkStmts(statements, [&](Stmt& stmt) {
      if (auto* n = std::get_if<Declare>(&stmt.node)) n->var = copies_.at(n->var);
    });
    copies_.clear();
    for (Stmt& stmt : statements) all.push_back(std::move(stmt));
    if (result != nullptr && !returned) return std::nullopt;
    if (result != nullptr) {
      substitute(returned, values);
      all.push_back(assign(clone(*result), std::move(returned), loc));
    }
    return scoped(std::move(all), loc);
  }

  /// Keeps declarations in a scope of their own.
  static Block scoped(Block statements, Loc loc) {
    if (statements.size() == 1 && !std::holds_alternative<Declare>(statements[0].node)) return statements;
    return ir::block(scope(std::move(statements), loc));
  }

  /// True if an argument has the same value wherever the callee reads it.
  bool keeps(const Expr& arg, bool isShort) const {
    bool changes = false;
    walkExprs(arg, [&](const Expr& inner) {
      const auto* n = std::get_if<VarRef>(&inner.node);
      changes = changes || std::holds_alternative<Call>(inner.node) || (n != nullptr && assigned_[n->var]);
    });
    return isShort || !changes;
  }

  /// `e = e + f(x, e)` and similar, where f is a single expression.
  std::optional<Block> valueOfCall(const Stmt& stmt, const Assign& assignment) {
    const std::optional<StaticLValue> lvalue = staticLValue(*assignment.place);
    if (!lvalue || !isAccumulator(kernel_, lvalue->root)) return std::nullopt;
    Block before;
    bool isDone = false;
    ExprPtr value = clone(*assignment.value);
    rewriteExprs(value, [&](ExprPtr& inner) {
      const auto* call = std::get_if<Call>(&inner->node);
      if (call == nullptr || isDone || !anyNamesAccumulator(call->args)) return;
      ExprPtr result = returnedBy(*call, before, stmt.loc);
      if (!result) return;
      isDone = true;
      inner = std::move(result);
    });
    if (!isDone) return std::nullopt;
    before.push_back(assignment.op
                         ? assign(clone(*assignment.place), *assignment.op, std::move(value), stmt.loc)
                         : assign(clone(*assignment.place), std::move(value), stmt.loc));
    return scoped(std::move(before), stmt.loc);
  }

  /// The result of a function that has only constants and one return; arguments read twice go to variables.
  ExprPtr returnedBy(const Call& call, Block& before, Loc loc) {
    const Function& callee = module_.functions[call.callee];
    if (callee.table || callee.body.empty()) return nullptr;
    const auto* end = std::get_if<Return>(&callee.body.back().node);
    if (end == nullptr || !end->value) return nullptr;
    const std::vector<bool> changed = assignedVariables(module_, callee);
    if (std::ranges::find(changed, true) != changed.end()) return nullptr;
    Substitution values;
    Block declared;
    for (VarId var = 0; var < callee.parameterCount; ++var)
      values[var] = argument(callee, call, var, declared, loc);
    for (auto stmt = callee.body.begin(); stmt + 1 != callee.body.end(); ++stmt) {
      const auto* n = std::get_if<Declare>(&stmt->node);
      if (n == nullptr || !n->init) return nullptr;
      ExprPtr value = clone(*n->init);
      substitute(value, values);
      values[n->var] = std::move(value);
    }
    ExprPtr result = clone(*end->value);
    substitute(result, values);
    for (Stmt& stmt : declared) before.push_back(std::move(stmt));
    return result;
  }

  ExprPtr argument(const Function& callee, const Call& call, VarId var, Block& declared, Loc loc) {
    const Expr& arg = *call.args[var];
    int count = 0;
    walkStmts(callee.body, [&](const Stmt& stmt) {
      forEachOperand(stmt, [&](const ExprPtr& operand) { count += uses(*operand, var); });
    });
    const bool isSimple = staticLValue(arg) || std::holds_alternative<Literal>(arg.node);
    if (count <= 1 || isSimple || namesAccumulator(arg)) return clone(arg);
    const VarId local = addVariable(function_, callee.variables[var].name, arg.type, VarRole::Local, loc);
    assigned_.push_back(false);
    declared.push_back(declare(local, clone(arg), loc));
    return varRef(function_, local, loc);
  }

  const Module& module_;
  const Kernel& kernel_;
  Function& function_;
  std::vector<bool> assigned_;
  std::map<VarId, VarId> copies_;
  int calls_ = 0;
};

}  // namespace

void inlineFolds(Module& module, Diagnostics&) {
  for (Kernel& kernel : module.kernels) {
    if (!kernel.reduction || recogniseFold(kernel, module.functions[kernel.entry])) continue;
    Function inlined = clone(module.functions[kernel.entry]);
    if (!Inliner(module, kernel, inlined).run() || !recogniseFold(kernel, inlined)) continue;
    module.functions[kernel.entry] = std::move(inlined);
  }
}

}  // namespace skc
