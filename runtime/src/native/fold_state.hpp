// SPDX-License-Identifier: MIT
//
// Accumulators of reductions side by side, as object code folds them, and the order in which partial results become one.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
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
  /// Of the accumulators among these parameters, in their order.
  StateShape(std::span<const program::Parameter> parameters, RealType real);
  /// Of scalars of these sizes.
  explicit StateShape(std::vector<std::size_t> bytes);

  std::size_t scalars() const { return bytes_.size(); }
  std::size_t bytesOf(std::size_t scalar) const { return bytes_[scalar]; }
  std::size_t bytes() const { return total_; }
  /// How many accumulators take so many bytes: a power of 2.
  std::int64_t columnsIn(std::size_t bytes, std::size_t least, std::size_t most) const {
    return static_cast<std::int64_t>(std::bit_floor(std::clamp(bytes / total_, least, most)));
  }

 private:
  std::vector<std::size_t> bytes_;
  std::size_t total_ = 0;
};

/// Accumulators side by side: an array for each scalar. Whole groups of lanes may be read and written beyond the last column.
class StateColumns {
 public:
  StateColumns(const StateShape& shape, std::int64_t most);

  void* const* arrays() const { return arrays_.data(); }
  std::byte* at(std::size_t scalar, std::int64_t column) const {
    return static_cast<std::byte*>(arrays_[scalar]) +
           static_cast<std::size_t>(column) * shape_->bytesOf(scalar);
  }
  /// Takes `count` columns from `first` on from those of another one from `from` on.
  void assign(std::int64_t first, const StateColumns& other, std::int64_t from, std::int64_t count);
  /// Copies `count` columns, a power of 2, in bit-reversed order.
  void assignReversed(const StateColumns& other, std::int64_t count);

  /// A column's scalars one behind the other: StateShape::bytes().
  void pack(std::int64_t column, std::byte* bytes) const;
  void unpack(std::int64_t column, const std::byte* bytes);
  /// Unpacks `count` consecutive columns, a power of 2, in bit-reversed order.
  void unpackReversed(const std::byte* bytes, std::int64_t count);

 private:
  const StateShape* shape_;
  std::vector<void*> arrays_;
  std::unique_ptr<std::byte[]> bytes_;
};

/// Combines columns by a reduction's object code, of which no column beyond the last changes.
class ColumnCombiner {
 public:
  ColumnCombiner(const StateShape& shape, native::CombineFunction* function, std::int64_t lanes,
                 const native::Frame* frame);

  /// Folds `count` columns of `later` from `first` on, which come later, into the first columns of `state`, which may be the same.
  void combine(StateColumns& state, const StateColumns& later, std::int64_t first, std::int64_t count);
  /// Folds `count` columns into the first `left` of them: each half into the other. `left` is 1, or `count` is a power of 2
  /// times as many.
  void gather(StateColumns& state, std::int64_t count, std::int64_t left = 1);

 private:
  /// Columns beyond the last change, up to a whole group of lanes.
  void call(StateColumns& state, const StateColumns& later, std::int64_t first, std::int64_t count);

  native::CombineFunction* function_;
  std::int64_t lanes_;
  const native::Frame* frame_;
  StateColumns kept_;
  std::vector<void*> later_;
  const StateShape& shape_;
};

/// Results of leaves, each with how many it is made of; two of equal size become one. So a sum of n elements has an error of some log n
/// roundings, not n.
class StateRuns {
 public:
  /// Of `most` columns side by side at most.
  StateRuns(const StateShape& shape, ColumnCombiner& combiner, std::int64_t most)
      : shape_(shape), combiner_(combiner), most_(most), columns_(most) {}

  /// Only the first of the columns count from here on.
  void useColumns(std::int64_t count) { columns_ = count; }
  bool isEmpty() const { return leaves_.empty(); }
  /// Where the next leaf is to be stored,
  StateColumns& next();
  /// and that it is there; or `leaves` of them, a power of 2 up to mostTogether(), combined as if added one by one.
  void add(std::int64_t leaves = 1);
  /// How many leaves are combined with each other before any other.
  std::int64_t mostTogether() const {
    return leaves_.empty() ? std::numeric_limits<std::int64_t>::max() : leaves_.back();
  }
  /// Of all that were added, in order; there is one at least.
  StateColumns& take();

 private:
  void merge();

  const StateShape& shape_;
  ColumnCombiner& combiner_;
  std::int64_t most_;
  std::int64_t columns_;
  std::vector<std::unique_ptr<StateColumns>> runs_;
  std::vector<std::int64_t> leaves_;
};

}  // namespace sk
