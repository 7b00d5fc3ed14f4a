// SPDX-License-Identifier: MIT
//
// The arrays that object code gets for its slots (sk/native/code.hpp). Elements that lie as the domain does are read and written where
// they are; all others, the ends of rows and what a gather has outside of its stream pass through scratch memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <optional>
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
    bool isInPlace;  ///< elements are read or written where they are, but at the ends of rows
    program::Boundary boundary;
    std::uint8_t rank;
    std::int8_t row[3];
    std::int64_t reach;
    const native::Argument* argument;
    std::size_t firstArray, arrayCount;  ///< among all slots' arrays
    native::Range evenRows;  ///< y whose row lies rowStep elements behind the one before it
    std::int64_t rowStep;
    /// Gathers: the slot of the neighbours one row further down, if they reach as far along x. The next row's neighbours here are the
    /// same elements.
    std::optional<std::size_t> below;
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
  /// Numbers of the slots, where Slot::below comes before a slot.
  std::span<const std::size_t> order() const { return order_; }
  std::span<const Array> arrays() const { return arrays_; }
  std::int64_t width() const { return width_; }
  const void* border(std::size_t value) const { return &borders_[value]; }

  /// Whether no element needs to be laid out because of how its stream lies.
  bool isDirect() const { return isDirect_; }
  /// Whether the code computes an input's own index, and only that of the first lane is right.
  bool goesByElement() const { return goesByElement_; }
  bool hasGathers() const { return hasGathers_; }
  /// Elements of a row whose neighbours that gathers read are inside along x.
  native::Range inside() const { return inside_; }

 private:
  struct alignas(mostScalarBytes) Value {
    std::byte bytes[mostScalarBytes];
  };
  void addSlot(const program::Kernel& kernel, const native::Call& call, const CodeFrame& frame,
               const native::Slot& slot, RealType real);
  std::optional<std::size_t> slotBelow(const Slot& slot) const;
  void readBorders(const program::Kernel& kernel, const CodeFrame& frame, const CodeChoice& choice);
  std::size_t firstBorderOf(const program::Kernel& kernel, std::size_t parameter) const;

  std::int64_t width_;
  std::pmr::vector<Slot> slots_;
  std::pmr::vector<std::size_t> order_;
  std::pmr::vector<Array> arrays_;
  std::pmr::vector<Value> borders_;
  bool isDirect_ = true;
  bool goesByElement_ = false;
  bool hasGathers_ = false;
  native::Range inside_{0, std::numeric_limits<std::int64_t>::max()};
};

/// The arrays of one thread, for one row of the domain or for several below each other.
class SlotArrays {
 public:
  /// Elements, and how many the arrays may be read and written up to.
  struct Length {
    std::int64_t count, room;
  };

  /// At most `most` elements of a row are placed at once where they are laid out; and of slots that lie as the domain does,
  /// `mostAtEnds` that may be laid out because they are at the end of a row.
  SlotArrays(const SlotLayout& layout, std::int64_t most, std::int64_t mostAtEnds, std::size_t rows = 1);

  /// From here on, chunks are in `wanted` rows, of which this element is in the first. Further rows, up to `placed`, are the
  /// last once more.
  void moveTo(const native::Extents& first, std::size_t wanted = 1, std::size_t placed = 1);

  /// In each row `count` elements from `x` on, `step` apart. The arrays may be read and written up to `room` elements. Outputs are
  /// written where they are only if the row is wanted and there is no need for room.
  void place(std::int64_t x, std::int64_t count, std::int64_t room, std::int64_t step = 1);
  /// The same for elements from `x` on that lie as the domain does, all with their neighbours and whole groups of lanes.
  void placeInside(std::int64_t x) {
    void** const to = arrays_.data();
    const ArrayRow* const from = inRow_.data();
    for (std::size_t i = 0, count = placed_ * width_; i < count; ++i)
      to[i] = from[i].first + x * from[i].bytes;
  }
  /// Outputs that were not written where they are go there.
  void storeOutputs(std::int64_t x, std::int64_t count);

  void* const* get(std::size_t row = 0) const { return &arrays_[row * width_]; }
  /// Where in all these rows gathers need no copies: elements from `begin` to `end` and their neighbours are inside.
  native::Range inside() const { return isAnyOutside_ ? native::Range{0, 0} : layout_.inside(); }

 private:
  using Slot = SlotLayout::Slot;
  struct Row {
    std::int64_t first;  ///< number of the element at x = 0
    bool isOutside;  ///< of a gather with Boundary::Border
  };
  /// Where the row's element at x = 0 is in an array; scratch memory, for any x, where all elements are laid out.
  struct ArrayRow {
    std::byte* first;
    std::int64_t bytes;  ///< of an element
  };

  static Row rowAt(const Slot& slot, native::Extents first, std::int64_t y);
  void findRows(const Slot& slot, const native::Extents& first, Row* rows) const;
  Row& rowOf(std::size_t row, std::size_t slot) { return rows_[row * slots_ + slot]; }
  std::size_t placeOf(std::size_t row, std::size_t array) const { return row * width_ + array; }

  void layOutInput(std::size_t row, std::size_t slot, std::int64_t x, const Length& length,
                   std::int64_t step);
  /// In all rows, or in those that are outside.
  void layOutGather(std::size_t slot, std::int64_t x, const Length& length, bool areOutsideAlone);
  void layOutNeighbors(const Slot& slot, std::size_t begin, std::size_t end, std::int64_t x,
                       const Length& length);
  void layOutBorder(std::size_t row, const Slot& slot, std::int64_t room);
  const void* borderOf(const Slot& slot, std::size_t component) const;
  /// The code is to take the slot's scratch memory.
  void useScratch(std::size_t row, const Slot& slot);

  const SlotLayout& layout_;
  std::size_t slots_, width_;  ///< slots and arrays of a row
  std::size_t wanted_ = 0, placed_ = 0;  ///< rows
  CallMemory memory_;
  std::pmr::vector<Row> rows_;
  std::pmr::vector<ArrayRow> inRow_;
  std::pmr::vector<void*> arrays_;
  std::pmr::vector<std::byte*> scratch_;
  bool isAnyOutside_ = false;
};

}  // namespace sk
