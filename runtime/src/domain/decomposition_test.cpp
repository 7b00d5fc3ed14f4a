// SPDX-License-Identifier: MIT
//
// Promises: every element of a domain belongs to exactly one rank; what a rank sends to a neighbor is what that neighbor
// receives; the boxes around an interior cover the rest once.
#include "domain/decomposition.hpp"

#include <catch2/catch.hpp>

namespace sk::domain {
namespace {

TEST_CASE("ranks share the elements of a domain evenly") {
  const Decomposition parts({7, 5}, {3, 2}, {true, false});
  REQUIRE(parts.ranks() == 6);
  std::int64_t elements = 0;
  for (int rank = 0; rank < 6; ++rank) {
    const Shape shape = shapeOf(parts.boxOf(rank));
    elements += shape.size();
    CHECK((shape[0] == 2 || shape[0] == 3));
    CHECK((shape[1] == 2 || shape[1] == 3));
    for (int other = 0; other < rank; ++other)
      CHECK(isEmpty(intersection(parts.boxOf(rank), parts.boxOf(other))));
  }
  CHECK(elements == 35);
  CHECK(parts.leastExtent(0) == 2);
  CHECK(shapeOf(parts.boxOf(parts.thinnest(0)))[0] == 2);
}

TEST_CASE("a rank sends what its neighbor receives") {
  const Decomposition parts({7, 5}, {3, 2}, {true, false});
  const Depth depth{{1, 2}, {2, 1}};
  CHECK(directionsOf(parts).size() == 8);
  for (int rank = 0; rank < parts.ranks(); ++rank) {
    for (const Index& direction : directionsOf(parts)) {
      const std::optional<int> to = parts.neighbor(rank, direction);
      if (!to) continue;
      Index back = direction;
      for (int d = 0; d < 2; ++d) back[d] = -direction[d];
      CHECK(parts.neighbor(*to, back) == rank);
      const Box sent = sentTo(parts.boxOf(rank), direction, depth);
      Box received = receivedFrom(parts.boxOf(*to), back, depth);
      CHECK(shapeOf(sent) == shapeOf(received));
      const std::int64_t wrapped = ((received.begin[0] % 7) + 7) % 7;
      CHECK(wrapped == sent.begin[0]);
      CHECK(received.begin[1] == sent.begin[1]);
    }
  }
  CHECK_FALSE(parts.neighbor(0, {0, -1}));
  CHECK(parts.neighbor(0, {-1, 0}) == 4);
  CHECK(parts.haloOf(0, depth) == Depth{{1, 0}, {2, 1}});
}

TEST_CASE(
    "the split with the least surface is chosen, where faces that are not contiguous count a little more") {
  CHECK(balancedSplit({100, 100}, 4) == Index{4, 1});
  CHECK(balancedSplit({100, 100}, 16) == Index{4, 4});
  CHECK(balancedSplit({100, 100}, 2) == Index{2, 1});
  CHECK(balancedSplit({10, 1000}, 4) == Index{1, 4});
  CHECK(balancedSplit({64, 64, 64}, 8) == Index{4, 2, 1});
  CHECK(balancedSplit({3, 2}, 6) == Index{3, 2});
  CHECK_FALSE(balancedSplit({3, 2}, 7));
  CHECK_FALSE(balancedSplit({4}, 6));
}

TEST_CASE("what is beyond an end lies at the other end") {
  const std::vector<Piece> pieces = piecesInside({{-2, 1}, {3, 9}}, {10, 8});
  REQUIRE(pieces.size() == 4);
  std::int64_t elements = 0;
  for (const Piece& piece : pieces) elements += shapeOf(piece.box).size();
  CHECK(elements == 5 * 8);
  CHECK(pieces[0].box == Box{{8, 1}, {10, 8}});
  CHECK(pieces[0].shift == Index{10, 0});
  CHECK(pieces[3].box == Box{{0, 0}, {3, 1}});
  CHECK(pieces[3].shift == Index{0, -8});
  CHECK(piecesInside({{3, 3}, {3, 4}}, {10, 8}).empty());
}

TEST_CASE("a box beyond an end is moved inside") {
  const std::optional<Piece> moved = movedInside({{-2, 3}, {3, 9}}, {10, 8});
  REQUIRE(moved);
  CHECK(moved->box == Box{{0, 2}, {5, 8}});
  CHECK(moved->shift == Index{2, -1});
  CHECK_FALSE(movedInside({{-2, 0}, {9, 8}}, {10, 8}));
}

TEST_CASE("boxes around an interior have the rest, once") {
  const Box all{{-1, 0, 2}, {5, 7, 9}}, inner{{0, 2, 2}, {4, 5, 8}};
  std::int64_t elements = shapeOf(inner).size();
  const std::vector<Box> rest = difference(all, inner);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    elements += shapeOf(rest[i]).size();
    CHECK(isEmpty(intersection(rest[i], inner)));
    for (std::size_t k = 0; k < i; ++k) CHECK(isEmpty(intersection(rest[i], rest[k])));
  }
  CHECK(elements == shapeOf(all).size());
  CHECK(difference(all, Box{{3, 3, 3}, {3, 4, 4}}).size() == 1);
}

}  // namespace
}  // namespace sk::domain
