// SPDX-License-Identifier: MIT
#include "native/slot_arrays.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>

#include "native/held_index.hpp"
#include "native/memory.hpp"

namespace sk {

namespace {

using native::Extents;
using native::Range;
using program::Boundary;
using program::Parameter;
using program::Role;

/// The index in an input for an index in the domain.
std::int64_t ownIndex(const native::Argument& input, std::size_t d, std::int64_t index) {
  const std::int64_t multiplied = index * input.multiply[d];
  return input.divide[d] == 1 ? multiplied : multiplied / input.divide[d];
}

/// A range of a gather's elements along x, the same in several rows.
struct Neighbors {
  Boundary boundary;
  const void* border;
  const native::Argument* gather;
  std::int64_t first, count;
};

/// Copies the range in each row. rows(r) is the address of the element at x = 0 in row r, to(r) its
/// destination.
template <class T, class Rows, class To>
void copyNeighbors(const Neighbors what, std::size_t rowCount, const Rows rows, const To to) {
  constexpr std::int64_t size = sizeof(T);
  const std::int64_t begin = std::clamp<std::int64_t>(what.gather->low[0] - what.first, 0, what.count);
  const std::int64_t end = std::clamp<std::int64_t>(what.gather->high[0] - what.first, begin, what.count);
  const auto bytes = static_cast<std::size_t>((end - begin) * size);
  for (std::size_t r = 0; r < rowCount; ++r)
    std::memcpy(to(r) + begin * size, rows(r) + (what.first + begin) * size, bytes);
  for (std::int64_t i = begin > 0 ? 0 : end; i < what.count; i = i + 1 == begin ? end : i + 1) {
    const std::int64_t index = heldIndex(what.boundary, *what.gather, 0, what.first + i);
    for (std::size_t r = 0; r < rowCount; ++r)
      std::memcpy(to(r) + i * size, index == borderIndex ? what.border : rows(r) + index * size, sizeof(T));
  }
}

/// SlotLayout::Slot::wholeRows
Range wholeRowsOf(const native::Argument& argument, const Range& columns, std::int64_t reach) {
  std::int64_t first = argument.first, last = argument.first;
  for (std::size_t d = 0; d < 4; ++d) {
    first += argument.low[d] * argument.stride[d];
    last += (argument.high[d] - 1) * argument.stride[d];
  }
  return {first + reach - columns.begin, last - reach - columns.end + 2};
}

/// The x of the elements of a row that a call computes.
Range columnsOf(const native::Call& call) {
  if (!call.part) return {0, call.domain[0]};
  return {call.part->first[0], call.part->first[0] + call.part->extent[0]};
}

}  // namespace

// ---- the layout of a call --------------------------------------------------------------------------

SlotLayout::SlotLayout(const program::Kernel& kernel, const native::Call& call, const CodeFrame& frame,
                       const CodeChoice& choice, std::pmr::memory_resource* memory)
    : domainWidth_(call.domain[0]),
      columns_(columnsOf(call)),
      slots_(memory),
      order_(memory),
      arrays_(memory),
      borders_(memory) {
  const std::span<const native::Slot> slots(kernel.code->slots, kernel.code->slotCount);
  slots_.reserve(slots.size());
  order_.reserve(slots.size());
  arrays_.reserve(slots.size());
  for (const native::Slot& slot : slots) addSlot(kernel, call, frame, slot, choice.real);
  if (!hasGathers_) return;
  hasIndependentElements_ = areElementsIndependent(kernel);
  for (Slot& slot : slots_) slot.below = slotBelow(slot);
  std::ranges::stable_sort(order_, std::ranges::greater(), [&](std::size_t s) { return slots_[s].row[0]; });
  readBorders(kernel, frame, choice);
}

void SlotLayout::addSlot(const program::Kernel& kernel, const native::Call& call, const CodeFrame& frame,
                         const native::Slot& slot, RealType real) {
  const Parameter& parameter = kernel.parameters[slot.parameter];
  const native::Operand& operand = call.operands[slot.parameter];
  const native::Argument& argument = frame.arguments()[slot.parameter];
  Slot& added = slots_.emplace_back();
  added.kind = slot.isOutput != 0               ? Kind::Output
               : parameter.role == Role::Gather ? Kind::Gather
                                                : Kind::Input;
  added.isGiven = argument.components != nullptr;
  added.boundary = parameter.boundary;
  added.rank = parameter.rank;
  std::ranges::copy(slot.row, added.row);
  added.reach = slot.reach;
  added.argument = &argument;
  added.firstArray = arrays_.size();
  // if a row has one element, it does not matter how an input repeats or skips along x
  const bool isLine = domainWidth_ == 1;
  const bool isFitted = !isLine && (argument.multiply[0] != 1 || argument.divide[0] != 1);
  added.isDirect = added.isGiven && !operand.holdsFloats && !isFitted && (isLine || argument.stride[0] == 1);
  added.isStrided = added.kind == Kind::Output && added.isGiven && !isLine && argument.stride[0] != 1;
  added.isInPlace = added.kind == Kind::Input ? added.isDirect : added.isGiven && !added.isStrided;
  hasStridedOutputs_ = hasStridedOutputs_ || added.isStrided;
  hasOutputs_ = hasOutputs_ || (added.kind == Kind::Output && added.isGiven);
  if (added.kind == Kind::Gather) {
    hasGathers_ = true;
    reach_ = std::max(reach_, added.reach);
    inside_ = {std::max(inside_.begin, argument.low[0] + added.reach),
               std::min(inside_.end, argument.high[0] - added.reach)};
    added.firstBorder = firstBorderOf(kernel, slot.parameter);
    added.wholeRows = wholeRowsOf(argument, columns_, added.reach);
  } else {
    added.end = operand.held ? argument.high[0] : domainWidth_;
    isDirect_ = isDirect_ && added.isInPlace;
    needsElementwiseCalls_ =
        needsElementwiseCalls_ || (added.kind == Kind::Input && parameter.usesIndex && isFitted);
  }
  constexpr std::int64_t least = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  if (added.kind == Kind::Gather) {
    const bool isRow = added.rank == 1;
    added.rowStep = isRow ? 0 : argument.stride[1];
    added.evenRows = isRow ? Range{least, most}
                           : Range{argument.low[1] + 1 - added.row[0], argument.high[1] - added.row[0]};
  } else {
    added.rowStep = argument.multiply[1] * argument.stride[1];
    added.evenRows = argument.divide[1] == 1 ? Range{least, most} : Range{0, 0};
  }
  order_.push_back(slots_.size() - 1);
  forEachScalar(*parameter.element, real, [&](std::size_t number, std::size_t bytes, program::Scalar scalar) {
    const auto read = static_cast<std::uint8_t>(bytes);
    const bool isWidened = operand.holdsFloats && scalar == program::Scalar::Float;
    arrays_.push_back({added.isGiven ? static_cast<std::byte*>(argument.components[number]) : nullptr,
                       {isWidened ? static_cast<std::uint8_t>(sizeof(float)) : read, read}});
  });
  added.arrayCount = arrays_.size() - added.firstArray;
}

bool SlotLayout::areElementsIndependent(const program::Kernel& kernel) const {
  if (kernel.usesIndex || kernel.code->isUneven != 0) return false;
  for (const Parameter& parameter : kernel.parameters) {
    const bool hasSlots = parameter.reach >= 0 && parameter.reach <= native::farthestSlot;
    if (parameter.role == Role::Iterator || parameter.usesIndex || (parameter.usesNear && !hasSlots))
      return false;
  }
  const auto arraysOf = [&](const Slot& slot) {
    return std::span(arrays_).subspan(slot.firstArray, slot.arrayCount);
  };
  for (const Slot& output : slots_) {
    if (output.kind != Kind::Output) continue;
    for (const Slot& input : slots_) {
      if (input.kind != Kind::Output &&
          std::ranges::find_first_of(arraysOf(output), arraysOf(input), {}, &Array::held, &Array::held) !=
              arraysOf(output).end())
        return false;
    }
  }
  return true;
}

std::optional<std::size_t> SlotLayout::slotBelow(const Slot& slot) const {
  for (std::size_t s = 0; s < slots_.size(); ++s) {
    const Slot& other = slots_[s];
    if (slot.kind == Kind::Gather && other.argument == slot.argument && other.row[0] == slot.row[0] + 1 &&
        other.row[1] == slot.row[1] && other.row[2] == slot.row[2] && other.reach >= slot.reach) {
      return s;
    }
  }
  return std::nullopt;
}

/// The index of a gather's first border value. The code writes all components of one gather, then the next.
std::size_t SlotLayout::firstBorderOf(const program::Kernel& kernel, std::size_t parameter) const {
  std::size_t values = 0;
  for (std::size_t i = 0; i < parameter; ++i) {
    const Parameter& other = kernel.parameters[i];
    if (other.role == Role::Gather && other.boundary == Boundary::Border) values += scalarsOf(*other.element);
  }
  return values;
}

void SlotLayout::readBorders(const program::Kernel& kernel, const CodeFrame& frame,
                             const CodeChoice& choice) {
  const std::size_t count = firstBorderOf(kernel, kernel.parameters.size());
  if (count == 0) return;
  borders_.resize(count);
  std::vector<void*> values;
  values.reserve(count);
  for (Value& value : borders_) values.push_back(&value);
  const native::Entry& entry = entryOf(kernel, native::EntryKind::Borders, choice);
  functionOf<native::ValuesFunction>(entry)(frame.get(), values.data());
}

// ---- the arrays of a thread ------------------------------------------------------------------------

SlotArrays::SlotArrays(const SlotLayout& layout, std::int64_t most, std::int64_t mostAtEnds, std::size_t rows,
                       std::int64_t mostOfBlock)
    : layout_(layout),
      slots_(layout.slots().size()),
      width_(layout.arrays().size()),
      rows_(rows * layout.slots().size(), memory_.get()),
      inRow_(rows * width_, memory_.get()),
      arrays_((rows + 1) * width_, memory_.get()),
      rowSteps_(width_, memory_.get()),
      scratch_(rows * width_, memory_.get()) {
  for (const Slot& slot : layout.slots()) {
    const bool isStagedOnlyAtEnds = slot.isInPlace && slot.kind != SlotLayout::Kind::Gather;
    const std::int64_t ofRow = std::min(layout.width(), isStagedOnlyAtEnds ? mostAtEnds : most);
    const std::int64_t staged = std::max(ofRow, mostOfBlock);
    const std::int64_t elements = staged + native::mostLanes + 2 * slot.reach;
    for (std::size_t a = slot.firstArray; a < slot.firstArray + slot.arrayCount; ++a) {
      const ScalarBytes bytes = layout.arrays()[a].bytes;
      rowSteps_[a] = slot.rowStep * bytes.held;
      const std::size_t size =
          (static_cast<std::size_t>(elements) * bytes.read + cacheLine - 1) / cacheLine * cacheLine;
      auto* next = static_cast<std::byte*>(memory_.get()->allocate(rows * size, cacheLine));
      for (std::size_t row = 0; row < rows; ++row, next += size) {
        scratch_[placeOf(row, a)] = next;
        inRow_[placeOf(row, a)] = {next, slot.isInPlace ? bytes.held : 0};
      }
    }
  }
}

void SlotArrays::moveTo(const Extents& first, std::size_t wanted, std::size_t placed) {
  if (wanted == wanted_ && placed == placed_ && std::equal(first.begin() + 1, first.end(), at_.begin() + 1))
    return;  // another element of the same rows
  const bool isNext = wanted_ == 1 && wanted == 1 && placed_ == 1 && placed == 1 && first[1] == at_[1] + 1 &&
                      first[2] == at_[2] && first[3] == at_[3];
  at_ = first;
  if (isNext) return moveToNext();
  wanted_ = wanted;
  placed_ = placed;
  isAnyOutside_ = false;
  const std::size_t slots = slots_, width = width_;
  for (std::size_t s = 0; s < slots; ++s) {
    const Slot& slot = layout_.slots()[s];
    Row* const rows = &rows_[s];
    findRows(slot, first, rows);
    if (slot.boundary == Boundary::Border) {
      for (std::size_t k = 0; k < wanted; ++k) isAnyOutside_ = isAnyOutside_ || rows[k * slots].isOutside;
    }
    if (!slot.isInPlace) continue;
    for (std::size_t a = slot.firstArray; a < slot.firstArray + slot.arrayCount; ++a) {
      const SlotLayout::Array array = layout_.arrays()[a];
      ArrayRow* const to = &inRow_[a];
      for (std::size_t k = 0; k < placed; ++k)
        to[k * width].first = array.held + rows[k * slots].first * array.bytes.held;
    }
  }
}

/// Moves one row down to `at_`: finds out only where an index leaves the stream, or repeats.
void SlotArrays::moveToNext() {
  isAnyOutside_ = false;
  for (std::size_t s = 0; s < slots_; ++s) {
    const Slot& slot = layout_.slots()[s];
    Row& row = rows_[s];
    const std::int64_t before = row.first;
    if (slot.evenRows.begin <= at_[1] && at_[1] < slot.evenRows.end) {
      row.first += slot.rowStep;
    } else {
      row = rowAt(slot, at_, at_[1]);
    }
    isAnyOutside_ = isAnyOutside_ || row.isOutside;
    if (!slot.isInPlace) continue;
    for (std::size_t a = slot.firstArray; a < slot.firstArray + slot.arrayCount; ++a)
      inRow_[a].first += (row.first - before) * layout_.arrays()[a].bytes.held;
  }
}

/// Finds the rows of one slot, the first of which is *rows; `rows` has slots_ entries per row.
void SlotArrays::findRows(const Slot& slot, const Extents& first, Row* rows) const {
  const std::size_t slots = slots_, wanted = wanted_, placed = placed_;
  const std::int64_t y = first[1], last = y + static_cast<std::int64_t>(wanted) - 1;
  Row row = rowAt(slot, first, y);
  if (slot.evenRows.begin <= y + 1 && last < slot.evenRows.end) {
    const std::int64_t step = slot.rowStep;
    for (std::size_t k = 0; k < wanted; ++k, row.first += step) rows[k * slots] = row;
  } else {
    for (std::size_t k = 0; k < wanted; ++k)
      rows[k * slots] = rowAt(slot, first, y + static_cast<std::int64_t>(k));
  }
  for (std::size_t k = wanted; k < placed; ++k) rows[k * slots] = rows[(wanted - 1) * slots];
}

/// The slot's row for the domain's row at `y` in the plane of `first`.
SlotArrays::Row SlotArrays::rowAt(const Slot& slot, Extents first, std::int64_t y) {
  const native::Argument& argument = *slot.argument;
  first[1] = y;
  Row row{argument.first, false};
  if (slot.kind == SlotLayout::Kind::Gather) {
    for (std::size_t d = 1; d < slot.rank; ++d) {
      const std::int64_t index = heldIndex(slot.boundary, argument, d, first[d] + slot.row[d - 1]);
      row.isOutside = row.isOutside || index == borderIndex;
      row.first += (index == borderIndex ? argument.low[d] : index) * argument.stride[d];
    }
  } else {
    for (std::size_t d = 1; d < 4; ++d) row.first += ownIndex(argument, d, first[d]) * argument.stride[d];
  }
  return row;
}

void SlotArrays::place(std::int64_t x, std::int64_t count, std::int64_t room, std::int64_t step) {
  placeInside(x);
  for (const std::size_t s : layout_.order()) {
    const Slot& slot = layout_.slots()[s];
    switch (slot.kind) {
      case SlotLayout::Kind::Input:
        if (slot.isInPlace && step == 1 && x + room <= slot.end) break;
        for (std::size_t row = 0; row < placed_; ++row) stageInput(row, s, x, {count, room}, step);
        break;
      case SlotLayout::Kind::Output:
        for (std::size_t row = slot.isInPlace && count == room && step == 1 ? wanted_ : 0; row < placed_;
             ++row)
          useScratch(row, slot);
        break;
      case SlotLayout::Kind::Gather:
        if (x - slot.reach < slot.argument->low[0] || x + room + slot.reach > slot.argument->high[0]) {
          stageGather(s, x, {count, room}, /*areOutsideAlone=*/false);
        } else if (isAnyOutside_) {
          stageGather(s, x, {count, room}, /*areOutsideAlone=*/true);
        }
        break;
    }
  }
}

void SlotArrays::useScratch(std::size_t row, const Slot& slot) {
  for (std::size_t a = slot.firstArray; a < slot.firstArray + slot.arrayCount; ++a)
    arrays_[placeOf(row, a)] = scratch_[placeOf(row, a)];
}

void SlotArrays::storeOutputs(std::int64_t x, std::int64_t count, std::int64_t room, std::int64_t step) {
  for (std::size_t row = 0; row < wanted_; ++row) {
    for (std::size_t s = 0; s < slots_; ++s) {
      const Slot& slot = layout_.slots()[s];
      if (slot.isStrided) storeStrided(row, s, x, count, step);
      if (slot.kind != SlotLayout::Kind::Output || !slot.isInPlace || (count == room && step == 1)) continue;
      for (std::size_t a = slot.firstArray; a < slot.firstArray + slot.arrayCount; ++a) {
        const ArrayRow& to = inRow_[placeOf(row, a)];
        const std::byte* const from = scratch_[placeOf(row, a)];
        if (step == 1) {
          std::memcpy(to.first + x * to.bytes, from, static_cast<std::size_t>(count * to.bytes));
          continue;
        }
        for (std::int64_t i = 0; i < count; ++i) {
          std::memcpy(to.first + (x + i * step) * to.bytes, from + i * to.bytes,
                      static_cast<std::size_t>(to.bytes));
        }
      }
    }
  }
}

void SlotArrays::storeStrided(std::size_t row, std::size_t s, std::int64_t x, std::int64_t count,
                              std::int64_t step) {
  const Slot& slot = layout_.slots()[s];
  const std::int64_t stride = slot.argument->stride[0];
  const std::int64_t first = rowOf(row, s).first + x * stride;
  for (std::size_t a = slot.firstArray; a < slot.firstArray + slot.arrayCount; ++a) {
    withScalar(layout_.arrays()[a].bytes.held, [&]<class T> {
      const T* const from = reinterpret_cast<const T*>(scratch_[placeOf(row, a)]);
      T* const to = reinterpret_cast<T*>(layout_.arrays()[a].held) + first;
      for (std::int64_t i = 0; i < count; ++i) to[i * step * stride] = from[i];
    });
  }
}

void SlotArrays::stageInput(std::size_t row, std::size_t s, std::int64_t x, const Length& length,
                            std::int64_t step) {
  const Slot& slot = layout_.slots()[s];
  const native::Argument& argument = *slot.argument;
  const std::int64_t count = length.count;
  const std::int64_t stride = argument.stride[0];
  const auto numberAt = [&](std::int64_t i) {
    return rowOf(row, s).first + ownIndex(argument, 0, i) * stride;
  };
  for (std::size_t a = slot.firstArray; a < slot.firstArray + slot.arrayCount; ++a) {
    const SlotLayout::Array& array = layout_.arrays()[a];
    std::byte* const to = scratch_[placeOf(row, a)];
    if (array.held == nullptr) {  // an omitted stream reads as zeros
      padScalars(to, array.bytes.read, 0, count);
    } else if (argument.divide[0] == 1) {
      copyScalars({array.held, numberAt(x), argument.multiply[0] * stride * step}, array.bytes, to, count);
    } else if (step == 1) {
      stretchScalars({array.held, numberAt(x), argument.multiply[0] * stride}, array.bytes,
                     argument.divide[0], x % argument.divide[0], to, count);
    } else {
      for (std::int64_t i = 0; i < count; ++i)
        copyScalars({array.held, numberAt(x + i * step), 0}, array.bytes, to + i * array.bytes.read, 1);
    }
    padScalars(to, array.bytes.read, count, length.room);
  }
  useScratch(row, slot);
}

/// Lays out elements with their neighbours. The row below one row of the domain is the middle row for the
/// next one, so that it is laid out only once.
void SlotArrays::stageGather(std::size_t s, std::int64_t x, const Length& length, bool areOutsideAlone) {
  const Slot& slot = layout_.slots()[s];
  const std::size_t anew = slot.below ? 1 : wanted_;
  if (isAnyOutside_) {
    for (std::size_t row = 0; row < anew; ++row) {
      if (rowOf(row, s).isOutside) {
        stageBorder(row, slot, length.room);
      } else if (!areOutsideAlone) {
        stageNeighbors(slot, row, row + 1, x, length);
      }
    }
  } else {
    stageNeighbors(slot, 0, anew, x, length);
  }
  const std::size_t width = width_, wanted = wanted_, placed = placed_;
  for (std::size_t c = 0; c < slot.arrayCount; ++c) {
    void** const arrays = &arrays_[slot.firstArray + c];
    void* const* const below = slot.below ? &arrays_[layout_.slots()[*slot.below].firstArray + c] : nullptr;
    for (std::size_t row = anew; row < placed; ++row) {
      if (areOutsideAlone && !rowOf(row, s).isOutside) continue;
      arrays[row * width] = (row < wanted ? below : arrays)[(row - 1) * width];
    }
  }
}

/// Lays out the rows from `begin` to `end`.
void SlotArrays::stageNeighbors(const Slot& slot, std::size_t begin, std::size_t end, std::int64_t x,
                                const Length& length) {
  const std::int64_t around = 2 * slot.reach;
  const std::size_t width = width_, count = end - begin;
  for (std::size_t c = 0; c < slot.arrayCount; ++c) {
    const std::size_t at = placeOf(begin, slot.firstArray + c);
    const std::size_t bytes = layout_.arrays()[slot.firstArray + c].bytes.read;
    const Neighbors neighbors{slot.boundary, borderOf(slot, c), slot.argument, x - slot.reach,
                              length.count + around};
    const ArrayRow* const rows = &inRow_[at];
    std::byte* const* const scratch = &scratch_[at];
    withScalar(bytes, [&]<class T> {
      copyNeighbors<T>(
          neighbors, count, [=](std::size_t r) { return rows[r * width].first; },
          [=](std::size_t r) { return scratch[r * width]; });
    });
    void** const arrays = &arrays_[at];
    for (std::size_t r = 0; r < count; ++r) {
      std::byte* const staged = scratch[r * width];
      if (length.count < length.room) padScalars(staged, bytes, neighbors.count, length.room + around);
      arrays[r * width] = staged + slot.reach * static_cast<std::int64_t>(bytes);
    }
  }
}

RowEnds SlotArrays::ends() const {
  const native::Range within = inside(), columns = layout_.columns();
  const std::int64_t width = layout_.width();
  return {std::clamp<std::int64_t>(within.begin - columns.begin, 0, width),
          std::clamp<std::int64_t>(columns.end - within.end, 0, width), 2 * layout_.reach()};
}

SlotArrays::Block SlotArrays::blockOf(std::size_t most) const {
  Block block{most, true};
  const auto atMost = [&](std::int64_t rows) {
    block.rows = std::min(block.rows, static_cast<std::size_t>(std::max<std::int64_t>(rows, 1)));
  };
  for (std::size_t s = 0; s < slots_; ++s) {
    const Slot& slot = layout_.slots()[s];
    const bool isEven = slot.evenRows.begin <= at_[1] + 1 && at_[1] + 1 < slot.evenRows.end;
    atMost(isEven ? slot.evenRows.end - at_[1] : 1);
    if (slot.kind != SlotLayout::Kind::Gather) continue;
    block.mayCrossEnds =
        block.mayCrossEnds && rows_[s].first >= slot.wholeRows.begin && rows_[s].first < slot.wholeRows.end;
  }
  // all rows of the block are like the first one
  for (std::size_t s = 0; s < slots_; ++s) {
    const Slot& slot = layout_.slots()[s];
    if (slot.kind != SlotLayout::Kind::Gather || slot.rowStep <= 0) continue;
    const std::int64_t first = rows_[s].first;
    if (block.mayCrossEnds) {
      atMost((slot.wholeRows.end - 1 - first) / slot.rowStep + 1);
    } else if (first < slot.wholeRows.begin && slot.wholeRows.begin < slot.wholeRows.end) {
      atMost((slot.wholeRows.begin - first - 1) / slot.rowStep + 1);
    }
  }
  return block;
}

void* const* SlotArrays::placeEnds(const RowEnds& ends, std::size_t rows) {
  void** const arrays = arrays_.data() + arrays_.size() - width_;
  const native::Range columns = layout_.columns();
  for (const Slot& slot : layout_.slots()) {
    for (std::size_t a = slot.firstArray; a < slot.firstArray + slot.arrayCount; ++a) {
      const std::size_t bytes = layout_.arrays()[a].bytes.read;
      arrays[a] = scratch_[a] + slot.reach * static_cast<std::int64_t>(bytes);
      if (slot.kind == SlotLayout::Kind::Output) continue;
      withScalar(bytes, [&]<class T> {
        stageEnd<T>(slot, a, columns.begin, ends.left, 0, ends, rows);
        stageEnd<T>(slot, a, columns.end - ends.right, ends.right, ends.firstRight(), ends, rows);
      });
    }
  }
  return arrays;
}

/// Lays out `count` elements of each row from `x` on, with their neighbours. Those of the first row become
/// elements `to` and following ones of the array.
template <class T>
void SlotArrays::stageEnd(const Slot& slot, std::size_t array, std::int64_t x, std::int64_t count,
                          std::int64_t to, const RowEnds& ends, std::size_t rows) {
  constexpr std::int64_t size = sizeof(T);
  const void* const border = borderOf(slot, array - slot.firstArray);
  const bool isGather = slot.kind == SlotLayout::Kind::Gather;
  const std::int64_t spacing = ends.ofRow() * size;
  for (std::int64_t i = 0; i < count + 2 * slot.reach; ++i) {
    const std::int64_t index =
        isGather ? heldIndex(slot.boundary, *slot.argument, 0, x + i - slot.reach) : x + i;
    std::byte* staged = scratch_[array] + (to + i) * size;
    const bool isOutside = index == borderIndex;
    const auto* held = isOutside ? static_cast<const std::byte*>(border) : inRow_[array].first + index * size;
    const std::int64_t step = isOutside ? 0 : rowSteps_[array];
    for (std::size_t row = 0; row < rows; ++row, staged += spacing, held += step)
      std::memcpy(staged, held, sizeof(T));
  }
}

void SlotArrays::storeEnds(const RowEnds& ends, std::size_t rows) {
  const native::Range columns = layout_.columns();
  for (const Slot& slot : layout_.slots()) {
    if (slot.kind != SlotLayout::Kind::Output) continue;
    for (std::size_t a = slot.firstArray; a < slot.firstArray + slot.arrayCount; ++a) {
      withScalar(layout_.arrays()[a].bytes.read, [&]<class T> {
        storeEnd<T>(a, columns.begin, ends.left, 0, ends, rows);
        storeEnd<T>(a, columns.end - ends.right, ends.right, ends.firstRight(), ends, rows);
      });
    }
  }
}

/// The reverse of stageEnd(), for an output.
template <class T>
void SlotArrays::storeEnd(std::size_t array, std::int64_t x, std::int64_t count, std::int64_t from,
                          const RowEnds& ends, std::size_t rows) {
  constexpr std::int64_t size = sizeof(T);
  const std::int64_t spacing = ends.ofRow() * size, step = rowSteps_[array];
  for (std::int64_t i = 0; i < count; ++i) {
    const std::byte* staged = scratch_[array] + (from + i) * size;
    std::byte* held = inRow_[array].first + (x + i) * size;
    for (std::size_t row = 0; row < rows; ++row, staged += spacing, held += step)
      std::memcpy(held, staged, sizeof(T));
  }
}

void SlotArrays::stageBorder(std::size_t row, const Slot& slot, std::int64_t room) {
  for (std::size_t c = 0; c < slot.arrayCount; ++c) {
    const std::size_t at = placeOf(row, slot.firstArray + c);
    const std::size_t bytes = layout_.arrays()[slot.firstArray + c].bytes.read;
    fillScalars(borderOf(slot, c), bytes, scratch_[at], room + 2 * slot.reach);
    arrays_[at] = scratch_[at] + slot.reach * static_cast<std::int64_t>(bytes);
  }
}

/// The border value of a gather's component; null without Boundary::Border.
const void* SlotArrays::borderOf(const Slot& slot, std::size_t component) const {
  return slot.boundary == Boundary::Border ? layout_.border(slot.firstBorder + component) : nullptr;
}

}  // namespace sk
