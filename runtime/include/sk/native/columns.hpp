// SPDX-License-Identifier: MIT
//
// What reductions in native code are put together from: runs of elements that have been folded, and accumulators side by side, which
// are columns of the table that elements make when they are written down row by row.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "sk/native/call.hpp"
#include "sk/native/element.hpp"
#include "sk/native/hot.hpp"

namespace sk::native {

/// Elements, or partial results, that are folded one after the other; program::longestRun at most.
inline constexpr int leaf = 16;

/// Results of runs, each with how many leaves it is made of; two of equal size become one. So a sum of n elements
/// has an error of some log n roundings, not n.
template <class Combine, class State>
class Runs {
 public:
  explicit Runs(Combine& combine) : combine_(combine) {}

  void add(const State& state) {
    runs_[count_++] = {1, state};
    while (count_ > 1 && runs_[count_ - 2].leaves == runs_[count_ - 1].leaves) merge();
  }
  /// Of all that were added, in order; there is one at least.
  const State& take() {
    while (count_ > 1) merge();
    count_ = 0;
    return runs_[0].state;
  }

 private:
  struct Run {
    std::int64_t leaves;
    State state;
  };

  void merge() {
    --count_;
    combine_.sk_combine(runs_[count_ - 1].state, runs_[count_].state);
    runs_[count_ - 1].leaves += runs_[count_].leaves;
  }

  Combine& combine_;
  Run runs_[48];  // of more leaves than memory holds
  int count_ = 0;
};

/// How many accumulators have so many bytes, in a power of 2.
template <class State>
constexpr int columnsIn(std::size_t bytes, std::size_t least, std::size_t most) {
  return static_cast<int>(std::bit_floor(std::clamp(bytes / footprintOf<State>().bytes, least, most)));
}

/// Accumulators side by side, an array for each of their scalars, so that neighbours are folded in one operation.
template <class State, int most>
class Columns {
 public:
  State load(int k) const {
    State state{};
    std::size_t at = 0;
    visit(state, [&]<class S>(S& scalar) { scalar = static_cast<S>(array<S>(at)[k]); });
    return state;
  }
  void store(int k, State state) {
    std::size_t at = 0;
    visit(state, [&]<class S>(S& scalar) { array<S>(at)[k] = static_cast<Stored<S>>(scalar); });
  }

  /// The columns of the only scalar, or of the first.
  template <class S>
  S* first() {
    return reinterpret_cast<S*>(bytes_);
  }

 private:
  template <class S>
  using Stored = typename StoredOf<S>::Type;

  template <class S>
  Stored<S>* array(std::size_t& at) {
    auto* const first = reinterpret_cast<Stored<S>*>(bytes_ + at);
    at += most * sizeof(Stored<S>);
    return first;
  }
  template <class S>
  const Stored<S>* array(std::size_t& at) const {
    auto* const first = reinterpret_cast<const Stored<S>*>(bytes_ + at);
    at += most * sizeof(Stored<S>);
    return first;
  }

  alignas(64) std::byte bytes_[most * footprintOf<State>().bytes];
};

/// Columns from 0 on are combined with `count` others from `first` on, which come later.
template <class Combine, class State, int most>
void combineColumns(const Combine& combine, Columns<State, most>& columns, const Columns<State, most>& others,
                    int first, int count) {
  Combine here = combine;  // which nothing that is stored can change
  SK_NATIVE_INDEPENDENT
  for (int k = 0; k < count; ++k) {
    State state = columns.load(k);
    here.sk_combine(state, others.load(first + k));
    columns.store(k, state);
  }
}

/// What Runs are, of columns; of so many leaves at most.
template <class Combine, class State, int most, int leaves>
class ColumnRuns {
 public:
  explicit ColumnRuns(const Combine& combine) : combine_(combine) {}

  bool isEmpty() const { return count_ == 0; }
  /// Where the next leaf is to be stored,
  Columns<State, most>& next() { return runs_[count_]; }
  /// and that it is there.
  void add() {
    leaves_[count_++] = 1;
    while (count_ > 1 && leaves_[count_ - 2] == leaves_[count_ - 1]) merge();
  }
  /// Of all that were added; there is one at least.
  Columns<State, most>& take() {
    while (count_ > 1) merge();
    count_ = 0;
    return runs_[0];
  }

 private:
  static constexpr int deepest = std::bit_width(static_cast<unsigned>(leaves)) + 1;

  void merge() {
    --count_;
    combineColumns(combine_, runs_[count_ - 1], runs_[count_], 0, most);
    leaves_[count_ - 1] += leaves_[count_];
  }

  const Combine& combine_;
  Columns<State, most> runs_[deepest];
  int leaves_[deepest];
  int count_ = 0;
};

/// A run of one element, the current one.
template <class Fold>
typename Fold::sk_State started(Fold& fold) {
  if constexpr (Fold::sk_isSeeded) {
    return fold.sk_seed();
  } else {
    typename Fold::sk_State state = fold.sk_identity();
    fold.sk_fold(state);
    return state;
  }
}

}  // namespace sk::native
