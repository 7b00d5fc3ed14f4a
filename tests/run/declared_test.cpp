// SPDX-License-Identifier: MIT
//
// The structs that allocate a file's declared streams: names, arguments and shapes.
#include <type_traits>

#include "declared.sk.hpp"
#include "declared_only.sk.hpp"
#include "support/configuration_file.hpp"
#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;

TEST_CASE("declared streams have the extents that their names are given, and their constants") {
  onSomeLayouts([](sk::Device& device) {
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
  onEveryTarget([](sk::Device& device) {
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

TEST_CASE("a file chooses what declared streams hold their floats as") {
  const ConfigurationFile file(
      "[streams.\"declared::field\"]\nstorage = \"half\"\n"
      "[streams.\"*\"]\nstorage = \"double\"\n"
      "[streams.mine]\nstorage = \"single\"\n");
  constexpr float third = 1.0F / 3;
  for (const bool isNative : {false, true}) {
    sk::Device device({.device = isNative ? "native" : "gl", .configuration = file.path});
    declared::DeclaredStreams s(device, 1, 2, 1);
    s.field.write(std::vector<float>{third, 1});
    CHECK(s.field.read() == std::vector<float>{sk::half(third), 1});
    s.flux.writeReals(std::vector<double>{1.0 / 3, 1});
    CHECK(s.flux.readReals() == std::vector<double>{1.0 / 3, 1});
    s.narrow.write(std::vector<sk::half>(
        3, sk::half(1.0F)));   // its elements are no floats, so the storage option does not apply
    auto mine = device.stream<float>({1}, sk::Storage::Default, "mine");
    mine.writeReals(std::vector<double>{1.0 / 3});
    CHECK(mine.readReals() == std::vector<double>{third});
    auto said = device.stream<float>({1}, sk::Storage::Half, "mine");
    said.write(std::vector<float>{third});
    CHECK(said.read() == std::vector<float>{sk::half(third)});
  }
}
