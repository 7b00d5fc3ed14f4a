// SPDX-License-Identifier: MIT
#include "native/run_code.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "native/call.hpp"
#include "native/chunk_runner.hpp"
#include "native/coalesce.hpp"
#include "native/column_panels.hpp"
#include "native/components.hpp"
#include "native/memory.hpp"
#include "native/padded_rows.hpp"
#include "native/per_worker.hpp"
#include "native/scalars.hpp"
#include "native/slot_arrays.hpp"
#include "native/variable_outputs.hpp"
#include "sk/native/code.hpp"
#include "sk/native/parallel.hpp"
#include "sk/program.hpp"

namespace sk {

namespace {

// Divides the elements of a domain among threads: rows in pieces of neighbours.

/// The rows of a domain, divided into pieces of neighbours along x.
class DomainPieces {
 public:
  /// If the times of elements may differ widely, pieces are short.
  DomainPieces(const native::Extents& domain, bool areUneven)
      : domain_(domain),
        longest_(areUneven ? 1 << 6 : 1 << 13),
        perRow_((domain[0] + longest_ - 1) / longest_) {}

  std::int64_t count() const { return perRow_ * domain_[1] * domain_[2] * domain_[3]; }
  std::int64_t elementsOfOne() const { return std::min(domain_[0], longest_); }

  /// Calls visit(first, count, rows) for the elements of these pieces in order. It joins pieces in one row,
  /// and also whole rows below each other, at most `mostRows` of them.
  template <class Visit>
  void forEachRun(native::Range pieces, std::int64_t mostRows, Visit&& visit) const {
    native::Extents at = firstOf(pieces.begin);
    for (std::int64_t left = pieces.end - pieces.begin; left > 0;) {
      std::int64_t end = domain_[0], rows = 1;
      if (at[0] == 0 && left >= perRow_) {
        rows = std::min({left / perRow_, mostRows, domain_[1] - at[1]});
        left -= rows * perRow_;
      } else {
        end = std::min(end, at[0] + left * longest_);
        left -= (end - at[0] + longest_ - 1) / longest_;
      }
      visit(at, end - at[0], static_cast<std::size_t>(rows));
      at[0] = 0;
      at[1] += rows - 1;
      for (std::size_t d = 1; d < 4 && ++at[d] == domain_[d]; ++d) at[d] = 0;
    }
  }

 private:
  native::Extents firstOf(std::int64_t piece) const {
    const std::int64_t row = piece / perRow_;
    return {piece % perRow_ * longest_, row % domain_[1], row / domain_[1] % domain_[2],
            row / domain_[1] / domain_[2]};
  }

  native::Extents domain_;
  std::int64_t longest_;
  std::int64_t perRow_;
};

/// The rows of a domain in blocks of several rows, divided into pieces along x. The order is down the
/// columns, so that what the rows of successive blocks read stays in the cache.
class RowBlocks {
 public:
  /// Blocks of `rows` rows and `width` columns, at most native::mostLanes.
  RowBlocks(const native::Extents& domain, std::int64_t rows, std::int64_t width)
      : domain_(domain),
        rows_(rows),
        width_(width),
        perColumn_((domain[1] + rows - 1) / rows),
        perRow_((domain[0] + width - 1) / width) {}

  std::int64_t count() const { return perColumn_ * perRow_ * domain_[2] * domain_[3]; }
  std::int64_t elementsOfOne() const { return std::min(domain_[0], width_) * rows_; }

  /// Calls visit(first, count, rows) for each of these blocks: `count` elements in each of `rows` rows.
  template <class Visit>
  void forEach(native::Range blocks, Visit&& visit) const {
    for (std::int64_t block = blocks.begin; block < blocks.end; ++block) {
      const std::int64_t y = block % perColumn_ * rows_;
      const std::int64_t x = block / perColumn_ % perRow_ * width_;
      const std::int64_t plane = block / perColumn_ / perRow_;
      const native::Extents first = {x, y, plane % domain_[2], plane / domain_[2]};
      visit(first, std::min(domain_[0] - x, width_), std::min(domain_[1] - y, rows_));
    }
  }

