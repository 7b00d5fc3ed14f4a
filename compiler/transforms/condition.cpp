// SPDX-License-Identifier: MIT
#include "transforms/condition.hpp"

#include <algorithm>
#include <utility>

#include "ir/build.hpp"
#include "ir/walk.hpp"

namespace skc {
namespace {

using namespace ir;

/// Longer conditions are unreadable: the stream then counts as always needed. This also bounds the stack that
/// the runtime needs (sk::program::deepestCondition).
constexpr int mostNodes = 60;

const Binary* asBinary(const Expr& expr, BinaryOp op) {
  const auto* n = std::get_if<Binary>(&expr.node);
  return n != nullptr && n->op == op ? n : nullptr;
}

/// True if `condition` is `part`, or a conjunction that contains it.
bool hasConjunct(const Expr& condition, const Expr& part) {
  if (isSame(condition, part)) return true;
  const Binary* n = asBinary(condition, BinaryOp::LogicalAnd);
  return n != nullptr && (hasConjunct(*n->lhs, part) || hasConjunct(*n->rhs, part));
}

bool areOpposite(const Expr& a, const Expr& b) {
  const auto* n = std::get_if<Unary>(&a.node);
  return n != nullptr && n->op == UnaryOp::LogicalNot && isSame(*n->operand, b);
}

}  // namespace

bool isSpecOnly(const Expr& expr, const std::vector<bool>& isSpec) {
  bool only = true;
  walkExprs(expr, [&](const Expr& inner) {
    const auto* ref = std::get_if<VarRef>(&inner.node);
    const bool isPlain =
        std::holds_alternative<Literal>(inner.node) || std::holds_alternative<Unary>(inner.node) ||
        std::holds_alternative<Binary>(inner.node) || std::holds_alternative<Convert>(inner.node) ||
        std::holds_alternative<ConstantRef>(inner.node);
    only = only && (isPlain || (ref != nullptr && ref->var < isSpec.size() && isSpec[ref->var]));
  });
  return only;
}

bool isTooLong(const Expr& condition) {
  int nodes = 0;
  walkExprs(condition, [&](const Expr&) { ++nodes; });
  return nodes > mostNodes;
}

bool isLiteral(const Expr& condition, bool value) {
  const auto* n = std::get_if<Literal>(&condition.node);
  return n != nullptr && (n->bits != 0) == value;
}

bool isSame(const Expr& a, const Expr& b) {
  if (a.type != b.type || a.node.index() != b.node.index()) return false;
  if (const auto* n = std::get_if<Literal>(&a.node)) {
    const auto& other = std::get<Literal>(b.node);
    return n->bits == other.bits && n->high == other.high && n->text == other.text;
  }
  if (const auto* n = std::get_if<VarRef>(&a.node)) return n->var == std::get<VarRef>(b.node).var;
  if (const auto* n = std::get_if<Convert>(&a.node)) {
    return isSame(*n->operand, *std::get<Convert>(b.node).operand);
  }
  if (const auto* n = std::get_if<Unary>(&a.node)) {
    const auto& other = std::get<Unary>(b.node);
    return n->op == other.op && isSame(*n->operand, *other.operand);
  }
  if (const auto* n = std::get_if<Binary>(&a.node)) {
    const auto& other = std::get<Binary>(b.node);
    return n->op == other.op && isSame(*n->lhs, *other.lhs) && isSame(*n->rhs, *other.rhs);
  }
  return false;
}

ExprPtr notOf(const Expr& condition) {
  if (isLiteral(condition, true)) return literal(false);
  if (isLiteral(condition, false)) return literal(true);
  const auto* n = std::get_if<Unary>(&condition.node);
  if (n != nullptr && n->op == UnaryOp::LogicalNot) return clone(*n->operand);
  return unary(UnaryOp::LogicalNot, clone(condition));
}

ExprPtr andOf(const Expr& a, const Expr& b) {
  if (isLiteral(a, true) || isLiteral(b, false) || hasConjunct(b, a)) return clone(b);
  if (isLiteral(b, true) || isLiteral(a, false) || hasConjunct(a, b)) return clone(a);
  if (areOpposite(a, b) || areOpposite(b, a)) return literal(false);
  return binary(BinaryOp::LogicalAnd, clone(a), clone(b));
}

ExprPtr orOf(const Expr& a, const Expr& b) {
  if (isLiteral(a, true) || isLiteral(b, false) || hasConjunct(b, a)) return clone(a);
  if (isLiteral(b, true) || isLiteral(a, false) || hasConjunct(a, b)) return clone(b);
  if (areOpposite(a, b) || areOpposite(b, a)) return literal(true);
  return binary(BinaryOp::LogicalOr, clone(a), clone(b));
}

ExprPtr choiceOf(const Expr& condition, const Expr& yes, const Expr& no) {
  if (isLiteral(condition, true) || isSame(yes, no)) return clone(yes);
  if (isLiteral(condition, false)) return clone(no);
  if (!yes.type.isBool()) return select(clone(condition), clone(yes), clone(no));
  const ExprPtr opposite = notOf(condition);
  if (isLiteral(yes, true)) return orOf(condition, no);
  if (isLiteral(no, true)) return orOf(*opposite, yes);
  return orOf(*andOf(condition, yes), *andOf(*opposite, no));
}

/// Drops conversions between int and uint for equality: they keep the bits.
ExprPtr comparison(BinaryOp op, ExprPtr lhs, ExprPtr rhs) {
  auto* n = std::get_if<Convert>(&lhs->node);
  auto* value = std::get_if<Literal>(&rhs->node);
  const bool isEquality = op == BinaryOp::Equal || op == BinaryOp::NotEqual;
  if (isEquality && n != nullptr && value != nullptr && n->operand->type.isInteger() &&
      !rhs->type.is64Bit()) {
    ExprPtr operand = std::move(n->operand);
    rhs = makeExpr(operand->type, Literal{value->bits});
    lhs = std::move(operand);
  }
  return binary(op, std::move(lhs), std::move(rhs));
}

void AnyOf::add(const Expr& condition) {
  if (isLiteral(condition, false)) return;
  if (terms_.size() > static_cast<std::size_t>(mostNodes) && !isLiteral(condition, true))
    return add(*literal(true));  // take() would give up
  if (const Binary* either = asBinary(condition, BinaryOp::LogicalOr)) {
    add(*either->lhs);
    return add(*either->rhs);
  }
  const bool isCovered = std::any_of(terms_.begin(), terms_.end(), [&](const ExprPtr& term) {
    return isLiteral(*term, true) || hasConjunct(condition, *term);
  });
  if (isCovered) return;
  std::erase_if(terms_, [&](const ExprPtr& term) {
    return isLiteral(condition, true) || hasConjunct(*term, condition);
  });
  terms_.push_back(clone(condition));
}

ExprPtr AnyOf::take() {
  if (terms_.empty()) return nullptr;
  ExprPtr all = std::move(terms_.front());
  for (std::size_t i = 1; i < terms_.size(); ++i) all = orOf(*all, *terms_[i]);
  return isLiteral(*all, true) || isTooLong(*all) ? nullptr : std::move(all);
}

}  // namespace skc
