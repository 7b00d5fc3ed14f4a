// SPDX-License-Identifier: MIT
//
// The functions of a kernel that the runtime calls (sk/native/code.hpp): the loops around the code of its entry.
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

/// A kernel as an entry is written for it. The module has been through `predicate` where there is more than one lane.
struct EntrySource {
  const ir::Module& module;
  const ir::Kernel& kernel;
  const SlotPlan& slots;
  const analysis::Uniformity* uniformity;  ///< null with one lane
  const RowPlan* rowPlan;  ///< null unless a RunRows is written
  std::uint32_t rows;  ///< of that
  Form form;
  CpuLevel level;
  DebugInfo* debug;
};

/// Writes the function of this kind; its name begins with that of the kernel's Code.
llvm::Function* writeEntry(llvm::Module& code, const EntrySource& source, sk::native::EntryKind kind,
                           const std::string& name);

/// What a kernel needs, apart from RunRows: Run, or Fold and, with identities, Identity; Combine where it folds accumulators
/// into accumulators; Borders where a gather with slots has one; Apply where it scatters.
std::vector<sk::native::EntryKind> entriesOf(const ir::Module& module, const ir::Kernel& kernel);

}  // namespace skc::native
