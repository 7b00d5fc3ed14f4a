// SPDX-License-Identifier: MIT
//
// Blocks of few elements along x, as those of a sum of columns: a row of the domain goes through many of them, and they are folded side by
// side, each in its own order.
#pragma once

#include <algorithm>
#include <cstdint>

#include "sk/native/columns.hpp"
#include "sk/native/hot.hpp"
#include "sk/native/run.hpp"

namespace sk::native {

/// The blocks of such a reduction in groups of neighbours.
class NarrowGroups {
 public:
  NarrowGroups(const ReduceCall& call, std::int64_t longest) : block_(call.block), longest_(longest) {
    for (std::size_t d = 0; d < 4; ++d) blocks_[d] = call.fold.domain[d] / block_[d];
  }

  /// Accumulators of many scalars, as those of exact sums, gain little by it, and take compilers long.
  template <class State>
  static constexpr bool isFew = footprintOf<State>().scalars <= 8;
  static bool isNarrow(const ReduceCall& call) {
    return call.block[0] <= 8 && call.block[0] < call.fold.domain[0];
  }

  std::int64_t count() const { return perRow() * blocks_[1] * blocks_[2] * blocks_[3]; }
  std::int64_t elementsOfOne() const {
    return std::min(longest_, blocks_[0]) * block_[0] * block_[1] * block_[2] * block_[3];
  }
  Extents firstOf(std::int64_t group) const {
    const std::int64_t row = group / perRow();
    return {group % perRow() * longest_, row % blocks_[1], row / blocks_[1] % blocks_[2],
            row / blocks_[1] / blocks_[2]};
  }
  int lengthFrom(const Extents& first) const {
    return static_cast<int>(std::min(longest_, blocks_[0] - first[0]));
  }

 private:
  std::int64_t perRow() const { return (blocks_[0] + longest_ - 1) / longest_; }

  Extents block_, blocks_;
  std::int64_t longest_;
};

template <class Fold, class Combine>
class NarrowFolder {
 public:
  using State = typename Fold::sk_State;
  /// As many as stay in the nearest cache beside the elements.
  static constexpr int most = columnsIn<State>(2048, 32, 512);

  explicit NarrowFolder(const ReduceCall& call)
      : block_(call.block), fold_(call.fold), combine_{call.combine}, runs_(combine_) {
    fold_.sk_extent = toIndex(call.fold.domain);
  }

  /// Folds and stores `count` neighbouring blocks.
  void fold(const Extents& first, int count) {
    combine_.count = count;
    Extents in{};
    const std::int64_t rows = block_[1] * block_[2] * block_[3];
    for (std::int64_t row = 0; row < rows; ++row) {
      foldRow(first, in, count);
      for (std::size_t d = 1; d < 4 && ++in[d] == block_[d]; ++d) in[d] = 0;
    }
    if (rounds_ > 0) endLeaf();
    const Columns<State, most>& results = runs_.take();
    Extents at = first;
    for (int k = 0; k < count; ++k, ++at[0]) fold_.sk_store(toIndex(at), results.load(k));
  }

 private:
  /// Combines columns one by one.
  struct CombineColumns {
    explicit CombineColumns(const Call& call) : combine(call) {}
    void sk_combine(Columns<State, most>& columns, const Columns<State, most>& later) {
      combineColumns(combine, columns, later, 0, count);
    }
    Combine combine;
    int count = 0;
  };

  void foldRow(const Extents& block, const Extents& in, int count) {
    Extents first;
    for (std::size_t d = 0; d < 4; ++d) first[d] = block[d] * block_[d] + in[d];
    const auto width = static_cast<int>(block_[0]);
    place(fold_, {first, count * width, scratch_});
    for (int x = 0; x < width; ++x) {
      foldOne(static_cast<std::int32_t>(first[0]), x, width, count);
      if (++rounds_ == leaf) endLeaf();
    }
  }

  /// Element x of a row of each block.
  void foldOne(std::int32_t first, int x, int width, int count) {
    Fold here = fold_;
    if (rounds_ == 0) {
      SK_NATIVE_INDEPENDENT
      for (int k = 0; k < count; ++k) {
        moveTo(here, first, k * width + x);
        columns_.store(k, started(here));
      }
    } else {
      SK_NATIVE_INDEPENDENT
      for (int k = 0; k < count; ++k) {
        moveTo(here, first, k * width + x);
        State state = columns_.load(k);
        here.sk_fold(state);
        columns_.store(k, state);
      }
    }
  }

  void endLeaf() {
    rounds_ = 0;
    runs_.add(columns_);
  }

  Extents block_;
  Fold fold_;
  CombineColumns combine_;
  Runs<CombineColumns, Columns<State, most>> runs_;
  Scratch scratch_;
  Columns<State, most> columns_;
  int rounds_ = 0;  ///< elements of the leaf so far, in each column
};

}  // namespace sk::native
