// SPDX-License-Identifier: MIT
//
// Writes the constant sk::native::Code of a kernel, with the layout that the runtime's C++ expects.
#pragma once

#include <string>
#include <vector>

#include <llvm/IR/Module.h>

#include "sk/native/code.hpp"

namespace skc::native {

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
