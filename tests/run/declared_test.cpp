// SPDX-License-Identifier: MIT
//
// The structs that allocate declared streams: their names, arguments and shapes.
#include <type_traits>

#include "declared.sk.hpp"
#include "declared_only.sk.hpp"
#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;

TEST_CASE("declared streams have the extents that their names are given, and their constants") {
  onEveryLayout([](sk::Device& device) {
    declared::DeclaredStreams s(device, 5, 7, 2);
    CHECK(s.field.shape() == sk::Shape{5, 7});
    CHECK(s.flux.shape() == sk::Shape{5, 7});
    CHECK(s.cells.shape() == sk::Shape{5, 7});
    CHECK(s.row.shape() == sk::Shape{7});
    CHECK(s.corner.shape() == sk::Shape{1, 1});
    CHECK(s.box.shape() == sk::Shape{8, 6, 1, 4});
    CHECK(s.narrow.shape() == sk::Shape{3});
    CHECK(s.turns.shape() == sk::Shape{2});
    CHECK(declared::inner::DeclaredStreams(device, 9).field.shape() == sk::Shape{9, 8});
    CHECK(DeclaredStreams(device, 70).lone.shape() == sk::Shape{70});
    DeclaredOnlyStreams only(device, 3, 131);
    CHECK(only.colours.shape() == sk::Shape{3, 131});
    CHECK(only.seeds.shape() == sk::Shape{16});
    static_assert(std::is_same_v<decltype(s.cells), sk::Stream<Cell>>);
    static_assert(std::is_same_v<decltype(s.narrow), sk::Stream<sk::half>>);
  });
}

TEST_CASE("declared streams are streams like all others") {
  onEveryProfile([](sk::Device& device) {
    declared::DeclaredStreams s(device, 5, 7, 1);
    const auto u = values<float>(35);
    s.field.write(u);
    s.corner.write(std::vector<float>{2});
    declared::spread(s.field, s.corner, s.flux);
    CHECK(difference(s.flux.read(), [&](std::size_t i) {
            const std::size_t right = i % 7 == 6 ? i - 6 : i + 1;
            return 2 * (u[right] - u[i]);
          }) == "");
    declared::DeclaredStreams moved = std::move(s);
    CHECK(moved.field.read() == u);
    const declared::DeclaredStreams empty(device, 0, 7, 0);
    CHECK(empty.field.read().empty());
  });
}

TEST_CASE("an extent below 0 is refused as for any stream") {
  CHECK_THROWS_AS(DeclaredStreams(device("glsl330"), -1), sk::Error);
}
