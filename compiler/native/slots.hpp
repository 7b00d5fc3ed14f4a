// SPDX-License-Identifier: MIT
//
// The slots of a kernel (sk/native/code.hpp): the parameters, and the rows of a gather's neighbours, for
// whose elements a chunk has arrays.
//
// Writes the constant sk::native::Code of a kernel, with the layout that the runtime's C++ expects.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <llvm/IR/Module.h>

#include "ir/ir.hpp"
#include "sk/native/code.hpp"

namespace skc::native {

struct SlotPlan {
  std::vector<sk::native::Slot> slots;

  /// A slot and its first array.
  struct Location {
    std::size_t slot;
    std::size_t firstArray;
  };
  /// The slot of this parameter and row.
  std::optional<Location> find(std::uint32_t parameter, const std::int8_t (&row)[3]) const;
  std::vector<std::size_t> firstArrays;  ///< the first array of each slot
};

/// True if neighbours at constant offsets have slots: not in reductions without outputs.
bool readsNeighbors(const ir::Kernel& kernel);

/// Plans slots for inputs, outputs and, if readsNeighbors(), rows of neighbours at constant offsets.
SlotPlan planSlots(const ir::Module& module, const ir::Kernel& kernel);

/// True if neighbours at this constant offset are read from a slot. Those farther away are read like any
/// gather.
bool isNear(const std::vector<std::int32_t>& offset);

/// The components of a constant offset, x first; nullopt if it is not constant.
std::optional<std::vector<std::int32_t>> constantOffset(const ir::Module& module, const ir::Expr& offset);

struct EntryFunction {
  llvm::Function* function;
  sk::native::EntryKind kind;
  sk::native::Real real;
  sk::native::Level level;
  bool isContracted;
  std::uint32_t lanes;
  std::uint32_t rows;
};

struct CodeTable {
  std::string symbol;
  std::vector<EntryFunction> entries;
  std::vector<sk::native::Slot> slots;
  bool isUneven;
  bool isReordered;
  bool isLight;
  std::uint64_t sharedGathers = 0;  ///< bits of parameters (Code::sharedGathers)
};

void writeCodeTable(llvm::Module& code, const CodeTable& table);

}  // namespace skc::native
