// SPDX-License-Identifier: MIT
//
// What reductions in native code are put together from: runs of elements that have been folded, and accumulators side by side.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "sk/native/element.hpp"

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

/// Accumulators side by side, an array for each of their scalars, so that neighbours are folded in one operation.
template <class State>
class Columns {
 public:
  /// As many as stay in the nearest cache beside the elements.
  static constexpr int most =
      static_cast<int>(std::bit_floor(std::clamp<std::size_t>(2048 / footprintOf<State>().bytes, 32, 512)));

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
