// SPDX-License-Identifier: MIT
#include "analysis/last_uses.hpp"

#include "ir/walk.hpp"

namespace skc::analysis {

using namespace ir;

LastUses::LastUses(const Function& function) : lastUse_(function.variables.size(), 0) {
  visit(function.body);
}

void LastUses::visit(const Block& block) {
  for (const Stmt& stmt : block) {
    ++now_;
    forEachOperand(stmt, [&](const ExprPtr& operand) { use(*operand); });
    forEachBlock(stmt, [&](const Block& inner) { visit(inner); });
    const auto* loop = std::get_if<Loop>(&stmt.node);
    if (loop == nullptr) continue;
    if (loop->cond) use(*loop->cond);  // evaluated after the body in a `do` loop
    ends_[&stmt] = now_;
  }
}

void LastUses::use(const Expr& expr) {
  walkExprs(expr, [&](const Expr& inner) {
    if (const auto* n = std::get_if<VarRef>(&inner.node)) lastUse_[n->var] = now_;
  });
}

}  // namespace skc::analysis
