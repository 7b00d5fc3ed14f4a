// SPDX-License-Identifier: MIT
//
// The arrays that object code gets for its slots (sk/native/code.hpp). Elements that lie as the domain does
// are read and written in place. All others, the ends of rows, and what a gather has outside of its stream
// are laid out: they pass through scratch memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

#include "native/call.hpp"
#include "native/components.hpp"
#include "native/entries.hpp"
#include "native/memory.hpp"
#include "native/scalars.hpp"
#include "sk/native/code.hpp"
#include "sk/native/parallel.hpp"
#include "sk/program.hpp"

namespace sk {

/// The most elements that are laid out at a time, so that they stay in the nearest cache.
inline constexpr std::int64_t mostStaged = 512;

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
    bool isDirect;  ///< inputs: elements are contiguous, as in the domain
    bool isInPlace;  ///< elements are read or written in place, except at the ends of rows
    bool isStrided;  ///< outputs: elements of a row are not contiguous
    program::Boundary boundary;
    std::uint8_t rank;
    std::int8_t row[3];
    std::int64_t reach;
    const native::Argument* argument;
    std::int64_t end;  ///< inputs and outputs: x behind the last element that a row's array holds
    std::size_t firstArray, arrayCount;  ///< among all slots' arrays
    /// Gathers: numbers of elements at which a row's x = 0 may be so that the elements of all columns, and as many as
    /// `reach` beyond both ends, are in the stream's array.
    native::Range wholeRows;
    native::Range evenRows;  ///< y whose row begins rowStep elements behind the previous one
    std::int64_t rowStep;
    /// Gathers: the slot of the neighbours one row further down, if it reaches as far along x. In the next
    /// row of the domain, the same elements are the neighbours of this slot.
    std::optional<std::size_t> below;
    std::size_t firstBorder;  ///< gathers with Boundary::Border: index of the first border value
  };
  struct Array {
    std::byte* held;  ///< the stream's array; null if the stream is omitted
    ScalarBytes bytes;
  };

  /// `kernel.code` must have passed entryOf(). Reads the border values. The kernel, the call and the frame
  /// must outlive this.
  SlotLayout(const program::Kernel& kernel, const native::Call& call, const CodeFrame& frame,
             const CodeChoice& choice, std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  std::span<const Slot> slots() const { return slots_; }
  /// The numbers of the slots; Slot::below always precedes the slot itself.
  std::span<const std::size_t> order() const { return order_; }
  std::span<const Array> arrays() const { return arrays_; }
  /// The x of the elements of a row that the call computes.
  native::Range columns() const { return columns_; }
  std::int64_t width() const { return columns_.end - columns_.begin; }
  const void* border(std::size_t value) const { return &borders_[value]; }

  /// True if no stream's layout requires that its elements are laid out.
  bool isDirect() const { return isDirect_; }
  /// True if the elements of some outputs are not contiguous (Slot::isStrided).
  bool hasStridedOutputs() const { return hasStridedOutputs_; }
  /// True if the code uses the index in an input that is correct only in the first lane. Elements are then
  /// computed one by one.
  bool needsElementwiseCalls() const { return needsElementwiseCalls_; }
  bool hasGathers() const { return hasGathers_; }
  bool hasBorders() const { return !borders_.empty(); }
  bool hasOutputs() const { return hasOutputs_; }
  /// The elements of a row for which gathers read only neighbours in bounds along x.
  native::Range inside() const { return inside_; }
  /// The largest reach of a gather.
  std::int64_t reach() const { return reach_; }
  /// True if elements may be computed twice, and together with elements of other rows: the code uses no
  /// indices and ends after the same time for all values, and no output is also an input.
  bool hasIndependentElements() const { return hasIndependentElements_; }

 private:
  struct alignas(mostScalarBytes) Value {
    std::byte bytes[mostScalarBytes];
  };
  void addSlot(const program::Kernel& kernel, const native::Call& call, const CodeFrame& frame,
               const native::Slot& slot, RealType real);
  bool areElementsIndependent(const program::Kernel& kernel) const;
  std::optional<std::size_t> slotBelow(const Slot& slot) const;
  void readBorders(const program::Kernel& kernel, const CodeFrame& frame, const CodeChoice& choice);
  std::size_t firstBorderOf(const program::Kernel& kernel, std::size_t parameter) const;

  std::int64_t domainWidth_;
  native::Range columns_;
  std::pmr::vector<Slot> slots_;
  std::pmr::vector<std::size_t> order_;
  std::pmr::vector<Array> arrays_;
  std::pmr::vector<Value> borders_;
  bool isDirect_ = true;
  bool hasStridedOutputs_ = false;
  bool needsElementwiseCalls_ = false;
  bool hasGathers_ = false;
  bool hasOutputs_ = false;  ///< outputs that are given
  bool hasIndependentElements_ = false;
  std::int64_t reach_ = 0;
  native::Range inside_{0, std::numeric_limits<std::int64_t>::max()};
};

/// The elements at the ends of rows whose neighbours may be out of bounds, laid out one row behind the other.
struct RowEnds {
  std::int64_t left, right;  ///< their numbers in each row
  std::int64_t gap;  ///< elements left free behind each end, because two ends share no neighbours

  std::int64_t ofRow() const { return left + right + 2 * gap; }  ///< elements from one row to the next
  std::int64_t firstRight() const { return left + gap; }
};

