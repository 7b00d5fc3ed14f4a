// SPDX-License-Identifier: MIT
#include "native/slots.hpp"

#include <algorithm>
#include <cstdlib>

#include "ir/call_graph.hpp"
#include "ir/evaluate.hpp"
#include "ir/walk.hpp"
#include "native/leaves.hpp"

namespace skc::native {

using namespace ir;
using sk::native::Slot;

namespace {

Slot slotOf(std::uint32_t param, bool isOutput) {
  return {.parameter = static_cast<std::uint8_t>(param), .row = {}, .reach = 0, .isOutput = isOutput};
}

void addNeighbor(SlotPlan& plan, std::uint32_t param, const std::vector<std::int32_t>& offset) {
  Slot slot = slotOf(param, false);
  for (std::size_t d = 1; d < offset.size(); ++d) slot.row[d - 1] = static_cast<std::int8_t>(offset[d]);
  const auto reach = static_cast<std::uint8_t>(std::abs(offset[0]));
  for (Slot& known : plan.slots) {
    if (known.parameter == param && std::ranges::equal(known.row, slot.row)) {
      known.reach = std::max(known.reach, reach);
      return;
    }
  }
  slot.reach = reach;
  plan.slots.push_back(slot);
}

}  // namespace

bool isNear(const std::vector<std::int32_t>& offset) {
  return std::ranges::all_of(offset, [](std::int32_t d) { return std::abs(d) <= sk::native::farthestSlot; });
}

std::optional<SlotPlan::Location> SlotPlan::find(std::uint32_t parameter, const std::int8_t (&row)[3]) const {
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i].parameter == parameter && std::ranges::equal(slots[i].row, row))
      return Location{i, firstArrays[i]};
  }
  return std::nullopt;
}

std::optional<std::vector<std::int32_t>> constantOffset(const Module& module, const Expr& offset) {
  if (const auto* n = std::get_if<Construct>(&offset.node)) {
    std::vector<std::int32_t> all;
    for (const ExprPtr& arg : n->args) {
      const auto part = constantOffset(module, *arg);
      if (!part) return std::nullopt;
      all.insert(all.end(), part->begin(), part->end());
    }
    if (all.size() == 1) all.assign(offset.type.width, all[0]);  // splat
    return all;
  }
  if (!offset.type.isScalar()) return std::nullopt;
  const std::optional<std::uint32_t> bits = evaluate(module, offset, Constants::LookThrough);
  if (!bits) return std::nullopt;
  return std::vector{static_cast<std::int32_t>(*bits)};
}

bool readsNeighbors(const Kernel& kernel) { return !kernel.reduction || foldsBesideOutputs(kernel); }

SlotPlan planSlots(const Module& module, const Kernel& kernel) {
  SlotPlan plan;
  for (std::uint32_t i = 0; i < kernel.params.size(); ++i) {
    const ParamRole role = kernel.params[i].role;
    if (role == ParamRole::Input || role == ParamRole::Output)
      plan.slots.push_back(slotOf(i, role == ParamRole::Output));
  }
  if (readsNeighbors(kernel)) {
    for (const FunctionId id : functionsOf(module, kernel)) {
      walkExprs(module.functions[id].body, [&](const Expr& expr) {
        const auto* n = std::get_if<NeighborRead>(&expr.node);
        if (n == nullptr) return;
        const auto offset = constantOffset(module, *n->offset);
        if (offset && isNear(*offset)) addNeighbor(plan, n->stream.id, *offset);
      });
    }
  }
  std::size_t next = 0;
  for (const Slot& slot : plan.slots) {
    plan.firstArrays.push_back(next);
    next += componentCount(module, kernel.params[slot.parameter].type);
  }
  return plan;
}

}  // namespace skc::native
