// SPDX-License-Identifier: MIT
#include "transforms/drop_streams.hpp"

#include <limits>
#include <utility>
#include <vector>

#include "ir/walk.hpp"

namespace skc {

using namespace ir;

bool isDropped(const Variable& var) {
  return var.role == VarRole::Gather || var.role == VarRole::AppendOutput;
}

void dropStreams(Function& function) {
  constexpr VarId dropped = std::numeric_limits<VarId>::max();
  std::vector<VarId> renumbered;
  std::vector<Variable> kept;
  std::uint32_t parameters = 0;
  for (std::size_t i = 0; i < function.variables.size(); ++i) {
    Variable& var = function.variables[i];
    const bool isGone = isDropped(var);
    if (var.role == VarRole::Element) var.role = VarRole::In;
    renumbered.push_back(isGone ? dropped : static_cast<VarId>(kept.size()));
    if (isGone) continue;
    if (i < function.parameterCount) ++parameters;
    kept.push_back(std::move(var));
  }
  function.variables = std::move(kept);
  function.parameterCount = parameters;
  walkExprs(function.body, [&](Expr& expr) {
    if (auto* n = std::get_if<VarRef>(&expr.node)) n->var = renumbered[n->var];
  });
  walkStmts(function.body, [&](Stmt& stmt) {
    if (auto* n = std::get_if<Declare>(&stmt.node)) n->var = renumbered[n->var];
  });
}

}  // namespace skc
