// SPDX-License-Identifier: MIT
//
// Writes the functions of a kernel that the runtime calls (sk/native/code.hpp): loops around its entry.
#pragma once

#include <optional>
#include <string>

#include <llvm/IR/Function.h>
#include <llvm/IR/Module.h>

#include "analysis/uniformity.hpp"
#include "ir/ir.hpp"
#include "native/lanes.hpp"
#include "native/row_plan.hpp"
#include "native/streams.hpp"
#include "native/target.hpp"

namespace skc::native {

class DebugInfo;

/// What an entry is written from. If there are several lanes, the module must have passed `predicate`.
struct EntrySource {
  const ir::Module& module;
  const ir::Kernel& kernel;
  const SlotPlan& slots;
  const analysis::Uniformity* uniformity;  ///< null with one lane
  const RowPlan* rowPlan;  ///< null except for RunRows
  std::uint32_t rows;  ///< rows computed together
  bool numbersRecords;  ///< records carry the numbers of their elements (Code::isReordered)
  CodegenOptions options;
  CpuLevel level;
  DebugInfo* debug;
};

/// Writes the function of this kind.
llvm::Function* writeEntry(llvm::Module& code, const EntrySource& source, sk::native::EntryKind kind,
                           const std::string& name);

/// True if every accumulator of a reduction has an identity.
bool hasIdentities(const ir::Kernel& kernel);

/// The kinds of entries that a kernel needs, apart from RunRows. A reduction needs Fold and FoldRows, Combine if it folds
/// accumulators into accumulators, Identity if it has identities, and Scan if it `scans`. Any other kernel needs Run, and Borders
/// if a gather has a border value. Either needs Apply if it scatters.
std::vector<sk::native::EntryKind> entriesOf(const ir::Module& module, const ir::Kernel& kernel, bool scans);

/// True if a reduction can have FoldFloatRows: only the arrays of arguments hold floats, not those of the code.
bool mayHoldFloats(const ir::Module& module, const ir::Kernel& kernel);

}  // namespace skc::native
