// SPDX-License-Identifier: MIT
//
// Gathers in native code: streams that are read anywhere.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "sk/native/lanes_intrinsics.hpp"
#include "sk/native/lanes_memory.hpp"
#include "sk/native/math.hpp"
#include "sk/native/parallel.hpp"
#include "sk/native/streams.hpp"

namespace sk::native {

enum class Boundary : std::uint8_t { Clamp, Wrap, Mirror, Border };

/// The index inside for one that may be outside; not of Border.
template <Boundary boundary>
std::int64_t brought(std::int64_t i, std::int64_t n) {
  if constexpr (boundary == Boundary::Clamp) {
    return std::clamp<std::int64_t>(i, 0, n - 1);
  } else {
    if (static_cast<std::uint64_t>(i) < static_cast<std::uint64_t>(n)) return i;
    const std::int64_t period = boundary == Boundary::Mirror ? 2 * n : n;
    const std::int64_t inside = (i % period + period) % period;
    return inside < n ? inside : period - 1 - inside;
  }
}

/// `T a[]` of rank N. `reach` is the most that near() is asked for, in either direction, -1 where that is not known or much; where
/// `isInside`, no element asks for what lies before or behind its row, nor for a row that has borders.
template <class T, std::size_t N, Boundary boundary, int reach = -1, bool isInside = false>
class Gather : public StreamParameter {
 public:
  using Position = typename IndexOfRank<N>::Type;

  Gather(const Call& call, std::size_t parameter, const T& border = T{})
      : StreamParameter(call, parameter), border_(border), first_(operand().first) {
    std::copy(operand().components.begin(), operand().components.end(), arrays_);
    std::copy_n(operand().extent.begin(), N, extent_);
    std::copy_n(operand().stride.begin(), N, stride_);
    std::int64_t last = 0;
    for (std::size_t d = 0; d < N; ++d) last += (extent_[d] - 1) * stride_[d];
    isSmall_ = isGiven() && last <= std::numeric_limits<std::int32_t>::max();
  }

  bool isDirect() const { return true; }
  void place(const Chunk& chunk) {
    here_ = chunk.first;
    if constexpr (reach >= 0) {
      for (std::size_t d = 1; d < N; ++d) {
        for (int offset = -reach; offset <= reach; ++offset) rows_[d][offset + reach] = rowAt(d, offset);
      }
    }
  }
  /// The part of the row of the domain that `first` is in where near() stays in rows, and finds no border.
  void narrow(Range& inside, const Extents& first) const {
    inside.begin = std::max<std::int64_t>(inside.begin, reach);
    inside.end = std::min(inside.end, extent_[0] - reach);
    if constexpr (boundary == Boundary::Border) {
      for (std::size_t d = 1; d < N; ++d) {
        if (first[d] < reach || first[d] + reach >= extent_[d]) inside.end = inside.begin;
      }
    }
  }

  T at(const Position& position) const {
    Extents index{};
    for (std::size_t d = 0; d < N; ++d) index[d] = componentAt(position, d).word();
    return element(index);
  }
  /// At an index for each lane: Int or Lanes<Int> for each dimension, or a vector of them.
  template <class... Places>
    requires(sizeof...(Places) == N && (isLanes<Places> || ...))
  LanesOf<T> lanesAt(const Places&... places) const {
    if (!isSmall_) {
      if (!isGiven()) return spread(T{});
      return laneByLane([&](auto... index) { return at(Position(index...)); }, places...);
    }
    Numbers numbers{first_, false, Int(0), Mask(false)};
    std::size_t d = 0;
    (add(numbers, d++, places), ...);
    if (numbers.areAllOutside) return spread(border_);
    const LanesOf<T> value = loadAnywhere<T>(arrays_, numbers.first, numbers.further);
    if constexpr (boundary == Boundary::Border) {
      return select(numbers.areOutside, spread(border_), value);
    } else {
      return value;
    }
  }
  /// At an index, and at those that follow it along x.
  template <class... Others>
    requires(sizeof...(Others) + 1 == N)
  LanesOf<T> lanesFrom(Int x, Others... others) const {
    if (!isGiven()) return spread(T{});
    if (x.word() < 0 || x.word() + std::int64_t{laneCount} > extent_[0]) {
      return laneByLane([&](Int lane) { return at(Position(x + lane, others...)); }, laneNumbers());
    }
    Numbers numbers{first_ + x.word(), false, Int(0), Mask(false)};
    std::size_t d = 1;
    (add(numbers, d++, others), ...);
    return numbers.areAllOutside ? spread(border_) : loadNeighbours<T>(arrays_, numbers.first);
  }
  LanesOf<T> lanesAt(const Vec<Lanes<Int>, N>& place) const {
    return [&]<std::size_t... D>(std::index_sequence<D...>) {
      return lanesAt(place.components[D]...);
    }(std::make_index_sequence<N>());
  }

  /// At an offset from element i of the chunk.
  T near(int i, const Position& offset) const {
    if constexpr (reach >= 0) {
      return inRow(i, offset);
    } else {
      Extents index{};
      for (std::size_t d = 0; d < N; ++d) index[d] = here_[d] + componentAt(offset, d).word();
      index[0] += i;
      return element(index);
    }
  }

  /// At an offset from element i and those that follow it.
  LanesOf<T> lanesNear(int i, const Position& offset) const {
    const Row row = rowOf(offset);
    if (row.isOutside) return spread(border_);
    const std::int64_t x = here_[0] + componentAt(offset, 0).word() + i;
    if (x >= 0 && x + laneCount <= extent_[0]) return loadNeighbours<T>(arrays_, first_ + row.first + x);
    return laneByLane([&](Int lane) { return near(i + lane.word(), offset); }, laneNumbers());
  }

