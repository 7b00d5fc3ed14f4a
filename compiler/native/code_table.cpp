// SPDX-License-Identifier: MIT
#include "native/code_table.hpp"

#include <cstddef>

#include <llvm/IR/Constants.h>
#include <llvm/IR/IRBuilder.h>

namespace skc::native {

using sk::native::Code;
using sk::native::Entry;
using sk::native::Slot;

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
