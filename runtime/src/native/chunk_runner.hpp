// SPDX-License-Identifier: MIT
//
// Runs a kernel's object code on neighbours in a row, or in several rows at once: divides them into chunks that the code can
// take, whole groups of its lanes wherever possible.
#pragma once

#include <array>
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
  /// `run` is an entry of kind Run or RunRows. At most so many rows are run at once, or as many as the entry computes together.
  ChunkRunner(const SlotLayout& layout, const native::Entry& run, const native::Frame* frame,
              ChunkHook hook = {}, std::size_t rows = 1);

  /// Rows that should be run at once, at most native::mostRows: their ends are laid out one after the other, which costs less than a
  /// row at a time.
  static std::size_t rowsAtOnce(const SlotLayout& layout);

  /// `count` elements from `first` on.
  void run(const native::Extents& first, std::int64_t count) { run(first, count, 1); }
  /// `count` elements in each of `rows` rows. Where the entry computes more rows together, no more than native::mostLanes elements.
  void run(const native::Extents& first, std::int64_t count, std::size_t rows);

  /// Likewise at most mostLaidOut of them, as one chunk whose arrays after(arrays) can look at.
  template <class After>
  void runChunk(const native::Extents& first, std::int64_t count, After&& after) {
    moveTo(first, 1);
    call(first[0], count, roundUp(count, lanes_));
    after(arrays_.get());
  }

 private:
  void moveTo(const native::Extents& first, std::size_t rows);
  void runPart(std::int64_t begin, std::int64_t end, std::int64_t longest);
  /// Whole groups of lanes that lie as the domain does, with the neighbours that gathers read.
  void runInside(std::int64_t begin, std::int64_t end, std::int64_t longest);
  void call(std::int64_t x, std::int64_t count, std::int64_t room);
  void compute(std::int64_t x, std::int64_t count);

  const SlotLayout& layout_;
  native::RunFunction* function_;
  std::int64_t lanes_;
  const native::Frame* frame_;
  std::size_t together_;  ///< rows that the entry computes
  std::size_t wanted_ = 1;  ///< rows
  std::size_t placed_ = 1;  ///< these, and others that are computed together with them
  std::int64_t laidOut_;  ///< elements of a row at a time, at most
  SlotArrays arrays_;
  std::array<native::Chunk, native::mostRows> chunks_;
  ChunkHook hook_;
};

}  // namespace sk
