// SPDX-License-Identifier: MIT
//
// The loops around native code. A kernel is a struct made from a Call; its members sk_index and sk_extent are the
// current element's index and the domain's shape, and sk_element() computes that element. A reduction has
// instead, for a State, which is a tuple of its accumulators:
//
//   State sk_identity()             where a run of elements starts (not of a seeded one)
//   State sk_seed()                 the current element as accumulators (of a seeded one)
//   void sk_fold(State&)            folds the current element
//   void sk_combine(State&, State)  folds the accumulators of a later run; of the kernel that combines
//   void sk_store(State)            writes the results, at sk_index
#pragma once

#include <utility>
#include <vector>

#include "sk/native/streams.hpp"

namespace sk::native {

/// visit(index) for every index from `begin` to `end`, row-major.
template <class Visit>
void forEachIndex(const Extents& begin, const Extents& end, Visit&& visit) {
  Index index;
  for (std::int64_t w = begin[3]; w < end[3]; ++w) {
    for (std::int64_t z = begin[2]; z < end[2]; ++z) {
      for (std::int64_t y = begin[1]; y < end[1]; ++y) {
        for (std::int64_t x = begin[0]; x < end[0]; ++x) {
          index = Index(Int(x), Int(y), Int(z), Int(w));
          visit(index);
        }
      }
    }
  }
}

template <class Kernel>
void runKernel(const Call& call) {
  Kernel kernel(call);
  kernel.sk_extent = toIndex(call.domain);
  forEachIndex({}, call.domain, [&](const Index& index) {
    kernel.sk_index = index;
    kernel.sk_element();
  });
}

/// Results of runs of elements, each with how many leaves it is made of; two of equal size become one. So a
/// sum of n elements has an error of some log n roundings, not n.
template <class Combine, class State>
class Runs {
 public:
  explicit Runs(Combine& combine) : combine_(combine) {}

  void add(State&& state) {
    std::size_t leaves = 1;
    while (!runs_.empty() && runs_.back().leaves == leaves) {
      combine_.sk_combine(runs_.back().state, state);
      state = std::move(runs_.back().state);
      runs_.pop_back();
      leaves *= 2;
    }
    runs_.push_back({leaves, std::move(state)});
  }
  /// Of all that were added, in order.
  State take() {
    State last = std::move(runs_.back().state);
    runs_.pop_back();
    while (!runs_.empty()) {
      combine_.sk_combine(runs_.back().state, last);
      last = std::move(runs_.back().state);
      runs_.pop_back();
    }
    return last;
  }

 private:
  struct Run {
    std::size_t leaves;
    State state;
  };
  Combine& combine_;
  std::vector<Run> runs_;
};

/// Folds the elements of a block; there is one at least, or an identity.
template <class Fold, class Combine>
auto foldBlock(Fold& fold, Combine& combine, const Extents& begin, const Extents& end) {
  using State = typename Fold::sk_State;
  constexpr int leaf = 16;  // elements that are folded one after the other; program::longestRun at most
  Runs<Combine, State> runs(combine);
  State state{};
  int count = 0;
  forEachIndex(begin, end, [&](const Index& index) {
    fold.sk_index = index;
    if (count == 0) {
      if constexpr (Fold::sk_isSeeded) {
        state = fold.sk_seed();
      } else {
        state = fold.sk_identity();
        fold.sk_fold(state);
      }
    } else {
      fold.sk_fold(state);
    }
    if (++count == leaf) {
      runs.add(std::move(state));
      count = 0;
    }
  });
  if (count > 0) runs.add(std::move(state));
  return runs.take();
}

/// Each block of the domain to one element of the results. No block is empty.
template <class Fold, class Combine>
void runReduction(const ReduceCall& call) {
  Fold fold(call.fold);
  fold.sk_extent = toIndex(call.fold.domain);
  Combine combine(call.combine);
  Extents blocks;
  for (std::size_t d = 0; d < 4; ++d) blocks[d] = call.fold.domain[d] / call.block[d];
  forEachIndex({}, blocks, [&](const Index& at) {
    Extents begin;
    Extents end;
    for (std::size_t d = 0; d < 4; ++d) {
      begin[d] = at.components[d].word() * call.block[d];
      end[d] = begin[d] + call.block[d];
    }
    const typename Fold::sk_State state = foldBlock(fold, combine, begin, end);
    fold.sk_store(at, state);
  });
}

/// Where there is no element: the identities, to the one element of the results.
template <class Fold>
void storeIdentity(const ReduceCall& call) {
  Fold fold(call.fold);
  fold.sk_store(Index(Int(0)), fold.sk_identity());
}

}  // namespace sk::native