/// The arrays of one thread, for one row of the domain or for several rows below each other.
class SlotArrays {
 public:
  /// A number of elements, and the number up to which arrays may be read and written.
  struct Length {
    std::int64_t count, room;
  };

  /// At most `most` elements of a row are laid out at a time; for slots that are in place, at most
  /// `mostAtEnds`, which are at the ends of rows. placeEnds() lays out at most `mostOfBlock`.
  SlotArrays(const SlotLayout& layout, std::int64_t most, std::int64_t mostAtEnds, std::size_t rows = 1,
             std::int64_t mostOfBlock = 0);

  /// Moves to `wanted` rows, of which the first contains this element. Further rows, up to `placed`, repeat
  /// the last one.
  void moveTo(const native::Extents& first, std::size_t wanted = 1, std::size_t placed = 1);

  /// Places `count` elements from `x` on, `step` apart, in each row. The arrays may be read and written up to
  /// `room` elements. Outputs are written in place only if the row is wanted, `room` is `count` and `step` is 1.
  void place(std::int64_t x, std::int64_t count, std::int64_t room, std::int64_t step = 1);
  /// Likewise for whole groups of lanes from `x` on that are in place, with all their neighbours.
  void placeInside(std::int64_t x) {
    void** const to = arrays_.data();
    const ArrayRow* const from = inRow_.data();
    for (std::size_t i = 0, count = placed_ * width_; i < count; ++i)
      to[i] = from[i].first + x * from[i].bytes;
  }
  /// The ends of a row, with neighbours.
  RowEnds ends() const;
  /// Rows below each other that begin at the same distance in each array: the row of moveTo() and those after it.
  struct Block {
    std::size_t rows;
    /// True if what code reads beyond the ends of these rows is in the streams' arrays, though it is not what boundary
    /// modes say.
    bool mayCrossEnds;
  };
  /// The largest block of at most `most` rows. All slots must be in place (SlotLayout::isDirect()), and no row
  /// outside.
  Block blockOf(std::size_t most) const;
  /// Lays out the ends of the block's rows with their neighbours, and returns their arrays: rows * ends.ofRow()
  /// elements, at most `mostOfBlock`.
  void* const* placeEnds(const RowEnds& ends, std::size_t rows);
  /// Copies outputs at the ends of the block's rows to their streams.
  void storeEnds(const RowEnds& ends, std::size_t rows);
  /// For each array, the bytes from a row of a block to the next.
  const std::int64_t* rowSteps() const { return rowSteps_.data(); }
  /// Copies outputs that were not written in place to their streams; arguments as for place().
  void storeOutputs(std::int64_t x, std::int64_t count, std::int64_t room, std::int64_t step = 1);

  void* const* get(std::size_t row = 0) const { return arrays_.data() + row * width_; }
  /// The elements for which gathers need no copies in any of these rows.
  native::Range inside() const { return isAnyOutside_ ? native::Range{0, 0} : layout_.inside(); }

 private:
  using Slot = SlotLayout::Slot;
  struct Row {
    std::int64_t first;  ///< number of the element at x = 0
    bool isOutside;  ///< gathers with Boundary::Border: the row is out of bounds
  };
  /// The address of a row's element at x = 0 in an array. If all elements are laid out, that of scratch
  /// memory, for any x.
  struct ArrayRow {
    std::byte* first;
    std::int64_t bytes;  ///< size of an element; 0 for scratch memory
  };

  void moveToNext();
  static Row rowAt(const Slot& slot, native::Extents first, std::int64_t y);
  void findRows(const Slot& slot, const native::Extents& first, Row* rows) const;
  Row& rowOf(std::size_t row, std::size_t slot) { return rows_[row * slots_ + slot]; }
  std::size_t placeOf(std::size_t row, std::size_t array) const { return row * width_ + array; }

  void storeStrided(std::size_t row, std::size_t slot, std::int64_t x, std::int64_t count, std::int64_t step);
  void stageInput(std::size_t row, std::size_t slot, std::int64_t x, const Length& length, std::int64_t step);
  /// In all rows, or only in those that are out of bounds.
  void stageGather(std::size_t slot, std::int64_t x, const Length& length, bool areOutsideAlone);
  void stageNeighbors(const Slot& slot, std::size_t begin, std::size_t end, std::int64_t x,
                      const Length& length);
  template <class T>
  void stageEnd(const Slot& slot, std::size_t array, std::int64_t x, std::int64_t count, std::int64_t to,
                const RowEnds& ends, std::size_t rows);
  template <class T>
  void storeEnd(std::size_t array, std::int64_t x, std::int64_t count, std::int64_t from, const RowEnds& ends,
                std::size_t rows);
  void stageBorder(std::size_t row, const Slot& slot, std::int64_t room);
  const void* borderOf(const Slot& slot, std::size_t component) const;
  /// Makes the code use the slot's scratch memory.
  void useScratch(std::size_t row, const Slot& slot);

  const SlotLayout& layout_;
  std::size_t slots_, width_;  ///< number of slots, and of arrays of a row
  std::size_t wanted_ = 0, placed_ = 0;  ///< numbers of rows
  native::Extents at_{};  ///< an element of the first row
  CallMemory memory_;
  std::pmr::vector<Row> rows_;
  std::pmr::vector<ArrayRow> inRow_;
  std::pmr::vector<void*> arrays_;  ///< of the rows, then of placeEnds()
  std::pmr::vector<std::int64_t> rowSteps_;
  std::pmr::vector<std::byte*> scratch_;
  bool isAnyOutside_ = false;
};

}  // namespace sk