  /// Linear interpolation in the carrier of T; a neighbour of no weight is not looked at.
  template <class Carrier, class Place>
  Carrier sample(const Place& place) const {
    using Real = Component<Place>;
    Extents low{};
    Real weights[N];
    for (std::size_t d = 0; d < N; ++d) {
      const Real x = componentAt(place, d);
      const Real whole = Math<Real>::floor(x);
      low[d] = wholeIndex(whole).word();
      weights[d] = Math<Real>::fabs(x) >= Real(16777216) ? Real(0) : x - whole;  // infinity has none
    }
    return weighted<Carrier, Real, N>(low, weights);
  }

 private:
  /// Neighbours in other rows, which are all the same way off for the whole chunk.
  struct Row {
    std::int64_t first;  ///< of their elements, as far as this dimension is concerned
    bool isOutside;  ///< of Border
  };

  Row rowAt(std::size_t d, int offset) const {
    const std::int64_t i = here_[d] + offset;
    const std::int64_t n = extent_[d];
    if constexpr (boundary == Boundary::Border) {
      const bool isOutside = i < 0 || i >= n;
      return {isOutside ? 0 : i * stride_[d], isOutside};
    } else {
      return {brought<boundary>(i, n) * stride_[d], false};
    }
  }

  /// Of all dimensions but the first, for lanes; inRow() adds them up itself, or GCC 12 would not vectorise it.
  Row rowOf(const Position& offset) const {
    Row whole{0, false};
    for (std::size_t d = 1; d < N; ++d) {
      const int away = componentAt(offset, d).word();
      const Row row = reach >= 0 ? rows_[d][away + reach] : rowAt(d, away);
      whole.first += row.first;
      whole.isOutside = whole.isOutside || row.isOutside;
    }
    return whole;
  }

  T inRow(int i, const Position& offset) const {
    std::int64_t first = first_;
    bool isOutside = false;
    for (std::size_t d = 1; d < N; ++d) {
      const Row& row = rows_[d][componentAt(offset, d).word() + reach];
      first += row.first;
      isOutside = isOutside || row.isOutside;
    }
    std::int64_t x = here_[0] + componentAt(offset, 0).word() + i;
    if constexpr (!isInside && boundary == Boundary::Border) {
      if (x < 0 || x >= extent_[0]) return border_;
    } else if constexpr (!isInside) {
      x = brought<boundary>(x, extent_[0]);
    }
    const T value = load<T>(arrays_, first + x);
    if constexpr (!isInside && boundary == Boundary::Border) {
      return isOutside ? border_ : value;
    } else {
      return value;
    }
  }

  /// Which elements lanes ask for: those that are `further` on than `first`, or the border.
  struct Numbers {
    std::int64_t first;
    bool areAllOutside;
    Lanes<Int> further;
    Mask areOutside;
  };

  /// One dimension's part.
  void add(Numbers& numbers, std::size_t d, Int place) const {
    const std::int64_t i = place.word();
    if constexpr (boundary == Boundary::Border) {
      if (i < 0 || i >= extent_[d]) {
        numbers.areAllOutside = true;
      } else {
        numbers.first += i * stride_[d];
      }
    } else {
      numbers.first += brought<boundary>(i, extent_[d]) * stride_[d];
    }
  }
  void add(Numbers& numbers, std::size_t d, const Lanes<Int>& place) const {
    const Int last(extent_[d] - 1);
    Lanes<Int> i = place;
    if constexpr (boundary == Boundary::Clamp) {
      i = minOf(maxOf(place, Lanes<Int>(Int(0))), Lanes<Int>(last));
    } else {
      const Mask areWithin = (place >= Int(0)) & (place <= last);
      if constexpr (boundary == Boundary::Border) {
        numbers.areOutside = numbers.areOutside | !areWithin;
        i = select(areWithin, place, Lanes<Int>(Int(0)));
      } else if (!all(areWithin)) {
        i = laneByLane([&](Int lane) { return Int(brought<boundary>(lane.word(), extent_[d])); }, place);
      }
    }
    numbers.further = numbers.further + (d == 0 ? i : i * Int(stride_[d]));
  }

  T element(Extents index) const {
    std::int64_t number = first_;
    for (std::size_t d = 0; d < N; ++d) {
      if constexpr (boundary == Boundary::Border) {
        if (index[d] < 0 || index[d] >= extent_[d]) return border_;
      } else {
        index[d] = brought<boundary>(index[d], extent_[d]);
      }
      number += index[d] * stride_[d];
    }
    return load<T>(arrays_, number);
  }

  template <class Carrier, class Real, std::size_t D>
  Carrier weighted(const Extents& at, const Real* weights) const {
    if constexpr (D == 0) {
      return convert<Carrier>(element(at));
    } else {
      Extents next = at;
      ++next[D - 1];
      const Real t = weights[D - 1];
      if (t <= Real(0)) return weighted<Carrier, Real, D - 1>(at, weights);
      if (t >= Real(1)) return weighted<Carrier, Real, D - 1>(next, weights);
      return weighted<Carrier, Real, D - 1>(at, weights) * (Real(1) - t) +
             weighted<Carrier, Real, D - 1>(next, weights) * t;
    }
  }

  T border_;
  void* arrays_[footprintOf<T>().scalars]{};
  std::int64_t first_;
  std::int64_t extent_[N];
  std::int64_t stride_[N];
  bool isSmall_;  ///< 32 bits number its elements
  Extents here_{};  ///< the chunk's first element
  Row rows_[N][reach < 0 ? 1 : 2 * reach + 1]{};
};

}  // namespace sk::native
