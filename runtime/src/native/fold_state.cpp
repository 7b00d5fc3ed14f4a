// SPDX-License-Identifier: MIT
#include "native/fold_state.hpp"

#include <cstring>
#include <memory>
#include <type_traits>
#include <utility>

#include "native/memory.hpp"
#include "native/scalars.hpp"
#include "native/slot_arrays.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

std::vector<std::size_t> accumulatorBytes(std::span<const program::Parameter> parameters, RealType real) {
  std::vector<std::size_t> all;
  for (const program::Parameter& parameter : parameters) {
    if (parameter.role != program::Role::Accumulator) continue;
    forEachScalar(*parameter.element, real,
                  [&](std::size_t, std::size_t bytes, program::Scalar) { all.push_back(bytes); });
  }
  return all;
}

}  // namespace

StateShape::StateShape(std::span<const program::Parameter> parameters, RealType real)
    : StateShape(accumulatorBytes(parameters, real)) {}

StateShape::StateShape(std::vector<std::size_t> bytes) : bytes_(std::move(bytes)) {
  for (const std::size_t scalar : bytes_) total_ += scalar;
}

StateColumns::StateColumns(const StateShape& shape, std::int64_t most, std::pmr::memory_resource* memory)
    : shape_(&shape), arrays_(shape.scalars(), memory), bytes_(memory) {
  const auto room = [&](std::size_t scalar) {
    const std::size_t bytes = static_cast<std::size_t>(most + native::mostLanes) * shape.bytesOf(scalar);
    return (bytes + cacheLine - 1) / cacheLine * cacheLine;
  };
  std::size_t total = cacheLine;
  for (std::size_t scalar = 0; scalar < arrays_.size(); ++scalar) total += room(scalar);
  resizeChecked(bytes_, total);  // zeroed, because code reads beyond the columns
  void* next = bytes_.data();
  next = std::align(cacheLine, total - cacheLine, next, total);
  for (std::size_t scalar = 0; scalar < arrays_.size(); ++scalar) {
    arrays_[scalar] = next;
    next = static_cast<std::byte*>(next) + room(scalar);
  }
}

void StateColumns::assign(std::int64_t first, const StateColumns& other, std::int64_t from,
                          std::int64_t count) {
  for (std::size_t scalar = 0; scalar < arrays_.size(); ++scalar) {
    std::memcpy(at(scalar, first), other.at(scalar, from),
                static_cast<std::size_t>(count) * shape_->bytesOf(scalar));
  }
}

void StateColumns::assignReversed(const StateColumns& other, std::int64_t count) {
  const auto copy = [&]<std::size_t bytes>(std::size_t scalar, std::integral_constant<std::size_t, bytes>) {
    std::byte* const to = at(scalar, 0);
    const std::byte* const from = other.at(scalar, 0);
    std::int64_t reversed = 0;
    for (std::int64_t i = 0; i < count; ++i, reversed = nextReversed(reversed, count)) {
      std::memcpy(to + reversed * static_cast<std::int64_t>(bytes),
                  from + i * static_cast<std::int64_t>(bytes), bytes);
    }
  };
  for (std::size_t scalar = 0; scalar < arrays_.size(); ++scalar) {
    switch (shape_->bytesOf(scalar)) {
      case 1: copy(scalar, std::integral_constant<std::size_t, 1>{}); break;
      case 2: copy(scalar, std::integral_constant<std::size_t, 2>{}); break;
      case 4: copy(scalar, std::integral_constant<std::size_t, 4>{}); break;
      case 8: copy(scalar, std::integral_constant<std::size_t, 8>{}); break;
      default: copy(scalar, std::integral_constant<std::size_t, mostScalarBytes>{}); break;
    }
  }
}

void StateColumns::unpackReversed(const std::byte* bytes, std::int64_t count) {
  std::int64_t reversed = 0;
  for (std::int64_t i = 0; i < count; ++i, bytes += shape_->bytes()) {
    unpack(reversed, bytes);
    reversed = nextReversed(reversed, count);
  }
}

void StateColumns::pack(std::int64_t column, std::byte* bytes) const {
  for (std::size_t scalar = 0; scalar < arrays_.size(); ++scalar) {
    std::memcpy(bytes, at(scalar, column), shape_->bytesOf(scalar));
    bytes += shape_->bytesOf(scalar);
  }
}

void StateColumns::unpack(std::int64_t column, const std::byte* bytes) {
  for (std::size_t scalar = 0; scalar < arrays_.size(); ++scalar) {
    std::memcpy(at(scalar, column), bytes, shape_->bytesOf(scalar));
    bytes += shape_->bytesOf(scalar);
  }
}

ColumnCombiner::ColumnCombiner(const StateShape& shape, native::CombineFunction* function, std::int64_t lanes,
                               const native::Frame* frame, std::pmr::memory_resource* memory)
    : function_(function),
      lanes_(lanes),
      frame_(frame),
      kept_(shape, lanes, memory),
      later_(shape.scalars(), memory),
      shape_(shape) {}

void ColumnCombiner::combine(StateColumns& state, const StateColumns& later, std::int64_t first,
                             std::int64_t count) {
  if (count == 0) return;
  const std::int64_t beyond = roundUp(count, lanes_) - count;
  if (beyond > 0) kept_.assign(0, state, count, beyond);
  call(state, later, first, count);
  if (beyond > 0) state.assign(count, kept_, 0, beyond);
}

void ColumnCombiner::call(StateColumns& state, const StateColumns& later, std::int64_t first,
                          std::int64_t count) {
  for (std::size_t scalar = 0; scalar < shape_.scalars(); ++scalar) later_[scalar] = later.at(scalar, first);
  function_(frame_, state.arrays(), later_.data(), count);
}

void ColumnCombiner::gather(StateColumns& state, std::int64_t count, std::int64_t left) {
  while (count > left) {
    const std::int64_t half = (count + 1) / 2;
    if (count == 2 * half) {
      call(state, state, half, half);  // columns beyond these are not needed any more
    } else {
      combine(state, state, half, count - half);
    }
    count = half;
  }
}

StateColumns& StateRuns::next() {
  if (runs_.size() == leaves_.size()) runs_.emplace_back(shape_, most_, runs_.get_allocator().resource());
  return runs_[leaves_.size()];
}

void StateRuns::add(std::int64_t leaves) {
  leaves_.push_back(leaves);
  while (leaves_.size() > 1 && leaves_[leaves_.size() - 2] == leaves_.back()) merge();
}

StateColumns& StateRuns::take() {
  while (leaves_.size() > 1) merge();
  leaves_.clear();
  return runs_[0];
}

void StateRuns::merge() {
  const std::size_t last = leaves_.size() - 1;
  combiner_.combine(runs_[last - 1], runs_[last], 0, columns_);
  leaves_[last - 1] += leaves_[last];
  leaves_.pop_back();
}

}  // namespace sk
