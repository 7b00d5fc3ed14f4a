// SPDX-License-Identifier: MIT
#include "native/fold_code.hpp"

#include <vector>

#include "call/check_setting.hpp"
#include "native/call_memory.hpp"
#include "native/check_fold.hpp"
#include "native/code_frame.hpp"
#include "native/fold_program.hpp"
#include "native/fold_rows.hpp"
#include "native/scan_blocks.hpp"
#include "native/sum_floats.hpp"

namespace sk {

namespace {

using native::Entry;
using native::EntryKind;

template <class Function>
Bound<Function> bound(const Entry& entry, const CodeFrame& frame) {
  return {functionOf<Function>(entry), entry.lanes, frame.get()};
}

/// Tries the fold, which must not change any output.
void checkWithoutOutputs(const program::Reduction& reduction, const FoldProgram& program,
                         const native::Call& call, const CodeChoice& choice) {
  if (!program.layout.hasOutputs()) return checkFold(reduction, program, call, choice);
  std::vector<native::Operand> operands(call.operands.begin(), call.operands.end());
  for (std::size_t i = 0; i < operands.size(); ++i) {
    if (reduction.fold.parameters[i].role == program::Role::Output) operands[i].components = {};
  }
  const native::Call alone{operands, call.domain, call.tables};
  const CodeFrame frame(reduction.fold, alone);
  const SlotLayout layout(reduction.fold, alone, frame, choice);
  const FoldProgram tried{.layout = layout,
                          .shape = program.shape,
                          .fold = {program.fold.function, program.fold.lanes, frame.get()},
                          .combine = program.combine,
                          .isCommutative = program.isCommutative,
                          .isUneven = program.isUneven};
  checkFold(reduction, tried, alone, choice);
}

}  // namespace

void foldCode(const program::Reduction& reduction, const native::ReduceCall& call, const CodeChoice& choice) {
  if (call.rows == nullptr && sumsFloats(reduction, call.fold, choice)) {
    sumFloats(reduction, call, choice);
    return;
  }
  const Entry& fold = entryOf(reduction.fold, EntryKind::Fold, choice);
  const Entry& combine = entryOf(reduction.combine, EntryKind::Combine, choice);
  CallMemory memory;
  const CodeFrame frame(reduction.fold, call.fold, memory.get());
  const CodeFrame combineFrame(reduction.combine, call.combine, memory.get());
  const SlotLayout layout(reduction.fold, call.fold, frame,
                          call.holdsFloats ? CodeChoice{.real = RealType::Float} : choice, memory.get());
  const StateShape shape(reduction.fold.parameters, choice.real);
  const FoldResults results(reduction.fold.parameters, call.fold.operands, shape);
  const FoldProgram program{.layout = layout,
                            .shape = shape,
                            .fold = bound<native::FoldFunction>(fold, frame),
                            .combine = bound<native::CombineFunction>(combine, combineFrame),
                            .isCommutative = reduction.commutative,
                            .isUneven = reduction.fold.code->isUneven != 0};
  if (checksFolds() && !reduction.commutative) checkWithoutOutputs(reduction, program, call.fold, choice);
  const auto rowsOf = [&] {
    const EntryKind kind = call.holdsFloats ? EntryKind::FoldFloatRows : EntryKind::FoldRows;
    return RowsProgram{program,
                       bound<native::FoldRowsFunction>(entryOf(reduction.fold, kind, choice), frame)};
  };
  if (!call.scan && call.rows != nullptr) {
    foldRows(rowsOf(), *call.rows, results);
    return;
  }
  if (!call.scan) {
    foldBlocks(program, call.fold.domain, call.block, results);
    return;
  }
  native::ValuesFunction* const identities =
      call.scan->isExclusive || call.scan->combinesRuns
          ? functionOf<native::ValuesFunction>(entryOf(reduction.fold, EntryKind::Identity, choice))
          : nullptr;
  const Entry& scan = entryOf(reduction.fold, EntryKind::Scan, choice);
  const ScanProgram scanProgram{program,
                                bound<native::ScanFunction>(scan, frame),
                                identities,
                                call.scan->isExclusive,
                                call.scan->combinesRuns,
                                false};
  if (call.rows != nullptr) {
    scanRows(scanProgram, rowsOf(), *call.rows, results);
    return;
  }
  scanBlocks(scanProgram, call.fold.domain, call.block, results);
}

void storeIdentities(const program::Reduction& reduction, const native::Call& call,
                     const CodeChoice& choice) {
  const CodeFrame frame(reduction.fold, call);
  const StateShape shape(reduction.fold.parameters, choice.real);
  const StateColumns identities(shape, 1);
  const Entry& entry = entryOf(reduction.fold, EntryKind::Identity, choice);
  functionOf<native::ValuesFunction>(entry)(frame.get(), identities.arrays());
  FoldResults(reduction.fold.parameters, call.operands, shape).store({}, identities, 1);
}

}  // namespace sk
