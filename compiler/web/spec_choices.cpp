// SPDX-License-Identifier: MIT
#include "web/spec_choices.hpp"

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <set>

namespace skc::web {
namespace {

using sk::assemble::SpecValues;
using sk::program::Condition;
using sk::program::ConditionOp;
using sk::program::ConditionStep;
using sk::program::Kernel;
using sk::program::Parameter;
using sk::program::Role;
using sk::program::Scalar;

/// The most choices to keep while some conditions are undecided: many choices may lead to few sets.
constexpr std::size_t mostPartialChoices = 4096;

/// Whether a condition mentions the Spec parameter of this number.
bool mentions(const Condition& condition, std::size_t number) {
  return std::ranges::any_of(condition.steps, [&](const ConditionStep& step) {
    return step.op == ConditionOp::Spec && step.value == number;
  });
}

bool isMentioned(const Kernel& kernel, std::size_t number) {
  return std::ranges::any_of(
      kernel.parameters, [&](const Parameter& parameter) { return mentions(parameter.neededIf, number); });
}

bool has(const Condition& condition, std::initializer_list<ConditionOp> operators) {
  return std::ranges::any_of(condition.steps, [&](const ConditionStep& step) {
    return std::ranges::find(operators, step.op) != operators.end();
  });
}

/// Adds all unions of the given bits: `flags & 1` and `flags & 4` may both hold.
void addUnions(std::set<std::uint32_t>& values, const std::set<std::uint32_t>& given) {
  for (const std::uint32_t bits : given) {
    std::vector<std::uint32_t> more;
    for (const std::uint32_t value : values) more.push_back(value | bits);
    values.insert(more.begin(), more.end());
    if (values.size() > mostPartialChoices) return;
  }
}

/// Adds the values that decide arithmetic on literals: the quotient for `n * 7 == 63`, the difference for `n + 7 == 63`.
void addResults(std::set<std::uint32_t>& values, const std::vector<std::uint32_t>& literals) {
  for (const std::uint32_t a : literals) {
    for (const std::uint32_t b : literals) {
      values.insert({a + b, a - b});
      if (b != 0) values.insert({a / b, a / b + 1});
    }
  }
}

std::vector<std::uint32_t> literalsOf(const Condition& condition, Scalar scalar) {
  std::vector<std::uint32_t> literals;
  for (const ConditionStep& step : condition.steps) {
    if (step.op == ConditionOp::Literal && step.scalar == scalar) literals.push_back(step.value);
  }
  return literals;
}

/// Values of a Spec parameter that may decide a condition differently: the literals of all conditions, their neighbours, and
/// combinations of them for conditions with operators. Products of parameters may need others.
std::set<std::uint32_t> candidates(const Kernel& kernel, Scalar scalar) {
  std::set<std::uint32_t> values{0, 1}, masks;
  if (scalar == Scalar::Bool) return values;
  for (const Parameter& parameter : kernel.parameters) {
    const Condition& condition = parameter.neededIf;
    const std::vector<std::uint32_t> literals = literalsOf(condition, scalar);
    for (const std::uint32_t value : literals) values.insert({value - 1, value, value + 1});
    if (has(condition, {ConditionOp::BitAnd, ConditionOp::BitOr, ConditionOp::BitXor}))
      masks.insert(literals.begin(), literals.end());
    if (has(condition, {ConditionOp::Add, ConditionOp::Sub, ConditionOp::Mul})) addResults(values, literals);
  }
  addUnions(values, masks);
  return values;
}

/// What further choices depend on once the first `known` Spec parameters have values: the results of the conditions that
/// mention no others, and the values that undecided conditions mention.
std::vector<std::uint32_t> stateOf(const Kernel& kernel, const SpecValues& specs, std::size_t known) {
  std::vector<std::uint32_t> result;
  for (const Parameter& parameter : kernel.parameters) {
    const Condition& condition = parameter.neededIf;
    bool isOpen = false;
    for (std::size_t number = known; number < specs.size(); ++number)
      isOpen = isOpen || mentions(condition, number);
    if (!isOpen) result.push_back(sk::assemble::isNeeded(parameter, specs) ? 1 : 0);
    for (std::size_t number = 0; isOpen && number < known; ++number)
      if (mentions(condition, number)) result.push_back(specs[number]);
  }
  return result;
}

}  // namespace

std::vector<SpecValues> specChoices(const Kernel& kernel) {
  std::vector<SpecValues> choices(1);
  std::size_t next = 0;
  for (const Parameter& parameter : kernel.parameters) {
    if (parameter.role != Role::Spec) continue;
    const std::size_t number = next++;
    if (!isMentioned(kernel, number)) continue;
    const std::set<std::uint32_t> values = candidates(kernel, parameter.element->fields.front().scalar);
    std::set<std::vector<std::uint32_t>> seen;
    std::vector<SpecValues> more;
    for (SpecValues choice : choices) {
      for (const std::uint32_t value : values) {
        choice[number] = value;
        if (seen.insert(stateOf(kernel, choice, next)).second) more.push_back(choice);
        if (more.size() > mostPartialChoices) return more;
      }
    }
    choices = std::move(more);
  }
  return choices;
}

}  // namespace skc::web