 private:
  native::Extents domain_;
  std::int64_t rows_, width_;
  std::int64_t perColumn_, perRow_;
};

using native::Deal;
using native::Extents;
using native::Range;
using program::Kernel;
using program::Role;

/// One kernel over one domain.
class CodeRun {
 public:
  /// What the call's operands point to must outlive it.
  CodeRun(const Kernel& kernel, const native::Call& call, const CodeChoice& choice)
      : kernel_(kernel),
        call_(call),
        choice_(choice),
        entry_(entryOf(kernel, native::EntryKind::Run, choice)),
        rowsEntry_(findRowsEntry(kernel, call, choice)),
        frame_(kernel, call, memory_.get()),
        layout_(kernel, call, frame_, choice, memory_.get()),
        pieces_(computed(call), kernel.code->isUneven != 0),
        panels_(kernel, call, rowsEntry_),
        blocks_(computed(call), rowsEntry_ == nullptr ? 1 : rowsEntry_->rows,
                panels_.isEmpty() ? native::mostLanes : panels_.width()),
        padded_(kernel, call, rowsEntry_ == nullptr ? 1 : rowsEntry_->rows, panels_),
        isRecorded_(has(Role::VariableOutput) || has(Role::Scatter)) {}

  void run() {
    if (pieces_.count() == 0) return;
    if (isRecorded_) {
      record();
    } else if (rowsEntry_ != nullptr) {
      runBlocks();
    } else {
      const std::size_t atOnce = rowsAtOnce();
      inParallel(pieces_.count(), [&](Range range) { runPieces(range, frame_.get(), {}, atOnce); });
    }
  }

  /// Like run(), with the memory of the last runAgain() on this thread, if there is too little work for others.
  void runAgain() {
    if (pieces_.count() == 0) return;
    const bool isAlone = rowsEntry_ == nullptr ? native::threadsFor(pieces_.count(), costOfPiece()) == 1
                                               : native::threadsFor(blocks_.count(), costOfBlock()) == 1;
    if (isRecorded_ || !isAlone) return run();
    if (rowsEntry_ != nullptr) {
      copyGathers();
      if (!blockRunner_) blockRunner_.emplace(*this);
      visitBlocks({0, blocks_.count()}, *blockRunner_);
      return;
    }
    const std::size_t atOnce = rowsAtOnce();
    if (!runner_) runner_.emplace(layout_, entry_, frame_.get(), ChunkHook{}, atOnce);
    visitPieces({0, pieces_.count()}, *runner_, atOnce);
  }

  /// Computes a box of the domain on the calling thread. There are no variable and scatter outputs.
  void runBox(const native::Part& box) const {
    const std::size_t atOnce =
        std::min(ChunkRunner::rowsAtOnce(layout_), static_cast<std::size_t>(box.extent[1]));
    const std::int64_t rows = rowsEntry_ != nullptr ? rowsEntry_->rows : static_cast<std::int64_t>(atOnce);
    const std::int64_t width = rowsEntry_ != nullptr ? native::mostLanes : box.extent[0];
    ChunkRunner runner = rowsEntry_ != nullptr ? ChunkRunner(layout_, *rowsEntry_, frame_.get())
                                               : ChunkRunner(layout_, entry_, frame_.get(), {}, atOnce);
    runner.stayNear();
    Extents at = box.first;
    for (std::int64_t w = 0; w < box.extent[3]; ++w) {
      at[3] = box.first[3] + w;
      for (std::int64_t z = 0; z < box.extent[2]; ++z) {
        at[2] = box.first[2] + z;
        for (std::int64_t x = 0; x < box.extent[0]; x += width) {
          at[0] = box.first[0] + x;
          for (std::int64_t y = 0; y < box.extent[1]; y += rows) {
            at[1] = box.first[1] + y;
            runner.run(at, std::min(width, box.extent[0] - x),
                       static_cast<std::size_t>(std::min(rows, box.extent[1] - y)));
          }
        }
      }
    }
  }

  /// True if gathers have border values, which are read when the call is prepared.
  bool hasBorders() const { return layout_.hasBorders(); }

 private:
  /// The extents of what is computed.
  static const Extents& computed(const native::Call& call) {
    return call.part ? call.part->extent : call.domain;
  }
  /// The index in the domain of an element of what is computed.
  Extents inDomain(Extents index) const {
    for (std::size_t d = 0; call_.part && d < index.size(); ++d) index[d] += call_.part->first[d];
    return index;
  }

