// SPDX-License-Identifier: MIT
//
// The loops around kernels in native code (fold.hpp has those around reductions). A kernel is a struct made from a Call, with
//
//   Index sk_index, sk_extent     the current element's index, and the domain's shape
//   int sk_i                      its number in the chunk
//   auto sk_streams()             references to the parameters that are placed at a chunk
//   void sk_element()             computes the current element
//   bool sk_isOrdered             elements are computed one after the other: it pushes or scatters
//   bool sk_isUneven              elements may take very different times: it has loops
//
// It may have sk_lanes(), which computes the current element and those that follow it, laneCount together; then sk_hasLanes says for which
// real type. It may have a second form, sk_Inside, which knows that no neighbour lies outside of its row, and that none is a border. Rows are
// divided into pieces, which threads share out among them.
#pragma once

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "sk/native/gather.hpp"
#include "sk/native/hot.hpp"
#include "sk/native/lanes.hpp"
#include "sk/native/streams.hpp"

namespace sk::native {

/// The rows of a domain in pieces of elements that are neighbours.
class Pieces {
 public:
  /// Of kernels with loops, an element may take as long as a thousand others, so that a few are enough for a piece.
  Pieces(const Extents& domain, bool areUneven)
      : domain_(domain),
        longest_(areUneven ? 1 << 6 : 1 << 13),
        perRow_((domain[0] + longest_ - 1) / longest_) {}

  std::int64_t count() const { return perRow_ * domain_[1] * domain_[2] * domain_[3]; }
  std::int64_t elementsOfOne() const { return std::min(domain_[0], longest_); }

  /// visit(first, count) for the elements of these pieces, as many neighbours at a time as `most` allows.
  template <class Visit>
  void forEachChunk(Range pieces, int most, Visit&& visit) const {
    Extents at = firstOf(pieces.begin);
    for (std::int64_t left = pieces.end - pieces.begin; left > 0;) {
      const std::int64_t end = std::min(domain_[0], at[0] + left * longest_);
      left -= (end - at[0] + longest_ - 1) / longest_;
      while (at[0] < end) {
        const auto count = static_cast<int>(std::min<std::int64_t>(end - at[0], most));
        visit(at, count);
        at[0] += count;
      }
      at[0] = 0;
      for (std::size_t d = 1; d < 4 && ++at[d] == domain_[d]; ++d) at[d] = 0;
    }
  }

 private:
  Extents firstOf(std::int64_t piece) const {
    const std::int64_t row = piece / perRow_;
    return {piece % perRow_ * longest_, row % domain_[1], row / domain_[1] % domain_[2],
            row / domain_[1] / domain_[2]};
  }

  Extents domain_;
  std::int64_t longest_;
  std::int64_t perRow_;
};

template <class Kernel>
bool isDirect(Kernel& kernel) {
  return std::apply([](auto&... stream) { return (stream.isDirect() && ...); }, kernel.sk_streams());
}
template <class Kernel>
void place(Kernel& kernel, const Chunk& chunk) {
  chunk.scratch.restart();
  std::apply([&](auto&... stream) { (stream.place(chunk), ...); }, kernel.sk_streams());
  kernel.sk_index = toIndex(chunk.first);
}

/// How long a chunk may be.
template <class Kernel>
int longestChunk(Kernel& kernel) {
  return isDirect(kernel) ? std::numeric_limits<int>::max() : laidOut;
}

/// From here on, element i of the chunk is the current one.
template <class Kernel>
void moveTo(Kernel& kernel, std::int32_t x, int i) {
  kernel.sk_i = i;
  kernel.sk_index.components[0] = Int(x + i);
}

/// How elements are computed.
enum class By : std::uint8_t { Element, Lanes };

/// Whether a kernel may be computed by lanes.
template <class Kernel>
concept HasLanes = SK_NATIVE_LANES && requires { requires Kernel::sk_hasLanes; };

/// Runs a kernel on chunks.
template <class Kernel, By by>
class ChunkRunner {
 public:
  explicit ChunkRunner(const Call& call) : kernel_(call), longest_(longestChunk(kernel_)) {
    kernel_.sk_extent = toIndex(call.domain);
  }

