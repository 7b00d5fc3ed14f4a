// SPDX-License-Identifier: MIT
//
// The loops around reductions in native code. Such a kernel has, beside what run.hpp asks of all but sk_element(), for a State, which is
// a tuple of its accumulators:
//
//   State sk_identity()             where a run of elements starts (not of a seeded one)
//   State sk_seed()                 the current element as accumulators (of a seeded one)
//   void sk_fold(State&)            folds the current element
//   void sk_combine(State&, State)  folds the accumulators of a later run; of the kernel that combines
//   void sk_store(Index, State)     writes the results
//   bool sk_isCommutative           runs may be combined in any order
//
// One that only sums floats, or products of two, tells which by sk_term(), and has, for doubles (sk_sumsFloats), a form that
// reads floats (sk_readsFloats), sk_OfFloats; or it sums them exactly (sk_sumsExactly).
//
// A block of the domain is divided into pieces, which are folded by themselves and then combined in order. What a piece is does not
// depend on how many threads there are, and so neither do the results.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "sk/native/columns.hpp"
#include "sk/native/exact_terms.hpp"
#include "sk/native/fold_narrow.hpp"
#include "sk/native/hot.hpp"
#include "sk/native/run.hpp"
#include "sk/native/term_sums.hpp"

namespace sk::native {

/// How the blocks of a reduction's domain are divided: into whole rows, or parts of one.
class FoldPieces {
 public:
  /// Elements of one.
  static constexpr std::int64_t most = 1 << 14;

  explicit FoldPieces(const ReduceCall& call) : block_(call.block) {
    for (std::size_t d = 0; d < 4; ++d) blocks_[d] = call.fold.domain[d] / block_[d];
    rows_ = block_[1] * block_[2] * block_[3];
    width_ = std::min(block_[0], most);
    perRow_ = (block_[0] + width_ - 1) / width_;
    height_ = perRow_ > 1 ? 1 : std::min(most / width_, rows_);
  }

  std::int64_t ofBlock() const { return perRow_ * ((rows_ + height_ - 1) / height_); }
  std::int64_t count() const { return ofBlock() * blocks_[0] * blocks_[1] * blocks_[2] * blocks_[3]; }
  std::int64_t elementsOfOne() const { return width_ * height_; }
  Extents blockAt(std::int64_t number) const {
    Extents at;
    for (std::size_t d = 0; d < 4; ++d) {
      at[d] = number % blocks_[d];
      number /= blocks_[d];
    }
    return at;
  }

  /// visit(first, count) for the rows of a piece.
  template <class Visit>
  void forEachRow(const Extents& block, std::int64_t piece, Visit&& visit) const {
    const std::int64_t row = piece / perRow_ * height_;
    const std::int64_t x = piece % perRow_ * width_;
    const std::int64_t rows = std::min(height_, rows_ - row);
    Extents in{x, row % block_[1], row / block_[1] % block_[2], row / block_[1] / block_[2]};
    for (std::int64_t k = 0; k < rows; ++k) {
      Extents first;
      for (std::size_t d = 0; d < 4; ++d) first[d] = block[d] * block_[d] + in[d];
      visit(first, static_cast<int>(std::min(width_, block_[0] - x)));
      for (std::size_t d = 1; d < 4 && ++in[d] == block_[d]; ++d) in[d] = 0;
    }
  }

 private:
  Extents block_;
  Extents blocks_;
  std::int64_t rows_;  ///< of a block
  std::int64_t width_;  ///< of a piece
  std::int64_t perRow_;
  std::int64_t height_;  ///< rows of a piece
};

/// Whether a kernel has a form that reads floats and sums in doubles.
template <class Fold>
concept SumsFloats = requires { requires Fold::sk_sumsFloats; };

/// Folds pieces of blocks, one after the other.
template <class Fold, class Combine>
class PieceFolder {
 public:
  using State = typename Fold::sk_State;

  explicit PieceFolder(const ReduceCall& call)
      : pieces_(call),
        fold_(call.fold),
        combine_(call.combine),
        runs_(combine_),
        longest_(longestChunk(fold_)),
        columnRuns_(combine_) {
    fold_.sk_extent = toIndex(call.fold.domain);
  }

  /// Of the block that is there. It has one element at least.
  const State& fold(const Extents& block, std::int64_t piece) {
    pieces_.forEachRow(block, piece, [&](Extents first, int count) {
      while (count > 0) {
        const int now = std::min(count, longest_);
        place(fold_, {first, now, scratch_});
        if constexpr (Fold::sk_isCommutative) {
          foldColumns(static_cast<std::int32_t>(first[0]), now);
        } else {
          foldInOrder(static_cast<std::int32_t>(first[0]), now);
        }
        first[0] += now;
        count -= now;
      }
    });
    if constexpr (Fold::sk_isCommutative) endColumns();
    if (folded_ > 0) endLeaf();
    return runs_.take();
  }
  void store(const Extents& block, const State& state) { fold_.sk_store(toIndex(block), state); }

