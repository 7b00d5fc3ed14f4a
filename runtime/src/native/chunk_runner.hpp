// SPDX-License-Identifier: MIT
//
// Runs a kernel's object code on neighbours in a row: divides them into chunks that the code can take, whole groups of its lanes
// wherever possible.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>

#include "native/call.hpp"
#include "native/entries.hpp"
#include "native/slot_arrays.hpp"
#include "sk/native/code.hpp"

namespace sk {

/// What is to happen between chunks.
struct ChunkHook {
  std::int64_t longest =
      std::numeric_limits<std::int64_t>::max();  ///< elements of a chunk; a multiple of mostLanes
  std::function<void()> after = {};  ///< called after each chunk
};

/// For one thread.
class ChunkRunner {
 public:
  ChunkRunner(const SlotLayout& layout, const native::Entry& run, const native::Frame* frame,
              ChunkHook hook = {});

  /// `count` elements from `first` on.
  void run(const native::Extents& first, std::int64_t count);

  /// Likewise at most mostLaidOut of them, as one chunk whose arrays after(arrays) can look at.
  template <class After>
  void runChunk(const native::Extents& first, std::int64_t count, After&& after) {
    arrays_.moveToRow(first);
    moveTo(first);
    call(first[0], count, roundUp(count, lanes_));
    after(arrays_.get());
  }

 private:
  void moveTo(const native::Extents& first);
  void runPart(std::int64_t begin, std::int64_t end, std::int64_t longest);
  void call(std::int64_t x, std::int64_t count, std::int64_t room);

  const SlotLayout& layout_;
  native::RunFunction* function_;
  std::int64_t lanes_;
  const native::Frame* frame_;
  SlotArrays arrays_;
  native::Chunk chunk_{};
  ChunkHook hook_;
};

}  // namespace sk
