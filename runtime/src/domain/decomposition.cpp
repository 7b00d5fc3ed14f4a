// SPDX-License-Identifier: MIT
#include "domain/decomposition.hpp"

#include <algorithm>
#include <utility>

namespace sk::domain {

namespace {

std::size_t sized(int d) { return static_cast<std::size_t>(d); }

/// Calls visit(split) for each way to write `ranks` as a product of one factor for each dimension from `d` on.
template <class Visit>
void forEachSplit(const Shape& whole, int ranks, int d, Index& split, Visit& visit) {
  if (d + 1 >= std::min(whole.rank(), maxRank)) {
    if (ranks > whole[d]) return;
    split[d] = ranks;
    return visit(split);
  }
  for (int factor = 1; factor <= ranks && factor <= whole[d]; ++factor) {
    if (ranks % factor != 0) continue;
    split[d] = factor;
    forEachSplit(whole, ranks / factor, d + 1, split, visit);
  }
}

/// The elements on the faces of the largest box that have a neighbor. Those that are not contiguous count a little more.
double surfaceOf(const Shape& whole, const Index& split) {
  double volume = 1;
  for (int d = 0; d < whole.rank(); ++d) volume *= static_cast<double>((whole[d] - 1) / split[d] + 1);
  double surface = 0;
  for (int d = 0; d < whole.rank(); ++d) {
    const auto extent = static_cast<double>((whole[d] - 1) / split[d] + 1);
    if (split[d] > 1) surface += volume / extent * (1 + 0.1 * d);
  }
  return surface;
}

}  // namespace

bool Depth::covers(const Depth& other) const {
  for (std::size_t d = 0; d < below.size(); ++d) {
    if (below[d] < other.below[d] || above[d] < other.above[d]) return false;
  }
  return true;
}

Depth Depth::with(const Depth& other) const {
  Depth deeper = *this;
  for (std::size_t d = 0; d < below.size(); ++d) {
    deeper.below[d] = std::max(below[d], other.below[d]);
    deeper.above[d] = std::max(above[d], other.above[d]);
  }
  return deeper;
}

Decomposition::Decomposition(const Shape& whole, const Index& split,
                             const std::array<bool, maxRank>& periodic)
    : whole_(whole), split_(split), periodic_(periodic) {}

int Decomposition::ranks() const {
  std::int64_t ranks = 1;
  for (int d = 0; d < split_.rank(); ++d) ranks *= split_[d];
  return static_cast<int>(ranks);
}

Index Decomposition::placeOf(int rank) const {
  Index place = Index::origin(split_.rank());
  for (int d = split_.rank() - 1; d >= 0; --d) {
    place[d] = rank % split_[d];
    rank /= static_cast<int>(split_[d]);
  }
  return place;
}

int Decomposition::rankAt(const Index& place) const {
  std::int64_t rank = 0;
  for (int d = 0; d < split_.rank(); ++d) rank = rank * split_[d] + place[d];
  return static_cast<int>(rank);
}

Box Decomposition::boxOf(int rank) const {
  const Index place = placeOf(rank);
  Box box{Index::origin(whole_.rank()), Index::origin(whole_.rank())};
  for (int d = 0; d < whole_.rank(); ++d) {
    const std::int64_t least = whole_[d] / split_[d], larger = whole_[d] % split_[d];
    box.begin[d] = place[d] * least + std::min(place[d], larger);
    box.end[d] = box.begin[d] + least + (place[d] < larger ? 1 : 0);
  }
  return box;
}

std::optional<int> Decomposition::neighbor(int rank, const Index& offset) const {
  Index place = placeOf(rank);
  for (int d = 0; d < place.rank(); ++d) {
    place[d] += offset[d];
    if (place[d] >= 0 && place[d] < split_[d]) continue;
    if (!isPeriodic(d)) return std::nullopt;
    place[d] = place[d] < 0 ? split_[d] - 1 : 0;
  }
  return rankAt(place);
}

int Decomposition::thinnest(int d) const {
  Index place = Index::origin(split_.rank());
  place[d] = split_[d] - 1;
  return rankAt(place);
}

Depth Decomposition::haloOf(int rank, const Depth& depth) const {
  const Index place = placeOf(rank);
  Depth halo;
  for (int d = 0; d < split_.rank(); ++d) {
    if (split_[d] == 1) continue;
    if (isPeriodic(d) || place[d] > 0) halo.below[sized(d)] = depth.below[sized(d)];
    if (isPeriodic(d) || place[d] + 1 < split_[d]) halo.above[sized(d)] = depth.above[sized(d)];
  }
  return halo;
}

std::optional<Index> balancedSplit(const Shape& whole, int ranks) {
  std::optional<Index> best;
  double least = 0;
  Index split = Index::origin(whole.rank());
  const auto visit = [&](const Index& one) {
    const double surface = surfaceOf(whole, one);
    if (best && surface >= least) return;
    best = one;
    least = surface;
  };
  forEachSplit(whole, ranks, 0, split, visit);
  return best;
}

std::vector<Index> directionsOf(const Decomposition& parts) {
  std::vector<Index> directions = {Index::origin(parts.split().rank())};
  for (int d = 0; d < parts.split().rank(); ++d) {
    if (parts.split()[d] == 1) continue;
    const std::size_t count = directions.size();
    for (const int step : {-1, 1}) {
      for (std::size_t i = 0; i < count; ++i) {
        Index direction = directions[i];
        direction[d] = step;
        directions.push_back(direction);
      }
    }
  }
  directions.erase(directions.begin());
  return directions;
}

Box sentTo(const Box& own, const Index& direction, const Depth& depth) {
  Box box = own;
  for (int d = 0; d < own.begin.rank(); ++d) {
    if (direction[d] < 0) box.end[d] = own.begin[d] + depth.above[sized(d)];
    if (direction[d] > 0) box.begin[d] = own.end[d] - depth.below[sized(d)];
  }
  return box;
}

Box receivedFrom(const Box& own, const Index& direction, const Depth& depth) {
  Box box = own;
  for (int d = 0; d < own.begin.rank(); ++d) {
    if (direction[d] < 0) {
      box.begin[d] = own.begin[d] - depth.below[sized(d)];
      box.end[d] = own.begin[d];
    } else if (direction[d] > 0) {
      box.begin[d] = own.end[d];
      box.end[d] = own.end[d] + depth.above[sized(d)];
    }
  }
  return box;
}

bool isEmpty(const Box& box) {
  for (int d = 0; d < box.begin.rank(); ++d) {
    if (box.begin[d] >= box.end[d]) return true;
  }
  return false;
}

Box intersection(const Box& a, const Box& b) {
  Box both = a;
  for (int d = 0; d < a.begin.rank(); ++d) {
    both.begin[d] = std::max(a.begin[d], b.begin[d]);
    both.end[d] = std::max(both.begin[d], std::min(a.end[d], b.end[d]));
  }
  return both;
}

Box grown(const Box& box, const Depth& depth) {
  Box larger = box;
  for (int d = 0; d < box.begin.rank(); ++d) {
    larger.begin[d] -= depth.below[sized(d)];
    larger.end[d] += depth.above[sized(d)];
  }
  return larger;
}

Box shrunk(const Box& box, const Depth& depth) {
  Box smaller = box;
  for (int d = 0; d < box.begin.rank(); ++d) {
    smaller.begin[d] += depth.below[sized(d)];
    smaller.end[d] -= depth.above[sized(d)];
  }
  return smaller;
}

Shape shapeOf(const Box& box) {
  const auto extent = [&](int d) { return box.end[d] - box.begin[d]; };
  switch (box.begin.rank()) {
    case 1: return {extent(0)};
    case 2: return {extent(0), extent(1)};
    case 3: return {extent(0), extent(1), extent(2)};
    case 4: return {extent(0), extent(1), extent(2), extent(3)};
  }
  return {};
}

std::vector<Piece> piecesInside(const Box& box, const Shape& whole) {
  std::vector<Piece> pieces = {{box, Index::origin(box.begin.rank())}};
  for (int d = 0; d < whole.rank(); ++d) {
    std::vector<Piece> divided;
    for (const Piece& piece : pieces) {
      for (const std::int64_t lap : {-1, 0, 1}) {
        Piece part = piece;
        part.box.begin[d] = std::max(piece.box.begin[d], lap * whole[d]) - lap * whole[d];
        part.box.end[d] = std::min(piece.box.end[d], (lap + 1) * whole[d]) - lap * whole[d];
        part.shift[d] = -lap * whole[d];
        if (part.box.begin[d] < part.box.end[d]) divided.push_back(part);
      }
    }
    pieces = std::move(divided);
  }
  return pieces;
}

std::optional<Piece> movedInside(const Box& box, const Shape& whole) {
  Piece moved{box, Index::origin(whole.rank())};
  for (int d = 0; d < whole.rank(); ++d) {
    if (box.end[d] - box.begin[d] > whole[d]) return std::nullopt;
    moved.shift[d] =
        std::max<std::int64_t>(-box.begin[d], 0) - std::max<std::int64_t>(box.end[d] - whole[d], 0);
    moved.box.begin[d] += moved.shift[d];
    moved.box.end[d] += moved.shift[d];
  }
  return moved;
}

std::vector<Box> difference(const Box& all, const Box& inner) {
  if (isEmpty(inner)) return {all};
  std::vector<Box> boxes;
  Box rest = all;
  for (int d = 0; d < all.begin.rank(); ++d) {
    Box slab = rest;
    slab.end[d] = inner.begin[d];
    if (!isEmpty(slab)) boxes.push_back(slab);
    slab = rest;
    slab.begin[d] = inner.end[d];
    if (!isEmpty(slab)) boxes.push_back(slab);
    rest.begin[d] = inner.begin[d];
    rest.end[d] = inner.end[d];
  }
  return boxes;
}

}  // namespace sk::domain
