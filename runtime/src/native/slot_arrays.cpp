// SPDX-License-Identifier: MIT
#include "native/slot_arrays.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace sk {

namespace {

using native::Argument;
using native::Extents;
using native::Range;
using program::Boundary;
using program::Parameter;
using program::Role;

constexpr std::size_t cacheLine = 64;

/// The index inside for one that may be outside of n elements; -1 where there is a border.
std::int64_t broughtInside(Boundary boundary, std::int64_t i, std::int64_t n) {
  if (i >= 0 && i < n) return i;
  switch (boundary) {
    case Boundary::Clamp: return std::clamp<std::int64_t>(i, 0, n - 1);
    case Boundary::Border: return -1;
    case Boundary::Wrap:
    case Boundary::Mirror: break;
  }
  const std::int64_t period = boundary == Boundary::Mirror ? 2 * n : n;
  const std::int64_t inside = (i % period + period) % period;
  return inside < n ? inside : period - 1 - inside;
}

/// The index in an input that belongs to one in the domain.
std::int64_t ownIndex(const Argument& input, std::size_t d, std::int64_t index) {
  const std::int64_t multiplied = index * input.multiply[d];
  return input.divide[d] == 1 ? multiplied : multiplied / input.divide[d];
}

}  // namespace

// ---- of a call -------------------------------------------------------------------------------------

SlotLayout::SlotLayout(const program::Kernel& kernel, const native::Call& call, const CodeFrame& frame,
                       const CodeChoice& choice, std::pmr::memory_resource* memory)
    : width_(call.domain[0]), slots_(memory), arrays_(memory), borders_(memory) {
  const std::span<const native::Slot> slots(kernel.code->slots, kernel.code->slotCount);
  slots_.reserve(slots.size());
  arrays_.reserve(slots.size());
  for (const native::Slot& slot : slots) addSlot(kernel, call, frame, slot, choice.real);
  if (hasGathers_) readBorders(kernel, frame, choice);
}

void SlotLayout::addSlot(const program::Kernel& kernel, const native::Call& call, const CodeFrame& frame,
                         const native::Slot& slot, RealType real) {
  const Parameter& parameter = kernel.parameters[slot.parameter];
  const native::Operand& operand = call.operands[slot.parameter];
  const Argument& argument = frame.arguments()[slot.parameter];
  Slot& made = slots_.emplace_back();
  made.kind = slot.isOutput != 0 ? Kind::Output : parameter.role == Role::Gather ? Kind::Gather : Kind::Input;
  made.isGiven = argument.components != nullptr;
  made.boundary = parameter.boundary;
  made.rank = parameter.rank;
  std::ranges::copy(slot.row, made.row);
  made.reach = slot.reach;
  made.argument = &argument;
  made.firstArray = arrays_.size();
  // one element of an input, which repeats as far as its extent says, lies as the domain's one does
  const bool isFitted = width_ != 1 && (argument.multiply[0] != 1 || argument.divide[0] != 1);
  made.isDirect =
      made.isGiven && !operand.holdsFloats && !isFitted && (width_ == 1 || argument.stride[0] == 1);
  if (made.kind == Kind::Gather) {
    hasGathers_ = true;
    made.firstBorder = firstBorderOf(kernel, slot.parameter);
  } else {
    isDirect_ = isDirect_ && (made.kind == Kind::Input ? made.isDirect : made.isGiven);
    goesByElement_ = goesByElement_ || (made.kind == Kind::Input && parameter.usesIndex && isFitted);
  }
  forEachScalar(*parameter.element, real, [&](std::size_t number, std::size_t bytes, program::Scalar scalar) {
    const auto read = static_cast<std::uint8_t>(bytes);
    const bool isWidened = operand.holdsFloats && scalar == program::Scalar::Float;
    arrays_.push_back({made.isGiven ? static_cast<std::byte*>(argument.components[number]) : nullptr,
                       {isWidened ? static_cast<std::uint8_t>(sizeof(float)) : read, read}});
  });
  made.arrayCount = arrays_.size() - made.firstArray;
}

/// The code writes all components of one gather after the other.
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

// ---- of a thread -----------------------------------------------------------------------------------

