// SPDX-License-Identifier: MIT
#include "program/conditions.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace skc::emit {
namespace {

using namespace ir;
using sk::program::ConditionOp;
using sk::program::ConditionStep;

ConditionOp opOf(BinaryOp op) {
  using enum ConditionOp;
  constexpr std::nullopt_t None = std::nullopt;
  constexpr std::optional<ConditionOp> ops[] = {
#define SKC_OPERATOR(Name, spelling, precedence, isAssociative, vectors, doubles, condition) condition,
#include "ir/operators.def"
#undef SKC_OPERATOR
  };
  return ops[static_cast<std::size_t>(op)].value();   // guard-streams follows no other operator
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
