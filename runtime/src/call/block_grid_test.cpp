// SPDX-License-Identifier: MIT
//
// Tests which shapes can be folded to which.
#include "call/box.hpp"

#include <catch2/catch.hpp>

using namespace sk;

namespace {

std::vector<Shape> list(std::initializer_list<Shape> shapes) { return shapes; }

}  // namespace

TEST_CASE("a result of as many dimensions is its own grid") {
  CHECK(blockGrids({6, 8}, {3, 4}) == list({{3, 4}}));
  CHECK(blockGrids({6, 8}, {6, 1}) == list({{6, 1}}));
  CHECK(blockGrids({6}, {1}) == list({{1}}));
  CHECK(blockGrids({6, 8}, {4, 4}).empty());
  CHECK(blockGrids({6, 8}, {12, 8}).empty());
}

TEST_CASE("a result of fewer dimensions has one meaning, several, or none") {
  CHECK(blockGrids({6, 8}, {8}) == list({{1, 8}}));
  CHECK(blockGrids({6, 9}, {2}) == list({{2, 1}}));
  CHECK(blockGrids({6, 8}, {2}).size() == 2);
  CHECK(blockGrids({6, 8}, {1}) == list({{1, 1}}));
  CHECK(blockGrids({6, 8}, {5}).empty());
  CHECK(blockGrids({5, 7, 11}, {5, 11}) == list({{5, 1, 11}}));
  CHECK(blockGrids({5, 7, 11}, {11, 5}).empty());
  CHECK(blockGrids({2, 3, 5, 7}, {3}) == list({{1, 3, 1, 1}}));
  CHECK(blockGrids({5, 5, 3}, {5}).size() == 2);
}

TEST_CASE("a result of more dimensions does not fit") { CHECK(blockGrids({6}, {6, 1}).empty()); }

TEST_CASE("no elements are folded to no blocks, or to blocks of none") {
  CHECK(blockGrids({0, 4}, {0, 2}) == list({{0, 2}}));
  CHECK(blockGrids({0, 4}, {3, 2}) == list({{3, 2}}));
  CHECK(blockGrids({3, 4}, {0, 4}).empty());
}