SlotArrays::SlotArrays(const SlotLayout& layout, std::int64_t most, std::int64_t mostAtEnds)
    : layout_(layout),
      rows_(layout.slots().size(), memory_.get()),
      inRow_(layout.arrays().size(), memory_.get()),
      arrays_(layout.arrays().size(), memory_.get()),
      scratch_(memory_.get()) {
  scratch_.reserve(arrays_.size());
  for (const Slot& slot : layout.slots()) {
    const bool isDirect = slot.kind == SlotLayout::Kind::Output ? slot.isGiven : slot.isDirect;
    const bool isAtEndsAlone = isDirect && slot.kind != SlotLayout::Kind::Gather;
    const std::int64_t laidOut = std::min(layout.width(), isAtEndsAlone ? mostAtEnds : most);
    const std::int64_t elements = laidOut + native::mostLanes + 2 * slot.reach;
    for (std::size_t a = slot.firstArray; a < slot.firstArray + slot.arrayCount; ++a) {
      const std::size_t bytes = static_cast<std::size_t>(elements) * layout.arrays()[a].bytes.read;
      scratch_.push_back(static_cast<std::byte*>(memory_.get()->allocate(bytes, cacheLine)));
    }
  }
}

void SlotArrays::moveToRow(const Extents& first) {
  for (std::size_t s = 0; s < rows_.size(); ++s) {
    const Slot& slot = layout_.slots()[s];
    Row row{slot.argument->first, false};
    if (slot.kind == SlotLayout::Kind::Gather) {
      for (std::size_t d = 1; d < slot.rank; ++d) {
        const std::int64_t index =
            broughtInside(slot.boundary, first[d] + slot.row[d - 1], slot.argument->extent[d]);
        row.isOutside = row.isOutside || index < 0;
        row.first += index * slot.argument->stride[d];
      }
    } else {
      for (std::size_t d = 1; d < 4; ++d) {
        row.first += ownIndex(*slot.argument, d, first[d]) * slot.argument->stride[d];
      }
    }
    rows_[s] = row;
    for (std::size_t a = slot.firstArray; a < slot.firstArray + slot.arrayCount; ++a) {
      const SlotLayout::Array& array = layout_.arrays()[a];
      if (array.held != nullptr) inRow_[a] = {array.held + row.first * array.bytes.held, array.bytes.held};
    }
  }
}

void SlotArrays::place(std::int64_t x, std::int64_t count, std::int64_t room, std::int64_t step, bool keeps) {
  const std::span<const Slot> slots = layout_.slots();
  for (std::size_t s = 0; s < slots.size(); ++s) {
    switch (slots[s].kind) {
      case SlotLayout::Kind::Input: placeInput(s, x, count, room, step); break;
      case SlotLayout::Kind::Output: placeOutput(s, x, keeps && slots[s].isGiven && count == room); break;
      case SlotLayout::Kind::Gather: placeGather(s, x, count, room); break;
    }
  }
}

void SlotArrays::storeOutputs(std::int64_t x, std::int64_t count) {
  for (std::size_t s = 0; s < rows_.size(); ++s) {
    const Slot& slot = layout_.slots()[s];
    if (slot.kind != SlotLayout::Kind::Output || !slot.isGiven) continue;
    for (std::size_t a = slot.firstArray; a < slot.firstArray + slot.arrayCount; ++a) {
      const SlotLayout::Array& array = layout_.arrays()[a];
      std::memcpy(array.held + (rows_[s].first + x) * array.bytes.read, scratchOf(a),
                  static_cast<std::size_t>(count) * array.bytes.read);
    }
  }
}

void SlotArrays::placeInput(std::size_t s, std::int64_t x, std::int64_t count, std::int64_t room,
                            std::int64_t step) {
  const Slot& slot = layout_.slots()[s];
  const bool isDirect = slot.isDirect && step == 1 && x + room <= layout_.width();
  for (std::size_t a = slot.firstArray; a < slot.firstArray + slot.arrayCount; ++a) {
    const SlotLayout::Array& array = layout_.arrays()[a];
    if (isDirect) {
      arrays_[a] = array.held + (rows_[s].first + x) * array.bytes.read;
    } else {
      layOutInput(s, a, x, count, step);
      padScalars(scratchOf(a), array.bytes.read, count, room);
      arrays_[a] = scratchOf(a);
    }
  }
}

