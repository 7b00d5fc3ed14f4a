// SPDX-License-Identifier: MIT
#include "native/fold_code.hpp"

#include <vector>

#include "call/fold_check_setting.hpp"
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

}  // namespace

void foldCode(const program::Reduction& reduction, const native::ReduceCall& call, const CodeChoice& choice) {
  if (!call.scan && call.rows == nullptr && sumsFloats(reduction, call.fold, choice)) {
    sumFloats(reduction, call, choice);
    return;
  }
  const Entry& fold = entryOf(reduction.fold, EntryKind::Fold, choice);
  const Entry& combine = entryOf(reduction.combine, EntryKind::Combine, choice);
  const CodeFrame frame(reduction.fold, call.fold);
  const CodeFrame combineFrame(reduction.combine, call.combine);
  const SlotLayout layout(reduction.fold, call.fold, frame,
                          call.holdsFloats ? CodeChoice{.real = RealType::Float} : choice);
  const StateShape shape(reduction.fold.parameters, choice.real);
  const FoldResults results(reduction.fold.parameters, call.fold.operands, shape);
  const FoldProgram program{.layout = layout,
                            .shape = shape,
                            .fold = bound<native::FoldFunction>(fold, frame),
                            .combine = bound<native::CombineFunction>(combine, combineFrame),
                            .isCommutative = reduction.commutative,
                            .isUneven = reduction.fold.code->isUneven != 0};
  if (checksFolds() && !reduction.commutative) checkFold(reduction, program, call.fold, choice);
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
  const ScanProgram scanProgram{program, bound<native::ScanFunction>(scan, frame), identities,
                                call.scan->isExclusive, call.scan->combinesRuns};
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
