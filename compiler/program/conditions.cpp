// SPDX-License-Identifier: MIT
#include "program/conditions.hpp"

#include <algorithm>
#include <cassert>

namespace skc::emit {
namespace {

using namespace ir;
using sk::program::ConditionOp;
using sk::program::ConditionStep;

ConditionOp opOf(BinaryOp op) {
  switch (op) {
    case BinaryOp::Add: return ConditionOp::Add;
    case BinaryOp::Sub: return ConditionOp::Sub;
    case BinaryOp::Mul: return ConditionOp::Mul;
    case BinaryOp::BitAnd: return ConditionOp::BitAnd;
    case BinaryOp::BitOr: return ConditionOp::BitOr;
    case BinaryOp::BitXor: return ConditionOp::BitXor;
    case BinaryOp::Less: return ConditionOp::Less;
    case BinaryOp::LessEqual: return ConditionOp::LessEqual;
    case BinaryOp::Greater: return ConditionOp::Greater;
    case BinaryOp::GreaterEqual: return ConditionOp::GreaterEqual;
    case BinaryOp::Equal: return ConditionOp::Equal;
    case BinaryOp::NotEqual: return ConditionOp::NotEqual;
    case BinaryOp::LogicalAnd: return ConditionOp::And;
    case BinaryOp::LogicalOr: return ConditionOp::Or;
    case BinaryOp::Div:
    case BinaryOp::Rem:
    case BinaryOp::ShiftLeft:
    case BinaryOp::ShiftRight: break;
  }
  assert(!"guard-streams follows no such operator");
  return ConditionOp::Or;
}

/// The number of a Spec parameter among the kernel's Spec parameters.
std::uint32_t numberOf(const Kernel& kernel, VarId param) {
  return static_cast<std::uint32_t>(
      std::count_if(kernel.params.begin(), kernel.params.begin() + param,
                    [](const KernelParam& other) { return other.role == ParamRole::Spec; }));
}

void add(const Kernel& kernel, const Expr& expr, std::vector<ConditionStep>& steps) {
  const auto scalar = static_cast<sk::program::Scalar>(expr.type.scalar);
  if (const auto* n = std::get_if<Literal>(&expr.node)) {
    steps.push_back({ConditionOp::Literal, scalar, n->bits});
  } else if (const auto* ref = std::get_if<VarRef>(&expr.node)) {
    steps.push_back({ConditionOp::Spec, scalar, numberOf(kernel, ref->var)});
  } else if (const auto* conversion = std::get_if<Convert>(&expr.node)) {
    add(kernel, *conversion->operand, steps);   // bool, int or uint to int or uint keeps the bits
  } else if (const auto* negation = std::get_if<Unary>(&expr.node)) {
    add(kernel, *negation->operand, steps);
    steps.push_back({ConditionOp::Not, scalar});
  } else {
    const auto& binary = std::get<Binary>(expr.node);
    add(kernel, *binary.lhs, steps);
    add(kernel, *binary.rhs, steps);
    steps.push_back({opOf(binary.op), static_cast<sk::program::Scalar>(binary.lhs->type.scalar)});
  }
}

}  // namespace

std::vector<ConditionStep> conditionSteps(const Kernel& kernel, const Expr& condition) {
  std::vector<ConditionStep> steps;
  add(kernel, condition, steps);
  return steps;
}

}  // namespace skc::emit
