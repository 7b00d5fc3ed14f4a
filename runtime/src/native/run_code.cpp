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
        frame_(kernel, call, memory_.get()),
        layout_(kernel, call, frame_, choice, memory_.get()),
        pieces_(call.domain, kernel.code->isUneven != 0) {}

  void run() {
    if (pieces_.count() == 0) return;
    if (has(Role::VariableOutput) || has(Role::Scatter)) {
      record();
    } else {
      inParallel(pieces_.count(), [&](Range range) { runPieces(range, frame_.get()); });
    }
  }

 private:
  bool has(Role role) const {
    return std::ranges::any_of(kernel_.parameters,
                               [&](const program::Parameter& p) { return p.role == role; });
  }

  void runPieces(Range range, const native::Frame* frame, const ChunkHook& hook = {}) const {
    ChunkRunner runner(layout_, entry_, frame, hook);
    pieces_.forEachRun(range, [&](const Extents& first, std::int64_t count) { runner.run(first, count); });
  }

  bool isUneven() const { return kernel_.code->isUneven != 0; }
  std::int64_t costOfPiece() const { return pieces_.elementsOfOne() * (isUneven() ? 1 << 6 : 1); }

  template <class Work>
  void inParallel(std::int64_t pieces, Work&& work) const {
    native::inParallel(pieces, costOfPiece(), isUneven() ? Deal::AsTheyCome : Deal::Evenly,
                       [&](Range range) { work(range); });
  }

  // ---- variable and scatter outputs --------------------------------------------------------------

  bool isReordered() const { return kernel_.code->isReordered != 0 && entry_.lanes > 1; }

  /// What is scattered by many elements is carried out before the next ones are computed, so that logs stay small.
  void record() const {
    PushParts pushes;
    Scatters scatters(kernel_, frame_, choice_);
    const std::int64_t threads = native::threadsFor(pieces_.count(), costOfPiece());
    const bool keepsLogs = !scatters.isEmpty() && threads > 1;
    const std::int64_t batch =
        keepsLogs ? std::max<std::int64_t>(1, threads * elementsOfLog / pieces_.elementsOfOne())
                  : pieces_.count();
    for (std::int64_t begin = 0; begin < pieces_.count(); begin += batch) {
      inParallel(std::min(batch, pieces_.count() - begin), [&](Range range) {
        const Range part{begin + range.begin, begin + range.end};
        RecordFrame frame(kernel_, frame_, choice_.real, isReordered());
        std::unique_ptr<Scatters::Log> log = keepsLogs ? scatters.newLog() : nullptr;
        recordPieces(part, frame, scatters, log.get());
        if (!frame.pushed().empty()) pushes.add(part.begin, frame.pushed());
        if (log) scatters.add(part.begin, std::move(log));
      });
      if (keepsLogs) scatters.applyLogs();
    }
    pushes.store(call_.operands);
  }

  void recordPieces(Range pieces, RecordFrame& frame, const Scatters& scatters, Scatters::Log* log) const {
    const auto settle = [&] {
      frame.sort();
      if (log != nullptr) {
        scatters.move(frame, *log);
      } else {
        scatters.apply(frame);
      }
    };
    const bool needsNothing = scatters.isEmpty() && !isReordered();
    runPieces(pieces, frame.get(), needsNothing ? ChunkHook{} : ChunkHook{elementsOfChunk, settle});
  }

  /// Elements whose records are sorted and carried out together: these stay in the nearest cache.
  static constexpr std::int64_t elementsOfChunk = 1 << 10;
  /// Elements of a thread whose records are carried out later: they stay in a cache.
  static constexpr std::int64_t elementsOfLog = 1 << 16;

  const Kernel& kernel_;
  const native::Call& call_;
  CodeChoice choice_;
  const native::Entry& entry_;
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
