// SPDX-License-Identifier: MIT
#include "analysis/copied_values.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/walk.hpp"

namespace skc::analysis {
namespace {

using namespace ir;

/// What becomes of a value.
struct Fate {
  bool isComputed = false;  ///< an operation uses it; otherwise it is copied
  std::optional<VarId> to = {};  ///< the variable that it is copied to
};

class CopyFinder {
 public:
  CopyFinder(const Function& function, const Kernel& kernel)
      : function_(function),
        isComputed_(function.variables.size(), true),
        sources_(function.variables.size()) {
    for (VarId var = 0; var < isComputed_.size(); ++var) {
      isComputed_[var] = var < function.parameterCount ? kernel.params[var].role != ParamRole::Output
                                                       : function.variables[var].role != VarRole::Local;
    }
  }

  CopiedValues find() {
    visitAll();  // finds out what variables are computed with, in which it is wrong about copies
    copied_.clear();
    visitAll();
    return std::move(copied_);
  }

 private:
  static constexpr Fate computed{true}, stored{};

  void visitAll() {
    walkStmts(function_.body, [&](const Stmt& stmt) { visit(stmt); });
  }

  void visit(const Stmt& stmt) {
    if (const auto* n = std::get_if<Declare>(&stmt.node)) {
      if (n->init) use(*n->init, copyTo(n->var));
    } else if (const auto* assign = std::get_if<Assign>(&stmt.node)) {
      if (assign->op) use(*assign->place, computed);
      write(*assign->place);
      use(*assign->value, assign->op ? computed : copyTo(rootOf(*assign->place)));
    } else if (const auto* call = std::get_if<CallStmt>(&stmt.node)) {
      for (const ExprPtr& arg : call->args) use(*arg, computed);
      if (call->result) write(*call->result);
    } else if (const auto* push = std::get_if<Push>(&stmt.node)) {
      use(*push->value, stored);
      if (push->mask) use(*push->mask, computed);
    } else if (const auto* scatter = std::get_if<Scatter>(&stmt.node)) {
      use(*scatter->index, computed);
      use(*scatter->value, scatter->op == ScatterOp::Add ? computed : stored);
      if (scatter->mask) use(*scatter->mask, computed);
    } else {
      forEachOperand(stmt, [&](const ExprPtr& operand) { use(*operand, computed); });
    }
  }

  Fate copyTo(VarId var) const { return {isComputed_[var], var}; }

  /// Visits the indices in an lvalue that is written.
  void write(const Expr& place) {
    if (const auto* n = std::get_if<Index>(&place.node)) {
      use(*n->index, computed);
      write(*n->base);
    }
    if (const auto* n = std::get_if<Swizzle>(&place.node)) write(*n->base);
    if (const auto* n = std::get_if<Member>(&place.node)) write(*n->base);
  }

  void use(const Expr& expr, Fate fate) {
    if (!fate.isComputed) copied_.insert(&expr);
    if (const auto* n = std::get_if<VarRef>(&expr.node)) {
      if (fate.isComputed) return computeWith(n->var);
      if (fate.to) sources_[*fate.to].push_back(n->var);
    } else if (const auto* select = std::get_if<Select>(&expr.node)) {
      use(*select->cond, computed);
      use(*select->yes, fate);
      use(*select->no, fate);
    } else if (const auto* index = std::get_if<Index>(&expr.node)) {
      use(*index->base, fate);
      use(*index->index, computed);
    } else {
      const bool isCopy = std::holds_alternative<Construct>(expr.node) ||
                          std::holds_alternative<Swizzle>(expr.node) ||
                          std::holds_alternative<Member>(expr.node);
      forEachOperand(expr, [&](const ExprPtr& operand) { use(*operand, isCopy ? fate : computed); });
    }
  }

  /// An operation uses the variable's value, and so the values of all variables that are copied to it.
  void computeWith(VarId var) {
    std::vector<VarId> open{var};
    while (!open.empty()) {
      const VarId next = open.back();
      open.pop_back();
      if (isComputed_[next]) continue;
      isComputed_[next] = true;
      open.insert(open.end(), sources_[next].begin(), sources_[next].end());
    }
  }

  const Function& function_;
  std::vector<bool> isComputed_;  ///< by variable: an operation uses its value
  std::vector<std::vector<VarId>> sources_;  ///< by variable: the variables that are copied to it
  CopiedValues copied_;
};

}  // namespace

CopiedValues copiedValues(const Module& module, const Kernel& kernel) {
  return CopyFinder(module.functions[kernel.entry], kernel).find();
}

}  // namespace skc::analysis
