// SPDX-License-Identifier: MIT
//
// Folds neighbours in a row into accumulators with one call of a fold's object code, or with several if it
// cannot take them in one.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <vector>

#include "native/fold_program.hpp"

namespace sk {

/// Whether a fold starts its columns anew or continues them.
enum class Start : std::uint8_t { New, Continued };

/// Each thread has its own.
class LeafFolder {
 public:
  explicit LeafFolder(const FoldProgram& program,
                      std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  /// Elements are in the row of this one from here on.
  void moveToRow(const native::Extents& first);
  /// The most neighbours that are folded as one row; longer rows are divided.
  std::int64_t longest() const { return longest_; }
  /// True if elements that are not neighbours are folded several at a time.
  bool foldsApart() const { return program_.fold.lanes > 1 && !foldsElementwise(); }

  /// True if one call can fold several consecutive leaves of `columns` columns.
  bool foldsLeavesTogether(std::int64_t columns) const {
    return program_.layout.isDirect() && !foldsElementwise() && columns % program_.fold.lanes == 0;
  }
  /// Folds `leaves` leaves from x on, a power of 2. All columns start anew; FoldFunction says where they are
  /// in `state`.
  void foldLeaves(StateColumns& state, std::int64_t x, std::int64_t columns, std::int64_t rounds,
                  std::int64_t leaves);

  /// Folds the elements at x, x + step ... into the columns of `state`: `rounds` elements into each column,
  /// every `columns`-th. Changes columns beyond the last.
  void fold(StateColumns& state, std::int64_t x, std::int64_t columns, std::int64_t rounds, Start start,
            std::int64_t step = 1);
  /// Folds one element into each of `count` columns from number `first` on; changes no other column.
  void foldInto(StateColumns& state, std::int64_t first, std::int64_t x, std::int64_t count, Start start);

 private:
  bool foldsElementwise() const {
    return program_.layout.needsElementwiseCalls() || program_.layout.hasGathers();
  }
  /// How a call of the object code divides its elements.
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
  std::pmr::vector<void*> rest_;
  native::Chunk chunk_{};
};

}  // namespace sk