  Kernel& kernel() { return kernel_; }
  /// The length of a chunk, at most.
  int longest() const { return longest_; }

  /// Elements from `a` to `b` of a chunk, and from `c` to `d`. None writes what another one reads: the runtime copies streams that
  /// are read elsewhere than they are written.
  void run(const Extents& first, int count, int a, int b, int c = 0, int d = 0) {
    place(kernel_, {first, count, scratch_});
    Kernel here = kernel_;  // which nothing that is stored can change
    const auto x = static_cast<std::int32_t>(first[0]);
    for (int part = 0; part < 2; ++part, a = c, b = d) {
      if constexpr (by == By::Lanes) {
        for (; b - a >= laneCount; a += laneCount) {
          moveTo(here, x, a);
          here.sk_lanes();
        }
      }
      if constexpr (Kernel::sk_isOrdered) {
        for (int i = a; i < b; ++i) {
          moveTo(here, x, i);
          here.sk_element();
        }
      } else {
        SK_NATIVE_INDEPENDENT
        for (int i = a; i < b; ++i) {
          moveTo(here, x, i);
          here.sk_element();
        }
      }
    }
  }

 private:
  Kernel kernel_;
  int longest_;
  Scratch scratch_;
};

template <class Kernel>
concept HasInside = requires { typename Kernel::sk_Inside; };

/// The part of a row, of `extent` elements, where the kernel's form for the inside can be used.
template <class Kernel>
Range insideOf(Kernel& kernel, const Extents& row, std::int64_t extent) {
  Range inside{0, extent};
  const auto narrow = [&](auto& stream) {
    if constexpr (requires { stream.narrow(inside, row); }) stream.narrow(inside, row);
  };
  std::apply([&](auto&... stream) { (narrow(stream), ...); }, kernel.sk_streams());
  return inside;
}

/// The elements of some of the domain's Pieces, one after the other.
template <class Kernel, By by = By::Element>
void runPieces(const Call& call, Range pieces) {
  ChunkRunner<Kernel, by> whole(call);
  const Pieces all(call.domain, Kernel::sk_isUneven);
  if constexpr (HasInside<Kernel>) {
    ChunkRunner<typename Kernel::sk_Inside, by> inside(call);
    all.forEachChunk(pieces, whole.longest(), [&](const Extents& first, int count) {
      const Range range = insideOf(inside.kernel(), first, call.domain[0]);
      const int a = static_cast<int>(std::clamp<std::int64_t>(range.begin - first[0], 0, count));
      const int b = static_cast<int>(std::clamp<std::int64_t>(range.end - first[0], a, count));
      if (a < b) inside.run(first, count, a, b);
      if (a > 0 || b < count) whole.run(first, count, 0, a, b, count);
    });
  } else {
    all.forEachChunk(pieces, whole.longest(),
                     [&](const Extents& first, int count) { whole.run(first, count, 0, count); });
  }
}

template <class Kernel>
SK_NATIVE_WIDE void runPiecesByLanes(const Call& call, Range pieces) {
  runPieces<Kernel, By::Lanes>(call, pieces);
}

/// A kernel over the domain; `hot` is runPieces of it.
template <class Kernel, auto hot>
void runKernel(const Call& call) {
  const Pieces pieces(call.domain, Kernel::sk_isUneven);
  if (pieces.count() == 0) return;
  void (*run)(const Call&, Range) = hot;
  if constexpr (HasLanes<Kernel>) {
    if (isWide()) run = &runPiecesByLanes<Kernel>;
  }
  if constexpr (Kernel::sk_isOrdered) {
    run(call, {0, pieces.count()});
  } else {
    constexpr std::int64_t costOfElement = Kernel::sk_isUneven ? 1 << 6 : 1;
    inParallel(pieces.count(), pieces.elementsOfOne() * costOfElement,
               Kernel::sk_isUneven ? Deal::AsTheyCome : Deal::Evenly, [&](Range range) { run(call, range); });
  }
}

}  // namespace sk::native
