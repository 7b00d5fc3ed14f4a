// SPDX-License-Identifier: MIT
//
// The stack machine that sk/program.hpp describes at ConditionStep.
#include "assemble/condition.hpp"

#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

namespace sk::assemble {
namespace {

using program::ConditionOp;
using program::ConditionStep;
using program::Scalar;

template <class T>
bool compare(ConditionOp op, T a, T b) {
  switch (op) {
    case ConditionOp::Less: return a < b;
    case ConditionOp::LessEqual: return a <= b;
    case ConditionOp::Greater: return a > b;
    case ConditionOp::GreaterEqual: return a >= b;
    case ConditionOp::Equal: return a == b;
    case ConditionOp::NotEqual: return a != b;
    case ConditionOp::Spec:
    case ConditionOp::Literal:
    case ConditionOp::Not:
    case ConditionOp::And:
    case ConditionOp::Or:
    case ConditionOp::BitAnd:
    case ConditionOp::BitOr:
    case ConditionOp::BitXor:
    case ConditionOp::Add:
    case ConditionOp::Sub:
    case ConditionOp::Mul: break;
  }
  assert(!"no comparison");
  return false;
}

bool compareAs(Scalar scalar, ConditionOp op, std::uint32_t a, std::uint32_t b) {
  if (scalar == Scalar::Int) {
    return compare(op, static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
  }
  if (scalar == Scalar::Float) return compare(op, std::bit_cast<float>(a), std::bit_cast<float>(b));
  return compare(op, a, b);  // Bool and Uint: skc emits no others
}

std::uint32_t combine(const ConditionStep& step, std::uint32_t a, std::uint32_t b) {
  switch (step.op) {
    case ConditionOp::And: return a & b;
    case ConditionOp::Or: return a | b;
    case ConditionOp::BitAnd: return a & b;
    case ConditionOp::BitOr: return a | b;
    case ConditionOp::BitXor: return a ^ b;
    case ConditionOp::Add: return a + b;
    case ConditionOp::Sub: return a - b;
    case ConditionOp::Mul: return a * b;
    case ConditionOp::Less:
    case ConditionOp::LessEqual:
    case ConditionOp::Greater:
    case ConditionOp::GreaterEqual:
    case ConditionOp::Equal:
    case ConditionOp::NotEqual: return compareAs(step.scalar, step.op, a, b) ? 1u : 0u;
    case ConditionOp::Spec:
    case ConditionOp::Literal:
    case ConditionOp::Not: break;
  }
  assert(!"a step of no two operands");
  return 0;
}

}  // namespace

bool holds(const program::Condition& condition, const SpecValues& specs) {
  std::array<std::uint32_t, program::deepestCondition> stack{};
  std::size_t depth = 0;
  for (const ConditionStep& step : condition.steps) {
    if (step.op == ConditionOp::Spec) {
      stack[depth++] = specs[step.value];
    } else if (step.op == ConditionOp::Literal) {
      stack[depth++] = step.value;
    } else if (step.op == ConditionOp::Not) {
      stack[depth - 1] = stack[depth - 1] == 0 ? 1u : 0u;
    } else {
      --depth;
      stack[depth - 1] = combine(step, stack[depth - 1], stack[depth]);
    }
  }
  assert(depth == 1);
  return stack[0] != 0;
}

std::string glslLiteral(Scalar scalar, std::uint32_t bits) {
  if (scalar == Scalar::Bool) return bits != 0 ? "true" : "false";
  if (scalar == Scalar::Uint) return fmt::format("{}u", bits);
  if (scalar == Scalar::Int) {
    const auto whole = static_cast<std::int32_t>(bits);
    return whole == INT32_MIN ? "(-2147483647 - 1)" : fmt::format("{}", whole);
  }
  const auto value = std::bit_cast<float>(bits);
  if (!std::isnormal(value) && value != 0) return fmt::format("uintBitsToFloat({}u)", bits);
  const std::string text = fmt::format("{}", value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

}  // namespace sk::assemble
