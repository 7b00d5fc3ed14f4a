// SPDX-License-Identifier: MIT
#include "native/run_code.hpp"

#include <algorithm>
#include <memory>

#include "native/call_memory.hpp"
#include "native/chunk_runner.hpp"
#include "native/code_frame.hpp"
#include "native/push_parts.hpp"
#include "native/record_buffer.hpp"
#include "native/row_pieces.hpp"
#include "native/scatters.hpp"
#include "native/slot_arrays.hpp"
#include "sk/native/parallel.hpp"

namespace sk {

namespace {

using native::Deal;
using native::Extents;
using native::Range;
using program::Kernel;
using program::Role;

/// One kernel over one domain.
class CodeRun {
 public:
  CodeRun(const Kernel& kernel, const native::Call& call, const CodeChoice& choice)
      : kernel_(kernel),
        call_(call),
        choice_(choice),
        entry_(entryOf(kernel, native::EntryKind::Run, choice)),
        rowsEntry_(findRowsEntry(kernel, call, choice)),
        frame_(kernel, call, memory_.get()),
        layout_(kernel, call, frame_, choice, memory_.get()),
        pieces_(call.domain, kernel.code->isUneven != 0) {}

  void run() {
    if (pieces_.count() == 0) return;
    if (has(Role::VariableOutput) || has(Role::Scatter)) {
      record();
    } else if (rowsEntry_ != nullptr) {
      runBlocks();
    } else {
      const auto rows = static_cast<std::size_t>(call_.domain[1]);
      const std::size_t atOnce = std::min(ChunkRunner::rowsAtOnce(layout_), rows);
      inParallel(pieces_.count(), [&](Range range) { runPieces(range, frame_.get(), {}, atOnce); });
    }
  }

 private:
  /// The RunRows entry; null if there is none, or if the domain has one row or less than half of the entry's
  /// rows.
  static const native::Entry* findRowsEntry(const Kernel& kernel, const native::Call& call,
                                            const CodeChoice& choice) {
    const native::Entry* const found = findEntry(*kernel.code, native::EntryKind::RunRows, choice);
    const bool hasRows = found != nullptr && call.domain[1] > 1 && 2 * call.domain[1] >= found->rows;
    return hasRows ? found : nullptr;
  }

  bool has(Role role) const {
    return std::ranges::any_of(kernel_.parameters,
                               [&](const program::Parameter& p) { return p.role == role; });
  }

  void runPieces(Range range, const native::Frame* frame, const ChunkHook& hook,
                 std::size_t rowsAtOnce = 1) const {
    ChunkRunner runner(layout_, entry_, frame, hook, rowsAtOnce);
    pieces_.forEachRun(
        range, static_cast<std::int64_t>(rowsAtOnce),
        [&](const Extents& first, std::int64_t count, std::size_t rows) { runner.run(first, count, rows); });
  }

  void runBlocks() const {
    const RowBlocks blocks(call_.domain, rowsEntry_->rows);
    native::inParallel(blocks.count(), blocks.elementsOfOne() << 6, Deal::AsTheyCome, [&](Range range) {
      ChunkRunner runner(layout_, *rowsEntry_, frame_.get());
      blocks.forEach(range, [&](const Extents& first, std::int64_t count, std::int64_t rows) {
        runner.run(first, count, static_cast<std::size_t>(rows));
      });
    });
  }

  bool isUneven() const { return kernel_.code->isUneven != 0; }
  std::int64_t costOfPiece() const { return pieces_.elementsOfOne() * (isUneven() ? 1 << 6 : 1); }

  template <class Work>
  void inParallel(std::int64_t pieces, Work&& work) const {
    native::inParallel(pieces, costOfPiece(), isUneven() ? Deal::AsTheyCome : Deal::Evenly,
                       [&](Range range) { work(range); });
  }

  // ---- variable and scatter outputs --------------------------------------------------------------

  /// True if records carry element numbers: an element may have several records, and several elements are
  /// computed together.
  bool isReordered() const { return kernel_.code->isReordered != 0 && entry_.lanes > 1; }

  /// True if scatters are logged. Logs cost time per record, so that few threads gain only if elements take
  /// long to compute.
  bool logsScatters(std::int64_t threads) const {
    constexpr std::int64_t enoughForAll = 8;
    return has(Role::Scatter) && threads >= (kernel_.code->isLight != 0 ? enoughForAll : 2);
  }

  /// Carries out the scatters of a batch of elements before the next batch is computed, so that logs stay
  /// small.
  void record() const {
    PushParts pushes;
    const std::int64_t threads = native::threadsFor(pieces_.count(), costOfPiece());
    if (logsScatters(threads)) {
      Scatters scatters(kernel_, frame_, choice_);
      const std::int64_t batch = std::max<std::int64_t>(1, threads * elementsOfLog / pieces_.elementsOfOne());
      for (std::int64_t begin = 0; begin < pieces_.count(); begin += batch) {
        inParallel(std::min(batch, pieces_.count() - begin), [&](Range range) {
          logPieces({begin + range.begin, begin + range.end}, scatters, pushes);
        });
        scatters.applyLogs();
      }
    } else if (has(Role::Scatter)) {
      scatterPieces({0, pieces_.count()}, pushes);
    } else {
      inParallel(pieces_.count(), [&](Range range) { pushPieces(range, pushes); });
    }
    pushes.store(call_.operands);
  }

  void pushPieces(Range pieces, PushParts& pushes) const {
    RecordFrame frame(kernel_, frame_, {choice_.real, isReordered(), /*scatters=*/false});
    runPieces(pieces, frame.get(),
              isReordered() ? ChunkHook{elementsOfChunk, [&] { frame.sort(); }} : ChunkHook{});
    pushes.add(pieces.begin, frame.pushed());
  }

  /// Computes pieces and carries out their scatters on one thread.
  void scatterPieces(Range pieces, PushParts& pushes) const {
    if (!isReordered()) return pushPieces(pieces, pushes);
    const Scatters scatters(kernel_, frame_, choice_);
    RecordFrame frame(kernel_, frame_, {choice_.real, isReordered(), /*scatters=*/true});
    runPieces(pieces, frame.get(), {elementsOfChunk, [&] {
                                      frame.sort();
                                      scatters.apply(frame);
                                    }});
    pushes.add(pieces.begin, frame.pushed());
  }

  void logPieces(Range pieces, Scatters& scatters, PushParts& pushes) const {
    RecordFrame frame(kernel_, frame_, {choice_.real, isReordered(), /*scatters=*/true});
    std::unique_ptr<Scatters::Log> log = scatters.newLog();
    runPieces(pieces, frame.get(), {elementsOfChunk, [&] {
                                      frame.sort();
                                      scatters.move(frame, *log);
                                    }});
    pushes.add(pieces.begin, frame.pushed());
    scatters.add(pieces.begin, std::move(log));
  }

  /// The elements whose records are sorted and moved together, so that these stay in the nearest cache.
  static constexpr std::int64_t elementsOfChunk = 1 << 10;
  /// The elements per thread whose records are carried out later. The logs of the simplest kernels stay in a
  /// cache.
  static constexpr std::int64_t elementsOfLog = 1 << 15;

  const Kernel& kernel_;
  const native::Call& call_;
  CodeChoice choice_;
  const native::Entry& entry_;
  const native::Entry* rowsEntry_;
  CallMemory memory_;
  CodeFrame frame_;
  SlotLayout layout_;
  RowPieces pieces_;
};

}  // namespace

void runCode(const Kernel& kernel, const native::Call& call, const CodeChoice& choice) {
  CodeRun(kernel, call, choice).run();
}

}  // namespace sk