 private:
  // ---- in any order: each column folds every so many-th element -----------------------------------

  /// As many columns as stay in registers.
  static constexpr int side = columnsIn<State>(256, 16, 64);
  using Side = Columns<State, side>;

  void foldColumns(std::int32_t x, int count) {
    int first = 0;
    while (count - first >= side) {
      const int rounds = std::min((count - first) / side, leaf);
      foldRounds(x, first, rounds);
      first += rounds * side;
    }
    if (first < count) foldRest(x, first, count - first);
  }

  /// So many elements for each column, which are a leaf. It is folded in columns that nobody else sees, so that they stay in registers.
  void foldRounds(std::int32_t x, int first, int rounds) {
    Fold here = fold_;  // which nothing that is stored can change
    Side& folded = columnRuns_.next();
    if constexpr (SumsTerm<Fold>) {
      const double start = Fold::sk_isSeeded ? -0.0 : std::get<0>(here.sk_identity());
      std::apply(
          [&](auto&... factor) {
            sumTerms<side>(folded.template first<double>(), start, rounds, factor.floats(first)...);
          },
          here.sk_term());
    } else if (rounds == 1) {
      startColumns(here, x, first, folded);
    } else {
      Side columns;
      startColumns(here, x, first, columns);
      for (int round = 1; round < rounds - 1; ++round) foldRound(here, x, first += side, columns, columns);
      foldRound(here, x, first + side, columns, folded);
    }
    columnRuns_.add();
  }
  static void startColumns(Fold& here, std::int32_t x, int first, Side& columns) {
    SK_NATIVE_INDEPENDENT
    for (int k = 0; k < side; ++k) {
      moveTo(here, x, first + k);
      columns.store(k, started(here));
    }
  }
  static void foldRound(Fold& here, std::int32_t x, int first, const Side& columns, Side& results) {
    SK_NATIVE_INDEPENDENT
    for (int k = 0; k < side; ++k) {
      moveTo(here, x, first + k);
      State state = columns.load(k);
      here.sk_fold(state);
      results.store(k, state);
    }
  }

  /// What is left of a row: an element for some of the columns. Those of several rows are a leaf.
  void foldRest(std::int32_t x, int first, int count) {
    Fold here = fold_;
    const int begun = std::min(count, restUsed_);
    SK_NATIVE_INDEPENDENT
    for (int k = 0; k < begun; ++k) {
      moveTo(here, x, first + k);
      State state = rest_.load(k);
      here.sk_fold(state);
      rest_.store(k, state);
    }
    SK_NATIVE_INDEPENDENT
    for (int k = begun; k < count; ++k) {
      moveTo(here, x, first + k);
      rest_.store(k, started(here));
    }
    restUsed_ = std::max(restUsed_, count);
    if (++folded_ == leaf) endLeaf();
  }

  /// Columns become one.
  State gathered(Side& columns, int count) {
    while (count > 1) {
      const int half = (count + 1) / 2;
      combineColumns(combine_, columns, columns, half, count - half);
      count = half;
    }
    return columns.load(0);
  }

  /// Whole columns become one, with what is left of rows. If there are none, that is a leaf.
  void endColumns() {
    if (columnRuns_.isEmpty()) return;
    Side& columns = columnRuns_.take();
    combineColumns(combine_, columns, rest_, 0, restUsed_);
    runs_.add(gathered(columns, side));
    restUsed_ = folded_ = 0;
  }

  // ---- in order ----------------------------------------------------------------------------------

  void foldInOrder(std::int32_t x, int count) {
    Fold here = fold_;
    for (int i = 0; i < count;) {
      const int end = std::min(count, i + leaf - folded_);
      folded_ += end - i;
      State state = state_;
      if (folded_ == end - i) {
        moveTo(here, x, i++);
        state = started(here);
      }
      for (; i < end; ++i) {
        moveTo(here, x, i);
        here.sk_fold(state);
      }
      state_ = state;
      if (folded_ == leaf) endLeaf();
    }
  }

  // Seldom enough called to be compiled once, and not in each clone.
  [[gnu::noinline]] void endLeaf() {
    folded_ = 0;
    if constexpr (Fold::sk_isCommutative) {
      runs_.add(gathered(rest_, restUsed_));
      restUsed_ = 0;
    } else {
      runs_.add(state_);
    }
  }

