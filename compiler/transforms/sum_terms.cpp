// SPDX-License-Identifier: MIT
#include "transforms/sum_terms.hpp"

#include <string_view>
#include <utility>

#include "ir/build.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {
namespace {

using namespace ir;

const Binary* sumOrDifference(const Expr& value) {
  const auto* n = std::get_if<Binary>(&value.node);
  return n != nullptr && (n->op == BinaryOp::Add || n->op == BinaryOp::Sub) ? n : nullptr;
}

const Unary* negation(const Expr& value) {
  const auto* n = std::get_if<Unary>(&value.node);
  return n != nullptr && n->op == UnaryOp::Negate ? n : nullptr;
}

/// Of floats, or vectors of them: those of matrices are sums.
const Binary* product(const Expr& value) {
  const auto* n = std::get_if<Binary>(&value.node);
  const bool isProduct = n != nullptr && n->op == BinaryOp::Mul && n->lhs->type.isFloat() &&
                         n->rhs->type.isFloat() && !n->lhs->type.isMatrix() && !n->rhs->type.isMatrix();
  return isProduct ? n : nullptr;
}

const IntrinsicCall* dotProduct(const Expr& value) {
  const auto* n = std::get_if<IntrinsicCall>(&value.node);
  return n != nullptr && n->intrinsic == Intrinsic::Dot && n->args[0]->type.isFloat() ? n : nullptr;
}

bool hasProduct(const Expr& value) {
  if (const Binary* n = sumOrDifference(value)) return hasProduct(*n->lhs) || hasProduct(*n->rhs);
  if (const Unary* n = negation(value)) return hasProduct(*n->operand);
  return product(value) != nullptr || dotProduct(value) != nullptr;
}

void addTerms(const Expr& value, bool isNegative, std::vector<Term>& terms) {
  const auto add = [&](ExprPtr term, ExprPtr factor) {
    if (isNegative) term = unary(UnaryOp::Negate, std::move(term), value.loc);
    terms.push_back({std::move(term), std::move(factor)});
  };
  if (const Binary* n = sumOrDifference(value)) {
    addTerms(*n->lhs, isNegative, terms);
    addTerms(*n->rhs, isNegative != (n->op == BinaryOp::Sub), terms);
  } else if (const Unary* negated = negation(value)) {
    addTerms(*negated->operand, !isNegative, terms);
  } else if (const Binary* factors = product(value)) {
    add(clone(factors->lhs), clone(factors->rhs));
  } else if (const IntrinsicCall* dot = dotProduct(value)) {
    for (unsigned i = 0; i < dot->args[0]->type.width; ++i) {
      add(componentOf(*dot->args[0], i), componentOf(*dot->args[1], i));
    }
  } else {
    add(clone(value), nullptr);
  }
}

}  // namespace

std::vector<Term> termsOf(const Assign& fold) {
  std::vector<Term> terms;
  for (const auto& [value, isNegative] : summandsOf(fold)) {
    if (hasProduct(*value)) {
      addTerms(*value, isNegative, terms);
    } else {
      terms.push_back({isNegative ? unary(UnaryOp::Negate, clone(*value)) : clone(*value), nullptr});
    }
  }
  return terms;
}

ExprPtr componentOf(const Expr& value, unsigned component) {
  ExprPtr whole = clone(value);
  if (!value.type.isVector()) return whole;
  return swizzle(std::move(whole), std::string_view("xyzw").substr(component, 1), value.loc);
}

}  // namespace skc
