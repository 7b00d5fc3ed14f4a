// SPDX-License-Identifier: MIT
//
// Accumulators of reductions side by side, as object code folds them, and the order in which partial results
// are combined.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <span>
#include <vector>

#include "native/components.hpp"
#include "sk/native/code.hpp"
#include "sk/program.hpp"

namespace sk {

/// Counts in bit-reversed order, from 0: the successor of `reversed` among the numbers below `count`, a power of 2.
inline std::int64_t nextReversed(std::int64_t reversed, std::int64_t count) {
  std::int64_t bit = count / 2;
  for (; (reversed & bit) != 0; bit /= 2) reversed -= bit;
  return reversed + bit;
}

/// The scalars of all accumulators of a reduction.
class StateShape {
 public:
  /// The scalars of the accumulators among these parameters, in their order.
  StateShape(std::span<const program::Parameter> parameters, RealType real);
  /// Scalars of these sizes.
  explicit StateShape(std::vector<std::size_t> bytes);

  std::size_t scalars() const { return bytes_.size(); }
  std::size_t bytesOf(std::size_t scalar) const { return bytes_[scalar]; }
  std::size_t bytes() const { return total_; }
  /// The number of accumulators that fit in `bytes`, clamped to `least` ... `most` and rounded down to a
  /// power of 2.
  std::int64_t columnsIn(std::size_t bytes, std::size_t least, std::size_t most) const {
    return static_cast<std::int64_t>(std::bit_floor(std::clamp(bytes / total_, least, most)));
  }

 private:
  std::vector<std::size_t> bytes_;
  std::size_t total_ = 0;
};

/// Accumulators side by side: one array per scalar. Code may read and write whole groups of lanes beyond the
/// last column.
class StateColumns {
 public:
  /// `memory` must outlive the columns.
  StateColumns(const StateShape& shape, std::int64_t most,
               std::pmr::memory_resource* memory = std::pmr::get_default_resource());
  StateColumns(StateColumns&&) noexcept = default;

  void* const* arrays() const { return arrays_.data(); }
  std::byte* at(std::size_t scalar, std::int64_t column) const {
    return static_cast<std::byte*>(arrays_[scalar]) +
           static_cast<std::size_t>(column) * shape_->bytesOf(scalar);
  }
  /// Copies `count` columns of `other` from number `from` on to number `first` on.
  void assign(std::int64_t first, const StateColumns& other, std::int64_t from, std::int64_t count);
  /// Copies `count` columns, a power of 2, in bit-reversed order.
  void assignReversed(const StateColumns& other, std::int64_t count);

  /// The scalars of a column one after the other, StateShape::bytes() in all.
  void pack(std::int64_t column, std::byte* bytes) const;
  void unpack(std::int64_t column, const std::byte* bytes);
  /// Unpacks `count` consecutive columns, a power of 2, in bit-reversed order.
  void unpackReversed(const std::byte* bytes, std::int64_t count);

 private:
  const StateShape* shape_;
  std::pmr::vector<void*> arrays_;
  std::pmr::vector<std::byte> bytes_;
};

/// Combines columns with a reduction's object code. Columns beyond the last do not change.
class ColumnCombiner {
 public:
  ColumnCombiner(const StateShape& shape, native::CombineFunction* function, std::int64_t lanes,
                 const native::Frame* frame,
                 std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  /// Folds `count` columns of `later` from number `first` on into the first columns of `state`. Both may be
  /// the same.
  void combine(StateColumns& state, const StateColumns& later, std::int64_t first, std::int64_t count);
  /// Folds `count` columns into the first `left` columns, each time the second half into the first. `left` is
  /// 1, or `count` is `left` times a power of 2.
  void gather(StateColumns& state, std::int64_t count, std::int64_t left = 1);

 private:
  /// May change columns beyond the last, up to a whole group of lanes.
  void call(StateColumns& state, const StateColumns& later, std::int64_t first, std::int64_t count);

  native::CombineFunction* function_;
  std::int64_t lanes_;
  const native::Frame* frame_;
  StateColumns kept_;
  std::pmr::vector<void*> later_;
  const StateShape& shape_;
};

/// Combines the results of leaves as a binary tree: two results of equally many leaves become one. The error
/// of a sum of n elements then grows with log n instead of n.
class StateRuns {
 public:
  /// Results have at most `most` columns.
  StateRuns(const StateShape& shape, ColumnCombiner& combiner, std::int64_t most,
            std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : shape_(shape), combiner_(combiner), most_(most), columns_(most), runs_(memory), leaves_(memory) {}

  /// Uses only the first `count` columns from here on.
  void useColumns(std::int64_t count) { columns_ = count; }
  bool isEmpty() const { return leaves_.empty(); }
  /// Where the caller stores the next result before add().
  StateColumns& next();
  /// Adds the result in next(): one leaf, or `leaves` leaves combined as if added one by one, a power of 2 up
  /// to mostTogether().
  void add(std::int64_t leaves = 1);
  /// The most leaves that may be combined with each other before they are added.
  std::int64_t mostTogether() const {
    return leaves_.empty() ? std::numeric_limits<std::int64_t>::max() : leaves_.back();
  }
  /// Combines all results in order, and starts anew. There must be at least one.
  StateColumns& take();

 private:
  void merge();

  const StateShape& shape_;
  ColumnCombiner& combiner_;
  std::int64_t most_;
  std::int64_t columns_;
  std::pmr::vector<StateColumns> runs_;
  std::pmr::vector<std::int64_t> leaves_;
};

}  // namespace sk
