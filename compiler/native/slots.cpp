// SPDX-License-Identifier: MIT
#include "native/slots.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include <llvm/IR/Constants.h>
#include <llvm/IR/IRBuilder.h>

#include "ir/call_graph.hpp"
#include "ir/evaluate.hpp"
#include "ir/walk.hpp"
#include "native/leaves.hpp"

namespace skc::native {

using namespace ir;
using sk::native::Code;
using sk::native::Entry;
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

namespace {

// The LLVM structs below have the members of the C++ structs in the same order. The layouts are equal on all
// 64-bit machines.
static_assert(sizeof(Entry) == 16 && offsetof(Entry, kind) == 8 && offsetof(Entry, lanes) == 12 &&
              offsetof(Entry, rows) == 13);
static_assert(sizeof(Slot) == 6);
static_assert(sizeof(Code) == 40 && offsetof(Code, entries) == 8 && offsetof(Code, slotCount) == 24 &&
              offsetof(Code, isReordered) == 29 && offsetof(Code, isLight) == 30 &&
              offsetof(Code, sharedGathers) == 32);

class TableData {
 public:
  explicit TableData(llvm::Module& module) : module_(module), context_(module.getContext()) {}

  llvm::Constant* byte(std::uint64_t value) {
    return llvm::ConstantInt::get(llvm::Type::getInt8Ty(context_), value);
  }
  llvm::Constant* word(std::uint64_t value) {
    return llvm::ConstantInt::get(llvm::Type::getInt32Ty(context_), value);
  }
  llvm::Constant* longWord(std::uint64_t value) {
    return llvm::ConstantInt::get(llvm::Type::getInt64Ty(context_), value);
  }
  llvm::Constant* record(const std::vector<llvm::Constant*>& members) {
    return llvm::ConstantStruct::getAnon(context_, members);
  }
  /// The address of a constant array of `items`; null if there are none.
  llvm::Constant* array(const std::vector<llvm::Constant*>& items) {
    if (items.empty()) return llvm::ConstantPointerNull::get(llvm::PointerType::get(context_, 0));
    auto* const type = llvm::ArrayType::get(items[0]->getType(), items.size());
    auto* const data = new llvm::GlobalVariable(module_, type, true, llvm::GlobalValue::PrivateLinkage,
                                                llvm::ConstantArray::get(type, items));
    data->setAlignment(llvm::Align(8));
    return data;
  }

 private:
  llvm::Module& module_;
  llvm::LLVMContext& context_;
};

}  // namespace

void writeCodeTable(llvm::Module& code, const CodeTable& table) {
  TableData c(code);
  std::vector<llvm::Constant*> entries, slots;
  for (const EntryFunction& entry : table.entries) {
    entries.push_back(c.record(
        {entry.function, c.byte(static_cast<std::uint64_t>(entry.kind)),
         c.byte(static_cast<std::uint64_t>(entry.real)), c.byte(static_cast<std::uint64_t>(entry.level)),
         c.byte(entry.isContracted ? 1 : 0), c.byte(entry.lanes), c.byte(entry.rows)}));
  }
  for (const Slot& slot : table.slots) {
    std::vector<llvm::Constant*> members = {c.byte(slot.parameter)};
    for (const std::int8_t row : slot.row) members.push_back(c.byte(static_cast<std::uint8_t>(row)));
    members.push_back(c.byte(slot.reach));
    members.push_back(c.byte(slot.isOutput));
    slots.push_back(c.record(members));
  }
  llvm::Constant* const value =
      c.record({c.word(Code::currentVersion), c.word(entries.size()), c.array(entries), c.array(slots),
                c.word(slots.size()), c.byte(table.isUneven ? 1 : 0), c.byte(table.isReordered ? 1 : 0),
                c.byte(table.isLight ? 1 : 0), c.longWord(table.sharedGathers)});
  auto* const global = new llvm::GlobalVariable(code, value->getType(), true,
                                                llvm::GlobalValue::ExternalLinkage, value, table.symbol);
  global->setVisibility(llvm::GlobalValue::HiddenVisibility);
  global->setAlignment(llvm::Align(8));
}

}  // namespace skc::native
