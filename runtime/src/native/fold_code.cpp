// SPDX-License-Identifier: MIT
#include "native/fold_code.hpp"

#include <cstring>
#include <vector>

#include "call/check_setting.hpp"
#include "native/check_fold.hpp"
#include "native/code_frame.hpp"
#include "native/fold_program.hpp"
#include "native/fold_rows.hpp"
#include "native/memory.hpp"
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
  const native::Call alone{operands, call.domain, call.tables, call.part};
  const CodeFrame frame(reduction.fold, alone);
  const SlotLayout layout(reduction.fold, alone, frame, choice);
  const FoldProgram tried{.layout = layout,
                          .shape = program.shape,
                          .fold = {program.fold.function, program.fold.lanes, frame.get()},
                          .combine = program.combine,
                          .isCommutative = program.isCommutative,
                          .isUneven = program.isUneven,
                          .first = program.first};
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
                            .isUneven = reduction.fold.code->isUneven != 0,
                            .first = call.fold.computed().first};
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
    foldBlocks(program, call.fold.computed().extent, call.block, results);
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

void combineParts(const program::Reduction& reduction, const native::Call& combine, const CodeChoice& choice,
                  std::span<void* const> parts, std::int64_t count, std::span<void* const> result) {
  const Entry& entry = entryOf(reduction.combine, EntryKind::Combine, choice);
  const CodeFrame frame(reduction.combine, combine);
  const StateShape shape(reduction.fold.parameters, choice.real);
  StateColumns columns(shape, count);
  for (std::size_t scalar = 0; scalar < shape.scalars(); ++scalar) {
    std::memcpy(columns.at(scalar, 0), parts[scalar],
                static_cast<std::size_t>(count) * shape.bytesOf(scalar));
  }
  ColumnCombiner combiner(shape, functionOf<native::CombineFunction>(entry), entry.lanes, frame.get());
  StateRuns runs(shape, combiner, 1);
  for (std::int64_t k = 0; k < count; ++k) {
    runs.next().assign(0, columns, k, 1);
    runs.add();
  }
  const StateColumns& all = runs.take();
  for (std::size_t scalar = 0; scalar < shape.scalars(); ++scalar)
    std::memcpy(result[scalar], all.at(scalar, 0), shape.bytesOf(scalar));
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