  /// The RunRows entry; null if there is none, or if one row or less than half of the entry's rows are computed.
  static const native::Entry* findRowsEntry(const Kernel& kernel, const native::Call& call,
                                            const CodeChoice& choice) {
    const native::Entry* const found = findEntry(*kernel.code, native::EntryKind::RunRows, choice);
    const std::int64_t rows = computed(call)[1];
    const bool hasRows = found != nullptr && rows > 1 && 2 * rows >= found->rows;
    return hasRows ? found : nullptr;
  }

  bool has(Role role) const {
    return std::ranges::any_of(kernel_.parameters,
                               [&](const program::Parameter& p) { return p.role == role; });
  }

  void runPieces(Range range, const native::Frame* frame, const ChunkHook& hook,
                 std::size_t rowsAtOnce = 1) const {
    ChunkRunner runner(layout_, entry_, frame, hook, rowsAtOnce);
    visitPieces(range, runner, rowsAtOnce);
  }
  void visitPieces(Range range, ChunkRunner& runner, std::size_t rowsAtOnce) const {
    pieces_.forEachRun(range, static_cast<std::int64_t>(rowsAtOnce),
                       [&](const Extents& first, std::int64_t count, std::size_t rows) {
                         runner.run(inDomain(first), count, rows);
                       });
  }
  std::size_t rowsAtOnce() const {
    return std::min(ChunkRunner::rowsAtOnce(layout_), static_cast<std::size_t>(computed(call_)[1]));
  }

  void runBlocks() {
    copyGathers();
    PerWorker<BlockRunner> runners(native::threadsFor(blocks_.count(), costOfBlock()));
    native::inParallel(blocks_.count(), costOfBlock(), Deal::AsTheyCome,
                       [&](Range range, int worker) { visitBlocks(range, runners.of(worker, *this)); });
  }
  void copyGathers() {
    padded_.copyInto(frame_);
    panels_.fill();
  }
  /// What one thread needs to compute blocks: its own frame if it moves from panel to panel.
  struct BlockRunner {
    explicit BlockRunner(const CodeRun& run)
        : runner(run.layout_, *run.rowsEntry_,
                 run.panels_.isEmpty() ? run.frame_.get() : own.emplace(run.frame_, memory.get()).get()) {}

    CallMemory memory;
    std::optional<CodeFrame> own;
    std::optional<std::int64_t> panel;  ///< the x that `own` has moved to
    ChunkRunner runner;
  };
  void visitBlocks(Range range, BlockRunner& to) const {
    blocks_.forEach(range, [&](const Extents& first, std::int64_t count, std::int64_t rows) {
      const Extents at = inDomain(first);
      if (to.own && to.panel != at[0]) panels_.moveTo(at[0], *to.own);
      to.panel = at[0];
      to.runner.run(at, count, static_cast<std::size_t>(rows));
    });
  }
  std::int64_t costOfBlock() const { return blocks_.elementsOfOne() << 6; }

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

  /// Puts the records of a chunk in the order of elements.
  void sortRecords(RecordFrame& frame) const {
    if (!choice_.mayReorder) frame.sort();
  }

  /// True if scatters are logged. Logs cost time per record, so that few threads gain only if elements take
  /// long to compute.
  bool logsScatters(std::int64_t threads) const {
    constexpr std::int64_t enoughForAll = 8;
    return has(Role::Scatter) && threads >= (kernel_.code->isLight != 0 ? enoughForAll : 2);
  }

