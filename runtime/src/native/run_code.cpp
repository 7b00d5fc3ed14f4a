// SPDX-License-Identifier: MIT
#include "native/run_code.hpp"

#include <algorithm>

#include "native/chunk_runner.hpp"
#include "native/code_frame.hpp"
#include "native/push_buffers.hpp"
#include "native/row_pieces.hpp"
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
        real_(choice.real),
        entry_(entryOf(kernel, native::EntryKind::Run, choice)),
        frame_(kernel, call),
        layout_(kernel, call, frame_, choice),
        pieces_(call.domain, kernel.code->isUneven != 0) {}

  void run() {
    if (pieces_.count() == 0) return;
    if (has(Role::VariableOutput)) {
      push();
    } else if (kernel_.code->isOrdered != 0) {
      runPieces({0, pieces_.count()}, frame_.get());
    } else {
      inParallel([&](Range range) { runPieces(range, frame_.get()); });
    }
  }

 private:
  bool has(Role role) const {
    return std::ranges::any_of(kernel_.parameters,
                               [&](const program::Parameter& p) { return p.role == role; });
  }

  void runPieces(Range range, const native::Frame* frame) const {
    ChunkRunner runner(layout_, entry_, frame);
    pieces_.forEachRun(range, [&](const Extents& first, std::int64_t count) { runner.run(first, count); });
  }

  template <class Work>
  void inParallel(Work&& work) const {
    const bool isUneven = kernel_.code->isUneven != 0;
    native::inParallel(pieces_.count(), pieces_.elementsOfOne() * (isUneven ? 1 << 6 : 1),
                       isUneven ? Deal::AsTheyCome : Deal::Evenly, [&](Range range) { work(range); });
  }

  void push() const {
    PushParts parts;
    const auto pushRange = [&](Range range) {
      PushFrame frame(kernel_, frame_, real_);
      runPieces(range, frame.get());
      parts.add(range.begin, frame.take());
    };
    // what is scattered must come in order, too, to elements that all threads share
    if (has(Role::Scatter)) {
      pushRange({0, pieces_.count()});
    } else {
      inParallel(pushRange);
    }
    parts.store(call_.operands);
  }

  const Kernel& kernel_;
  const native::Call& call_;
  RealType real_;
  const native::Entry& entry_;
  CodeFrame frame_;
  SlotLayout layout_;
  RowPieces pieces_;
};

}  // namespace

void runCode(const Kernel& kernel, const native::Call& call, const CodeChoice& choice) {
  CodeRun(kernel, call, choice).run();
}

}  // namespace sk