void SlotArrays::layOutInput(std::size_t s, std::size_t a, std::int64_t x, std::int64_t count,
                             std::int64_t step) {
  const Argument& argument = *layout_.slots()[s].argument;
  const SlotLayout::Array& array = layout_.arrays()[a];
  const std::int64_t stride = argument.stride[0];
  const auto numberAt = [&](std::int64_t at) { return rows_[s].first + ownIndex(argument, 0, at) * stride; };
  if (array.held == nullptr) {  // nobody looks at what it holds
    padScalars(scratchOf(a), array.bytes.read, 0, count);
  } else if (argument.divide[0] == 1) {
    copyScalars({array.held, numberAt(x), argument.multiply[0] * stride * step}, array.bytes, scratchOf(a),
                count);
  } else if (step == 1) {
    stretchScalars({array.held, numberAt(x), argument.multiply[0] * stride}, array.bytes, argument.divide[0],
                   x % argument.divide[0], scratchOf(a), count);
  } else {
    std::byte* to = scratchOf(a);
    for (std::int64_t i = 0; i < count; ++i, to += array.bytes.read) {
      copyScalars({array.held, numberAt(x + i * step), 0}, array.bytes, to, 1);
    }
  }
}

void SlotArrays::placeOutput(std::size_t s, std::int64_t x, bool isDirect) {
  const Slot& slot = layout_.slots()[s];
  for (std::size_t a = slot.firstArray; a < slot.firstArray + slot.arrayCount; ++a) {
    const SlotLayout::Array& array = layout_.arrays()[a];
    arrays_[a] = isDirect ? array.held + (rows_[s].first + x) * array.bytes.read : scratchOf(a);
  }
}

void SlotArrays::placeGather(std::size_t s, std::int64_t x, std::int64_t count, std::int64_t room) {
  const Slot& slot = layout_.slots()[s];
  const bool isInside =
      !rows_[s].isOutside && x >= slot.reach && x + room + slot.reach <= slot.argument->extent[0];
  for (std::size_t a = slot.firstArray; a < slot.firstArray + slot.arrayCount; ++a) {
    const SlotLayout::Array& array = layout_.arrays()[a];
    const std::int64_t bytes = array.bytes.read;
    if (isInside) {
      arrays_[a] = array.held + (rows_[s].first + x) * bytes;
    } else {
      layOutGather(slot, s, a, x - slot.reach, count + 2 * slot.reach);
      padScalars(scratchOf(a), array.bytes.read, count + 2 * slot.reach, room + 2 * slot.reach);
      arrays_[a] = scratchOf(a) + slot.reach * bytes;
    }
  }
}

/// Neighbours from `x` on, of which some may be outside.
void SlotArrays::layOutGather(const Slot& slot, std::size_t s, std::size_t a, std::int64_t x,
                              std::int64_t count) {
  const SlotLayout::Array& array = layout_.arrays()[a];
  const std::int64_t bytes = array.bytes.read;
  const std::int64_t extent = slot.argument->extent[0];
  std::byte* const to = scratchOf(a);
  const auto border = [&] { return layout_.border(slot.firstBorder + a - slot.firstArray); };
  if (rows_[s].isOutside) {
    fillScalars(border(), array.bytes.read, to, count);
    return;
  }
  const auto copyOutside = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      const std::int64_t index = broughtInside(slot.boundary, x + i, extent);
      const void* from = index < 0 ? border() : array.held + (rows_[s].first + index) * bytes;
      fillScalars(from, array.bytes.read, to + i * bytes, 1);
    }
  };
  const std::int64_t begin = std::clamp<std::int64_t>(-x, 0, count);
  const std::int64_t end = std::clamp<std::int64_t>(extent - x, begin, count);
  copyOutside(0, begin);
  copyScalars({array.held, rows_[s].first + x + begin, 1}, array.bytes, to + begin * bytes, end - begin);
  copyOutside(end, count);
}

Range SlotArrays::inside() const {
  Range inside{0, std::numeric_limits<std::int64_t>::max()};
  for (std::size_t s = 0; s < rows_.size(); ++s) {
    const Slot& slot = layout_.slots()[s];
    if (slot.kind != SlotLayout::Kind::Gather) continue;
    inside.begin = std::max(inside.begin, slot.reach);
    inside.end = rows_[s].isOutside ? 0 : std::min(inside.end, slot.argument->extent[0] - slot.reach);
  }
  return inside;
}

}  // namespace sk
