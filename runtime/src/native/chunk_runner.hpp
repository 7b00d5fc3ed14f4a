// SPDX-License-Identifier: MIT
//
// Runs a kernel's object code on neighbours in one row, or in several rows at once: divides them into chunks
// for the code, in whole groups of lanes where possible.
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

/// What happens between chunks.
struct ChunkHook {
  /// The most elements of a chunk, a multiple of mostLanes.
  std::int64_t longest = std::numeric_limits<std::int64_t>::max();
  std::function<void()> after = {};  ///< called after each chunk
};

/// Each thread has its own.
class ChunkRunner {
 public:
  /// `run` is an entry of kind Run or RunRows. `rows` is the most rows that run() gets in one call; fewer
  /// than the entry computes together count as that many.
  ChunkRunner(const SlotLayout& layout, const native::Entry& run, const native::Frame* frame,
              ChunkHook hook = {}, std::size_t rows = 1);

  /// Computes rows in blocks of columns that fit the first-level cache. This pays only if the elements are in the second-level
  /// cache already: memory is faster if it is read in order.
  void stayNear();

  /// The number of rows that run() should get in one call. Several rows together cost less than one at a time.
  static std::size_t rowsAtOnce(const SlotLayout& layout);

  /// Computes `count` elements from `first` on.
  void run(const native::Extents& first, std::int64_t count) { run(first, count, 1); }
  /// Computes `count` elements in each of `rows` rows. If the entry computes several rows together, `count`
  /// is at most native::mostLanes.
  void run(const native::Extents& first, std::int64_t count, std::size_t rows);

  /// Computes at most mostStaged elements as one chunk, then calls after(arrays) with the arrays of the
  /// chunk.
  template <class After>
  void runChunk(const native::Extents& first, std::int64_t count, After&& after) {
    moveTo(first, 1);
    call(first[0], count, roundUp(count, lanes_));
    after(arrays_.get());
  }

 private:
  void runRow(const native::Extents& first, std::int64_t count, std::size_t rows);
  /// Computes whole rows from `first` on, at most `most`: first their ends together, then the elements between them, some
  /// of which may be computed twice. Returns the number of rows; 0 if that is not possible.
  std::size_t runBlock(const native::Extents& first, std::size_t most);
  /// Likewise for a part of each row, none of which needs neighbours beyond its ends.
  std::size_t runInnerBlock(const native::Extents& first, std::int64_t count, std::size_t most);
  void runPartOfRows(const native::Extents& first, std::int64_t count, std::size_t rows);
  void moveTo(const native::Extents& first, std::size_t rows);
  void runPart(std::int64_t begin, std::int64_t end, std::int64_t longest);
  /// For whole groups of lanes whose elements and neighbours are read in place.
  void runInside(std::int64_t begin, std::int64_t end, std::int64_t longest);
  void call(std::int64_t x, std::int64_t count, std::int64_t room);
  void compute(std::int64_t x, std::int64_t count);
  void computeBlock(std::int64_t x, std::int64_t count, std::size_t rows);
  /// At least a group of lanes; the last group may be computed twice.
  void computeColumns(std::int64_t begin, std::int64_t end, std::size_t rows);

  const SlotLayout& layout_;
  native::RunFunction* function_;
  std::int64_t lanes_;
  const native::Frame* frame_;
  std::size_t together_;  ///< rows that the entry computes together
  bool runsBlocks_;  ///< several rows in one call of the code
  std::size_t wanted_ = 1;  ///< rows to compute
  std::size_t placed_ = 1;  ///< wanted_, rounded up to a multiple of together_
  std::int64_t mostColumns_ =
      std::numeric_limits<std::int64_t>::max();  ///< that several rows compute at a time
  std::int64_t staged_;  ///< most elements of a row that are laid out at a time
  SlotArrays arrays_;
  std::array<native::Chunk, native::mostRows> chunks_;
  ChunkHook hook_;
};

}  // namespace sk
