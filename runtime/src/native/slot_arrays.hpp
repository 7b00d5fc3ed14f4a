// SPDX-License-Identifier: MIT
//
// The arrays that object code gets for its slots (sk/native/code.hpp). Elements that lie as the domain does are read and written where
// they are; all others, the ends of rows and what a gather has outside of its stream pass through scratch memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "native/call.hpp"
#include "native/call_memory.hpp"
#include "native/code_frame.hpp"
#include "native/entries.hpp"
#include "native/scalars.hpp"
#include "sk/native/code.hpp"
#include "sk/native/parallel.hpp"
#include "sk/program.hpp"

namespace sk {

/// Elements that are laid out in scratch memory at a time: they stay in the nearest cache.
inline constexpr std::int64_t mostLaidOut = 512;

constexpr std::int64_t roundUp(std::int64_t count, std::int64_t lanes) {
  return (count + lanes - 1) & -lanes;
}

/// The slots of one call, which all threads share.
class SlotLayout {
 public:
  enum class Kind : std::uint8_t { Input, Output, Gather };
  struct Slot {
    Kind kind;
    bool isGiven;
    bool isDirect;  ///< inputs: the elements lie one behind the other as the domain's do
    program::Boundary boundary;
    std::uint8_t rank;
    std::int8_t row[3];
    std::int64_t reach;
    const native::Argument* argument;
    std::size_t firstArray, arrayCount;  ///< among all slots' arrays
    std::size_t firstBorder;  ///< gathers with Boundary::Border: the first of their border's values
  };
  struct Array {
    std::byte* held;  ///< by the stream; null where it is left out
    ScalarBytes bytes;
  };

  /// `kernel.code` has been checked (entryOf()). Reads the values of borders. The kernel, the call and the frame must outlive this.
  SlotLayout(const program::Kernel& kernel, const native::Call& call, const CodeFrame& frame,
             const CodeChoice& choice, std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  std::span<const Slot> slots() const { return slots_; }
  std::span<const Array> arrays() const { return arrays_; }
  std::int64_t width() const { return width_; }
  const void* border(std::size_t value) const { return &borders_[value]; }

  /// Whether no element needs to be laid out because of how its stream lies.
  bool isDirect() const { return isDirect_; }
  /// Whether the code computes an input's own index, and only that of the first lane is right.
  bool goesByElement() const { return goesByElement_; }
  bool hasGathers() const { return hasGathers_; }

 private:
  struct alignas(mostScalarBytes) Value {
    std::byte bytes[mostScalarBytes];
  };
  void addSlot(const program::Kernel& kernel, const native::Call& call, const CodeFrame& frame,
               const native::Slot& slot, RealType real);
  void readBorders(const program::Kernel& kernel, const CodeFrame& frame, const CodeChoice& choice);
  std::size_t firstBorderOf(const program::Kernel& kernel, std::size_t parameter) const;

  std::int64_t width_;
  std::pmr::vector<Slot> slots_;
  std::pmr::vector<Array> arrays_;
  std::pmr::vector<Value> borders_;
  bool isDirect_ = true;
  bool goesByElement_ = false;
  bool hasGathers_ = false;
};

/// The arrays of one thread.
class SlotArrays {
 public:
  /// At most so many elements are placed at once where they are laid out; and of slots that lie as the domain does, so many that
  /// may be laid out because they are at the end of a row.
  SlotArrays(const SlotLayout& layout, std::int64_t most, std::int64_t mostAtEnds);

  /// From here on, chunks are in the row of this element.
  void moveToRow(const native::Extents& first);

  /// `count` elements from `x` on, `step` apart. The arrays may be read and written up to `room` elements. Outputs are written where
  /// they are only if `keeps` is true and there is no need for room.
  void place(std::int64_t x, std::int64_t count, std::int64_t room, std::int64_t step = 1, bool keeps = true);
  /// The same for elements from `x` on that lie as the domain does, all with their neighbours and whole groups of lanes.
  void placeInside(std::int64_t x) {
    for (std::size_t a = 0; a < inRow_.size(); ++a) arrays_[a] = inRow_[a].first + x * inRow_[a].bytes;
  }
  /// Outputs that were not written where they are go there.
  void storeOutputs(std::int64_t x, std::int64_t count);

  void* const* get() const { return arrays_.data(); }
  /// Where in a row gathers need no copies: elements from `begin` to `end` and their neighbours are inside.
  native::Range inside() const;

 private:
  using Slot = SlotLayout::Slot;

  void placeInput(std::size_t slot, std::int64_t x, std::int64_t count, std::int64_t room, std::int64_t step);
  void placeOutput(std::size_t slot, std::int64_t x, bool isDirect);
  void placeGather(std::size_t slot, std::int64_t x, std::int64_t count, std::int64_t room);
  void layOutInput(std::size_t slot, std::size_t array, std::int64_t x, std::int64_t count,
                   std::int64_t step);
  void layOutGather(const Slot& slot, std::size_t row, std::size_t array, std::int64_t x, std::int64_t count);
  std::byte* scratchOf(std::size_t array) { return scratch_[array]; }

  struct Row {
    std::int64_t first;  ///< number of the element at x = 0
    bool isOutside;  ///< of a gather with Boundary::Border
  };
  /// Where the row's element at x = 0 is in an array, if the stream is given.
  struct ArrayRow {
    std::byte* first;
    std::int64_t bytes;  ///< of an element
  };
  const SlotLayout& layout_;
  CallMemory memory_;
  std::pmr::vector<Row> rows_;
  std::pmr::vector<ArrayRow> inRow_;
  std::pmr::vector<void*> arrays_;
  std::pmr::vector<std::byte*> scratch_;
};

}  // namespace sk