  /// Carries out the scatters of a batch of elements before the next batch is computed, so that logs stay
  /// small.
  void record() const {
    if (PushRooms::mayHold(kernel_, elements())) return pushToRooms();
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

  std::int64_t elements() const {
    return call_.domain[0] * call_.domain[1] * call_.domain[2] * call_.domain[3];
  }

  /// Pushes to arrays that have room for all pushes.
  void pushToRooms() const {
    const std::int64_t threads = native::threadsFor(pieces_.count(), costOfPiece());
    const std::int64_t ofSlice = std::max<std::int64_t>(1, elementsOfSlice / pieces_.elementsOfOne());
    const bool isAlone = threads == 1 && !isReordered();
    const std::int64_t slices = isAlone ? 1 : (pieces_.count() + ofSlice - 1) / ofSlice;
    PushRooms rooms(kernel_, call_, choice_.real, slices);
    if (isAlone) {
      RecordFrame frame(kernel_, frame_, {choice_.real, /*isReordered=*/false, /*scatters=*/false});
      rooms.lend(frame);
      runPieces({0, pieces_.count()}, frame.get(), {});
      return rooms.settle(call_.operands, frame);
    }
    native::inParallel(threads, costOfPiece() * pieces_.count() / threads, Deal::Evenly, [&](Range) {
      RecordFrame frame(kernel_, frame_, {choice_.real, isReordered(), /*scatters=*/false});
      const ChunkHook hook =
          isReordered() ? ChunkHook{elementsOfChunk, [&] { sortRecords(frame); }} : ChunkHook{};
      try {
        for (std::int64_t slice = rooms.next(); slice < slices; slice = rooms.next()) {
          const std::int64_t begin = slice * ofSlice;
          runPieces({begin, std::min(begin + ofSlice, pieces_.count())}, frame.get(), hook);
          rooms.place(slice, frame);
        }
      } catch (...) {
        rooms.fail();
        throw;
      }
    });
    rooms.settle(call_.operands);
  }

  void pushPieces(Range pieces, PushParts& pushes) const {
    RecordFrame frame(kernel_, frame_, {choice_.real, isReordered(), /*scatters=*/false});
    runPieces(pieces, frame.get(),
              isReordered() ? ChunkHook{elementsOfChunk, [&] { sortRecords(frame); }} : ChunkHook{});
    pushes.add(pieces.begin, frame.pushed());
  }

  /// Computes pieces and carries out their scatters on one thread.
  void scatterPieces(Range pieces, PushParts& pushes) const {
    if (!isReordered()) return pushPieces(pieces, pushes);
    const Scatters scatters(kernel_, frame_, choice_);
    RecordFrame frame(kernel_, frame_, {choice_.real, isReordered(), /*scatters=*/true});
    runPieces(pieces, frame.get(), {elementsOfChunk, [&] {
                                      sortRecords(frame);
                                      scatters.apply(frame);
                                    }});
    pushes.add(pieces.begin, frame.pushed());
  }

  void logPieces(Range pieces, Scatters& scatters, PushParts& pushes) const {
    RecordFrame frame(kernel_, frame_, {choice_.real, isReordered(), /*scatters=*/true});
    std::unique_ptr<Scatters::Log> log = scatters.newLog();
    runPieces(pieces, frame.get(), {elementsOfChunk, [&] {
                                      sortRecords(frame);
                                      scatters.move(frame, *log);
                                    }});
    pushes.add(pieces.begin, frame.pushed());
    scatters.add(pieces.begin, std::move(log));
  }

  /// The elements whose records are sorted and moved together, so that these stay in the nearest cache.
  static constexpr std::int64_t elementsOfChunk = 1 << 10;
  /// The elements whose pushes a thread copies together, so that these stay in a cache.
  static constexpr std::int64_t elementsOfSlice = 1 << 15;
  /// The elements per thread whose records are carried out later. The logs of the simplest kernels stay in a
  /// cache.
  static constexpr std::int64_t elementsOfLog = 1 << 15;

  const Kernel& kernel_;
  const native::Call call_;
  CodeChoice choice_;
  const native::Entry& entry_;
  const native::Entry* rowsEntry_;
  CallMemory memory_;
  CodeFrame frame_;
  SlotLayout layout_;
  DomainPieces pieces_;
  ColumnPanels panels_;
  RowBlocks blocks_;  ///< for rowsEntry_
  PaddedRows padded_;
  bool isRecorded_;
  std::optional<BlockRunner> blockRunner_;  ///< of runAgain(), like runner_
  std::optional<ChunkRunner> runner_;
};

}  // namespace

void runCode(const Kernel& kernel, const native::Call& call, const CodeChoice& choice) {
  CodeRun(kernel, call, choice).run();
}

namespace {

/// Where each operand's list of arrays is, and these.
std::vector<const void*> arraysOf(std::span<const native::Operand> operands) {
  std::vector<const void*> arrays;
  for (const native::Operand& operand : operands) {
    arrays.push_back(operand.components.data());
    arrays.insert(arrays.end(), operand.components.begin(), operand.components.end());
  }
  return arrays;
}

}  // namespace

struct RepeatedCode::State {
  State(const Kernel& kernel, const native::Call& call, const CodeChoice& choice)
      : operands(call.operands.begin(), call.operands.end()),
        arrays(arraysOf(operands)),
        code(kernel, {operands, call.domain, call.tables, call.part, call.isSilent}, choice) {}

