// SPDX-License-Identifier: MIT
//
// Runs a kernel's object code on neighbours in a row, or in several rows at once: divides them into chunks that the code can
// take, whole groups of its lanes wherever possible.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

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
  /// `run` is an entry of kind Run or RunRows.
  ChunkRunner(const SlotLayout& layout, const native::Entry& run, const native::Frame* frame,
              ChunkHook hook = {});

  /// `count` elements from `first` on.
  void run(const native::Extents& first, std::int64_t count) { run(first, count, 1); }
  /// `count` elements in each of `rows` rows, at most as many as the entry computes together and, where they are fewer, no more than
  /// native::mostLanes elements.
  void run(const native::Extents& first, std::int64_t count, std::size_t rows);

  /// Likewise at most mostLaidOut of them, as one chunk whose arrays after(arrays) can look at.
  template <class After>
  void runChunk(const native::Extents& first, std::int64_t count, After&& after) {
    moveTo(first, 1);
    call(first[0], count, roundUp(count, lanes_));
    after(arrays_.front()->get());
  }

 private:
  void moveTo(const native::Extents& first, std::size_t rows);
  void runPart(std::int64_t begin, std::int64_t end, std::int64_t longest);
  native::Range inside() const;
  /// Whole groups of lanes that lie as the domain does, with the neighbours that gathers read.
  void runInside(std::int64_t begin, std::int64_t end, std::int64_t longest);
  void call(std::int64_t x, std::int64_t count, std::int64_t room);

  const SlotLayout& layout_;
  native::RunFunction* function_;
  std::int64_t lanes_;
  const native::Frame* frame_;
  std::size_t rows_;  ///< that the entry computes together
  std::size_t wanted_ = 1;  ///< of these
  std::array<std::optional<SlotArrays>, native::mostRows> arrays_;  ///< of each row
  std::array<native::Chunk, native::mostRows> chunks_;
  ChunkHook hook_;
};

}  // namespace sk
