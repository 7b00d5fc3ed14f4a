// SPDX-License-Identifier: MIT
//
// How the elements of a domain are divided over ranks: a grid of boxes, whose extents differ by at most 1 in each
// dimension. Pure arithmetic, without MPI.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "sk/options.hpp"
#include "sk/shape.hpp"

namespace sk::domain {

/// A number of elements before and after a box, in each dimension.
struct Depth {
  std::array<std::int64_t, maxRank> below = {}, above = {};

  bool operator==(const Depth&) const = default;
  /// Whether `other` is as deep or less deep everywhere.
  bool covers(const Depth& other) const;
  /// The deeper one, in each dimension and on each side.
  Depth with(const Depth& other) const;
};

class Decomposition {
 public:
  /// Divides dimension d in split[d] parts: at least 1, and at most the extent.
  Decomposition(const Shape& whole, const Index& split, const std::array<bool, maxRank>& periodic);

  const Shape& whole() const { return whole_; }
  const Index& split() const { return split_; }
  bool isPeriodic(int d) const { return periodic_[static_cast<std::size_t>(d)]; }
  int ranks() const;
  /// The place of a rank in the grid; ranks are counted in row-major order.
  Index placeOf(int rank) const;
  Box boxOf(int rank) const;
  /// The rank next to another in the direction `offset`, which is -1, 0 or 1 in each dimension; nullopt beyond an end.
  std::optional<int> neighbor(int rank, const Index& offset) const;
  /// The least extent of all boxes.
  std::int64_t leastExtent(int d) const { return whole_[d] / split_[d]; }
  /// A rank with the least extent in dimension d: the last one.
  int thinnest(int d) const;
  /// `depth` where the rank has a neighbor, and 0 elsewhere, because an undivided dimension has no halo.
  Depth haloOf(int rank, const Depth& depth) const;

 private:
  int rankAt(const Index& place) const;

  Shape whole_;
  Index split_;
  std::array<bool, maxRank> periodic_;
};

/// The grid of `ranks` boxes with the least surface; slow dimensions are divided rather than fast ones, because their halos
/// are contiguous. Returns nullopt if no grid has an element for each rank.
std::optional<Index> balancedSplit(const Shape& whole, int ranks);

/// The directions to neighbors: every offset of -1, 0 and 1 but the origin, in the dimensions that are divided.
std::vector<Index> directionsOf(const Decomposition& parts);

/// The elements of `own` that a neighbor in a direction needs as a halo of this depth, or the elements that it sends:
/// a halo of `own`. Empty boxes, which have an extent of 0, are possible.
Box sentTo(const Box& own, const Index& direction, const Depth& depth);
Box receivedFrom(const Box& own, const Index& direction, const Depth& depth);

bool isEmpty(const Box& box);
Box intersection(const Box& a, const Box& b);
/// The box, larger by `depth`.
Box grown(const Box& box, const Depth& depth);
Box shrunk(const Box& box, const Depth& depth);
Shape shapeOf(const Box& box);
/// A part of a box that lies in the whole, or would if it were moved by `shift`: beyond an end, periodic domains go on with
/// the elements at the other end.
struct Piece {
  Box box;  ///< in the whole
  Index shift;  ///< what was added to the indices
};
std::vector<Piece> piecesInside(const Box& box, const Shape& whole);
/// A box that goes beyond an end, moved by as little as it takes to be in the whole: for who does not care about indices.
/// Nullopt if it is larger than the whole.
std::optional<Piece> movedInside(const Box& box, const Shape& whole);
/// Boxes that together have the elements of `all` that `inner`, a part of it, does not have.
std::vector<Box> difference(const Box& all, const Box& inner);

}  // namespace sk::domain
