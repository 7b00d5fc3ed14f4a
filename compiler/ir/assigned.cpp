// SPDX-License-Identifier: MIT
#include "ir/assigned.hpp"

#include <algorithm>

#include "ir/build.hpp"
#include "ir/walk.hpp"

namespace skc::ir {
namespace {

/// Calls fn for each variable that the block changes, perhaps more than once.
template <class Fn>
void forEachAssigned(const Block& block, Fn&& fn) {
  walkStmts(block, [&](const Stmt& stmt) {
    if (const auto* n = std::get_if<Assign>(&stmt.node)) fn(rootOf(*n->place));
    const auto* call = std::get_if<CallStmt>(&stmt.node);
    if (call == nullptr) return;
    if (call->result) fn(rootOf(*call->result));
    for (const ExprPtr& arg : call->args) {
      walkExprs(*arg, [&](const Expr& expr) {
        if (const auto* ref = std::get_if<VarRef>(&expr.node)) fn(ref->var);
      });
    }
  });
}

}  // namespace

bool assigns(const Block& block, VarId var) {
  bool found = false;
  forEachAssigned(block, [&](VarId assigned) { found = found || assigned == var; });
  return found;
}

std::vector<VarId> assignedIn(const Block& block) {
  std::vector<VarId> variables;
  forEachAssigned(block, [&](VarId var) { variables.push_back(var); });
  std::ranges::sort(variables);
  const auto repeated = std::ranges::unique(variables);
  variables.erase(repeated.begin(), repeated.end());
  return variables;
}

std::vector<bool> assignedVariables(const Function& function) {
  std::vector<bool> assigned(function.variables.size(), false);
  forEachAssigned(function.body, [&](VarId var) { assigned[var] = true; });
  return assigned;
}

}  // namespace skc::ir
