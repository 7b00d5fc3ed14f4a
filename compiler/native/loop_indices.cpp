// SPDX-License-Identifier: MIT
#include "native/loop_indices.hpp"

#include "ir/build.hpp"
#include "ir/lvalue.hpp"
#include "ir/op_weight.hpp"
#include "ir/walk.hpp"

namespace skc::native {

using namespace ir;
using analysis::Shape;

std::optional<LoopIndices> LoopIndices::of(const Module& module, const analysis::Uniformity& uniformity,
                                           FunctionId function, const Loop& loop) {
  if (loop.kind != LoopKind::For || loop.step.size() != 1) return std::nullopt;
  const auto* step = std::get_if<Assign>(&loop.step.front().node);
  if (step == nullptr || step->op != BinaryOp::Add) return std::nullopt;
  const auto* stepped = std::get_if<VarRef>(&step->place->node);
  const auto* by = std::get_if<Literal>(&step->value->node);
  if (stepped == nullptr || by == nullptr || by->bits != 1) return std::nullopt;
  const Type type = step->place->type;
  const bool isUniform = uniformity.of(function, *step->place) == Shape::Uniform;
  if (!type.isScalar() || !type.isInteger() || !isUniform || assigns(module, loop.body, stepped->var))
    return std::nullopt;
  return LoopIndices(module, loop, stepped->var);
}

LoopIndices::LoopIndices(const Module& module, const Loop& loop, VarId counter)
    : module_(&module), loop_(&loop), counter_(counter) {
  walkStmts(loop.body, [&](const Stmt& stmt) {
    if (const auto* n = std::get_if<Declare>(&stmt.node)) declared_[n->var] = n->init.get();
  });
}

ExprPtr LoopIndices::beforeBody(const Expr& expr) {
  ExprPtr result = clone(expr);
  rewriteExprs(result, [&](ExprPtr& slot) {
    const auto* n = std::get_if<VarRef>(&slot->node);
    if (n == nullptr) return;
    const auto declared = declared_.find(n->var);
    if (declared == declared_.end() || declared->second == nullptr || assigns(*module_, loop_->body, n->var))
      return;
    if (replaced_++ < mostExpressionsOfBody) slot = beforeBody(*declared->second);
  });
  return result;
}

bool LoopIndices::isInvariant(const Expr& expr) const {
  bool is = true;
  walkExprs(expr, [&](const Expr& inner) {
    const auto* n = std::get_if<VarRef>(&inner.node);
    if (n == nullptr) return;
    is = is && n->var != counter_ && !declared_.contains(n->var) && !assigns(*module_, loop_->body, n->var);
  });
  return is;
}

bool LoopIndices::growsByOne(const Expr& expr) const {
  if (!expr.type.isScalar() || !expr.type.isInteger()) return false;
  if (const auto* n = std::get_if<VarRef>(&expr.node)) return n->var == counter_;
  if (const auto* n = std::get_if<Convert>(&expr.node)) return growsByOne(*n->operand);
  const auto* n = std::get_if<Binary>(&expr.node);
  if (n == nullptr) return false;
  if (n->op == BinaryOp::Sub) return growsByOne(*n->lhs) && isInvariant(*n->rhs);
  if (n->op != BinaryOp::Add) return false;
  return (growsByOne(*n->lhs) && isInvariant(*n->rhs)) || (isInvariant(*n->lhs) && growsByOne(*n->rhs));
}

bool isBodySmall(const Module& module, const Loop& loop) {
  // a body with a loop weighs as much as the limit
  return weigh(module, loop.body, {.node = 1}, mostExpressionsOfBody + 1) <= mostExpressionsOfBody;
}

}  // namespace skc::native
