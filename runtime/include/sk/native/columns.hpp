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
  /// As by =, but a compiler that keeps them in registers goes on to do so.
  void copy(const Columns& other) {
    SK_NATIVE_INDEPENDENT
    for (int k = 0; k < most; ++k) store(k, other.load(k));
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

/// What Runs are, of columns whose leaves come in any order; `leaves` at most.
template <class Combine, class State, int most, int leaves>
class ColumnRuns {
 public:
  explicit ColumnRuns(const Call& call) : combine_(call) {}

  bool isEmpty() const { return count_ == 0; }
  /// Adds a leaf, and leaves something else in its place.
  void add(Columns<State, most>& leaf) {
    int level = 0;
    for (; (count_ >> level & 1) != 0; ++level) combine(leaf, levels_[level]);
    levels_[level].copy(leaf);
    ++count_;
  }
  /// Of all that were added; there is one at least.
  Columns<State, most>& take() {
    int level = std::countr_zero(count_);
    for (int larger = level + 1; count_ >> larger != 0; ++larger) {
      if ((count_ >> larger & 1) == 0) continue;
      combine(levels_[larger], levels_[level]);
      level = larger;
    }
    count_ = 0;
    return levels_[level];
  }

 private:
  void combine(Columns<State, most>& columns, const Columns<State, most>& others) {
    Combine here = combine_;  // which nothing that is stored can change
    SK_NATIVE_INDEPENDENT
    for (int k = 0; k < most; ++k) {
      State state = columns.load(k);
      here.sk_combine(state, others.load(k));
      columns.store(k, state);
    }
  }

  Combine combine_;
  Columns<State, most> levels_[std::bit_width(static_cast<unsigned>(leaves))];
  unsigned count_ = 0;  ///< whose bits tell which of the levels hold a run: of 2^level leaves
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