  bool has(const native::Call& call) const {
    auto next = arrays.begin();
    for (const native::Operand& operand : call.operands) {
      if (*next++ != operand.components.data()) return false;
      for (const void* const array : operand.components) {
        if (*next++ != array) return false;
      }
    }
    return true;
  }

  std::vector<native::Operand> operands;
  std::vector<const void*> arrays;  ///< where each operand's list of arrays is, and these
  CodeRun code;
};

RepeatedCode::RepeatedCode(const Kernel& kernel, const CodeChoice& choice, bool hasNewValues)
    : kernel_(kernel), choice_(choice), hasNewValues_(hasNewValues) {}
RepeatedCode::~RepeatedCode() = default;

RepeatedCode::State& RepeatedCode::stateOf(const native::Call& call) {
  constexpr std::size_t most = 6;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    last_ = last_ + 1 < states_.size() ? last_ + 1 : 0;
    if (states_[last_]->has(call)) return *states_[last_];
  }
  auto made = std::make_unique<State>(kernel_, call, choice_);
  if (states_.size() < most) {
    last_ = states_.size();
    states_.push_back(std::move(made));
  } else {
    last_ = last_ + 1 < most ? last_ + 1 : 0;
    states_[last_] = std::move(made);
  }
  return *states_[last_];
}

void RepeatedCode::run(const native::Call& call) {
  State& state = stateOf(call);
  if (hasNewValues_ && state.code.hasBorders()) {  // these may depend on the values
    runCode(kernel_, call, choice_);
  } else {
    state.code.runAgain();
  }
}

struct BoxCode::State {
  State(const Kernel& kernel, const native::Call& call, const CodeChoice& choice)
      : operands(call.operands.begin(), call.operands.end()), lists(operands.size()) {
    for (std::size_t i = 0; i < operands.size(); ++i) {
      lists[i].assign(operands[i].components.begin(), operands[i].components.end());
      if (!lists[i].empty()) operands[i].components = lists[i];
    }
    code.emplace(kernel, native::Call{operands, call.domain, call.tables, call.part, call.isSilent}, choice);
    domain = call.domain;
    if (call.part) return;
    inLine = operands;
    Extents merged = domain, block = domain;
    coalesce(kernel, inLine, merged, block);
    const std::int64_t elements = domain[0] * domain[1] * domain[2] * domain[3];
    if (merged != domain && merged[0] == elements)
      line.emplace(kernel, native::Call{inLine, merged, call.tables, {}, call.isSilent}, choice);
  }

  void run(const native::Part& box) const {
    std::size_t slowest = 3;
    while (slowest > 0 && box.extent[slowest] == 1) --slowest;
    bool isInLine = line.has_value();
    std::int64_t first = 0, count = 1;
    for (std::size_t d = domain.size(); d-- > 0;) {
      isInLine = isInLine && (d >= slowest || box.extent[d] == domain[d]);
      first = first * domain[d] + box.first[d];
      count *= box.extent[d];
    }
    isInLine ? line->runBox({{first, 0, 0, 0}, {count, 1, 1, 1}}) : code->runBox(box);
  }

  std::vector<native::Operand> operands;
  std::vector<std::vector<void*>>
      lists;  ///< the arrays of each operand: those of a stream may move to another stream
  std::optional<CodeRun> code;
  Extents domain{};
  /// The same for elements in one row, if the kernel does not care: rows below each other are computed together then.
  std::vector<native::Operand> inLine;
  std::optional<CodeRun> line;
};

BoxCode::BoxCode(const Kernel& kernel, const native::Call& call, const CodeChoice& choice)
    : state_(std::make_unique<State>(kernel, call, choice)) {}
BoxCode::~BoxCode() = default;

bool BoxCode::hasArraysOf(const native::Call& call) const {
  return std::ranges::equal(call.operands, state_->lists,
                            [](const native::Operand& operand, const std::vector<void*>& list) {
                              return std::ranges::equal(operand.components, list);
                            });
}

bool BoxCode::hasBorders() const { return state_->code->hasBorders(); }
void BoxCode::run(const native::Part& box) const { state_->run(box); }

}  // namespace sk
