// SPDX-License-Identifier: MIT
//
// Folds neighbours in a row into accumulators: one call of a fold's object code, or several where that cannot take them in one.
#pragma once

#include <cstdint>
#include <vector>

#include "native/fold_program.hpp"

namespace sk {

/// How columns begin.
enum class Start : std::uint8_t { New, Continued };

/// For one thread.
class LeafFolder {
 public:
  explicit LeafFolder(const FoldProgram& program);

  /// From here on, elements are in the row of this one.
  void moveToRow(const native::Extents& first);
  /// How many neighbours are folded as if they were a row of their own.
  std::int64_t longest() const { return longest_; }
  /// Whether elements that are no neighbours are folded several together.
  bool foldsApart() const { return program_.fold.lanes > 1 && !goesOneByOne(); }

  /// Whether one call can fold several consecutive leaves of `columns` columns.
  bool foldsLeavesTogether(std::int64_t columns) const {
    return program_.layout.isDirect() && !goesOneByOne() && columns % program_.fold.lanes == 0;
  }
  /// Folds `leaves` of them from x on, a power of 2. Each starts; `state` has its columns where FoldFunction says.
  void foldLeaves(StateColumns& state, std::int64_t x, std::int64_t columns, std::int64_t rounds,
                  std::int64_t leaves);

  /// Folds the elements at x, x + step ... into the columns of `state`: `rounds` of them into each, every `columns`-th. Columns
  /// beyond the last change.
  void fold(StateColumns& state, std::int64_t x, std::int64_t columns, std::int64_t rounds, Start start,
            std::int64_t step = 1);
  /// Folds one element into each of `count` columns from `first` on, and changes no other column.
  void foldInto(StateColumns& state, std::int64_t first, std::int64_t x, std::int64_t count, Start start);

 private:
  bool goesOneByOne() const { return program_.layout.goesByElement() || program_.layout.hasGathers(); }
  /// The numbers of a call of the object code.
  struct Division {
    std::int64_t columns, rounds, leaves;
  };
  void call(void* const* state, std::int64_t x, const Division& division, Start start, std::int64_t step);
  void foldOneByOne(StateColumns& state, std::int64_t x, std::int64_t columns, std::int64_t rounds,
                    Start start, std::int64_t step);

  const FoldProgram& program_;
  std::int64_t longest_;
  SlotArrays arrays_;
  StateColumns some_;
  std::vector<void*> rest_;
  native::Chunk chunk_{};
};

}  // namespace sk
