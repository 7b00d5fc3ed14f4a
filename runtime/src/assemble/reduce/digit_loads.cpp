// SPDX-License-Identifier: MIT
#include "assemble/reduce/digit_loads.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <string_view>

#include "assemble/reduce/scan_plan.hpp"
#include "sk/exact_digits.hpp"

namespace sk::assemble {

namespace {

using Load = program::DigitLoad<std::int32_t>;

/// A load that may be too large.
using Terms = std::int64_t;
constexpr Terms combined = Load::most - Load::combined().room();
bool fits(Terms load) { return load <= Load::most; }

Index4 valueOf(const ReducePass& pass, std::string_view uniform) {
  const auto found = std::ranges::find(pass.uniforms, uniform, &UniformValue::name);
  assert(found != pass.uniforms.end());
  return found->value;
}

/// The most elements or texels that a pass over elements folds one after the other.
Terms stepsOf(const ReducePass& pass) {
  const ReduceVariant& variant = pass.variant;
  if (variant.scan != ScanPass::None) return variant.run;
  if (variant.walk == Walk::Rows) {
    if (variant.part > 0) return variant.part;
    const Index4 run = valueOf(pass, "sk_run_shape");
    const bool mayHaveTail = variant.column && variant.run == 0;  // a texel of the partial row below
    return Terms{run[0]} * run[1] + (mayHaveTail ? 1 : 0);
  }
  const Terms fan = valueOf(pass, "sk_fan")[0];
  if (!variant.grouped) return fan;
  const Terms invocations = variant.twoBlocks ? groupSize / 2 : groupSize;
  return (fan + invocations - 1) / invocations;
}

/// The load of an invocation's result, which starts from zero.
Terms loadOf(const ReducePass& pass) {
  if (isOfPartials(pass.variant.walk)) return combined;
  const Terms steps = stepsOf(pass), ofStep = pass.variant.packed ? lanes : 1;
  if (pass.variant.part == 0) return steps * ofStep;
  // a part by itself, or what remains after the parts, which have been combined
  return std::max(steps * ofStep, combined + (steps - 1) * ofStep);
}

/// The load of the results of a scan's pass over elements, which continue from a carry.
Terms loadOf(const ReducePass& pass, Terms carry) {
  const Terms run = loadOf(pass);
  if (pass.variant.unit != ScanUnit::Tile) return carry + run;
  // the group combines the results of its runs, which then start from those before them
  return std::max(carry + run, combined) + run;
}

}  // namespace

bool keepsRoom(std::span<const ReducePass> passes) {
  return std::ranges::all_of(passes, [](const ReducePass& pass) { return fits(loadOf(pass)); });
}

bool keepsRoom(const ScanPlan& plan) {
  if (!keepsRoom(plan.folds)) return false;
  const Terms ofFolds = plan.folds.empty() ? 0 : std::max(loadOf(plan.folds.front()), combined);
  Terms carry = 0;
  for (const ReducePass& pass : plan.scans) {
    if (!isOfPartials(pass.variant.walk)) {
      if (!fits(loadOf(pass, carry))) return false;
    } else {
      carry = pass.variant.ofDigits ? combined : ofFolds;
    }
  }
  return true;
}

}  // namespace sk::assemble