  FoldPieces pieces_;
  Fold fold_;
  Combine combine_;
  Runs<Combine, State> runs_;
  int longest_;
  Scratch scratch_;
  int folded_ = 0;  ///< elements of the leaf so far, in order, or of what is left of rows, in each column
  State state_{};  ///< of those in order
  Side rest_;  ///< of what is left of rows
  int restUsed_ = 0;
  ColumnRuns<Combine, State, side, FoldPieces::most / side> columnRuns_;
};

/// Folds groups of narrow blocks, and stores their results. It waits for memory, and is compiled once, not in each clone.
template <class Fold, class Combine>
[[gnu::noinline]] void foldNarrow(const ReduceCall& call, Range range) {
  NarrowFolder<Fold, Combine> folder(call);
  const NarrowGroups groups(call, folder.most);
  for (std::int64_t group = range.begin; group < range.end; ++group) {
    const Extents first = groups.firstOf(group);
    folder.fold(first, groups.lengthFrom(first));
  }
}

/// Folds pieces. The results of those that are whole blocks are stored; of others, they go to states[piece].
template <class Fold, class Combine>
void foldPieces(const ReduceCall& call, Range range, typename Fold::sk_State* states) {
  PieceFolder<Fold, Combine> folder(call);
  const FoldPieces pieces(call);
  const std::int64_t ofBlock = pieces.ofBlock();
  for (std::int64_t piece = range.begin; piece < range.end; ++piece) {
    const Extents block = pieces.blockAt(piece / ofBlock);
    const auto& state = folder.fold(block, piece % ofBlock);
    if (states != nullptr) {
      states[piece] = state;
    } else {
      folder.store(block, state);
    }
  }
}

template <class Fold, class Combine>
SK_NATIVE_WIDE void foldPiecesOfFloats(const ReduceCall& call, Range range, typename Fold::sk_State* states) {
  foldPieces<Fold, Combine>(call, range, states);
}

/// The same of a kernel that sums its term exactly, whose streams lie as the domain does.
template <class Fold, class Combine>
void sumPiecesExactly(const ReduceCall& call, Range range, typename Fold::sk_State* states) {
  const FoldPieces pieces(call);
  const std::int64_t ofBlock = pieces.ofBlock();
  Fold fold(call.fold);
  fold.sk_extent = toIndex(call.fold.domain);
  Scratch scratch;
  for (std::int64_t piece = range.begin; piece < range.end; ++piece) {
    const Extents block = pieces.blockAt(piece / ofBlock);
    ExactTerms<std::tuple_size_v<decltype(fold.sk_term())>> sum;
    pieces.forEachRow(block, piece % ofBlock, [&](const Extents& first, int count) {
      place(fold, {first, count, scratch});
      std::apply([&](auto&... factor) { sum.add(count, factor.floats(0)...); }, fold.sk_term());
    });
    const auto state = sum.template state<typename Fold::sk_State>();
    if (states != nullptr) {
      states[piece] = state;
    } else {
      fold.sk_store(toIndex(block), state);
    }
  }
}

/// How pieces are folded: by `hot`, unless the streams lie so that the form of doubles can read floats.
template <class Fold, class Combine, auto hot>
auto pieceFolding(const ReduceCall& call) {
  void (*folding)(const ReduceCall&, Range, typename Fold::sk_State*) = hot;
  if constexpr (SK_NATIVE_FUSES && SumsFloats<Fold>) {
    typename Fold::sk_OfFloats ofFloats(call.fold);
    if (isWide() && isDirect(ofFloats)) folding = &foldPiecesOfFloats<typename Fold::sk_OfFloats, Combine>;
  } else if constexpr (SumsExactly<Fold>) {
    Fold fold(call.fold);
    if (isWide() && isDirect(fold)) folding = &sumPiecesExactly<Fold, Combine>;
  }
  return folding;
}

/// Each block of the domain to one element of the results; `hot` is foldPieces. No block is empty.
template <class Fold, class Combine, auto hot>
void runReduction(const ReduceCall& call) {
  using State = typename Fold::sk_State;
  constexpr Deal deal = Fold::sk_isUneven ? Deal::AsTheyCome : Deal::Evenly;
  if constexpr (NarrowGroups::isFew<State>) {
    if (NarrowGroups::isNarrow(call)) {
      const NarrowGroups groups(call, NarrowFolder<Fold, Combine>::most);
      inParallel(groups.count(), groups.elementsOfOne(), deal,
                 [&](Range range) { foldNarrow<Fold, Combine>(call, range); });
      return;
    }
  }
  const FoldPieces pieces(call);
  const std::int64_t ofBlock = pieces.ofBlock();
  std::vector<State> states(static_cast<std::size_t>(ofBlock == 1 ? 0 : pieces.count()));
  State* const results = ofBlock == 1 ? nullptr : states.data();
  const auto folding = pieceFolding<Fold, Combine, hot>(call);
  inParallel(pieces.count(), pieces.elementsOfOne(), deal,
             [&](Range range) { folding(call, range, results); });
  if (results == nullptr) return;
  const Fold fold(call.fold);
  Combine combine(call.combine);
  Runs<Combine, State> runs(combine);
  for (std::int64_t piece = 0; piece < pieces.count(); ++piece) {
    runs.add(states[static_cast<std::size_t>(piece)]);
    if ((piece + 1) % ofBlock == 0) fold.sk_store(toIndex(pieces.blockAt(piece / ofBlock)), runs.take());
  }
}

/// Where there is no element: the identities, to the one element of the results.
template <class Fold>
void storeIdentity(const ReduceCall& call) {
  Fold fold(call.fold);
  fold.sk_store(Index(Int(0)), fold.sk_identity());
}

}  // namespace sk::native
