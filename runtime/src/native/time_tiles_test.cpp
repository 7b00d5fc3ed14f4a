// SPDX-License-Identifier: MIT
#include "native/time_tiles.hpp"

#include <map>
#include <set>
#include <tuple>
#include <vector>

#include <catch2/catch.hpp>

namespace sk::native {
namespace {

/// Steps that read one array within `reach`, along each of two dimensions, and write another one.
std::vector<Extents> skewsOf(int steps, std::int64_t reach) {
  Skews skews;
  std::vector<Extents> all;
  for (std::size_t i = 0; i < static_cast<std::size_t>(steps); ++i) {
    const TileAccess accesses[] = {{i % 2, false, {reach, reach}}, {(i + 1) % 2, true, {}}};
    all.push_back(skews.add(accesses));
  }
  return all;
}

TEST_CASE("a call is behind others by how far it reads what they write, and they read what it writes") {
  CHECK(skewsOf(4, 2) == std::vector<Extents>{{0, 0}, {2, 2}, {4, 4}, {6, 6}});
  Skews skews;
  const TileAccess reads[] = {{0, false, {1, 5}}}, writes[] = {{0, true, {0, 0}}},
                   other[] = {{1, false, {9, 9}}};
  CHECK(skews.add(reads) == Extents{0, 0});
  CHECK(skews.add(writes) == Extents{1, 5});
  CHECK(skews.add(other) == Extents{0, 0});  // nobody writes that array
  CHECK(skews.add(writes) == Extents{1, 5});
  CHECK(skews.most() == Extents{1, 5});
}

/// Whether tiles compute each element of each step once, and only after all that it reads, with tiles of a phase in any order.
void checkOrder(const Extents& extent, const std::vector<TimeTiles::Axis>& axes, int steps,
                std::int64_t reach) {
  const TimeTiles tiles(extent, axes);
  const std::vector<Extents> skews = skewsOf(steps, reach);
  using Element = std::tuple<std::size_t, std::int64_t, std::int64_t>;  // step, x, y
  struct When {
    int phase;
    std::int64_t tile;
  };
  std::map<Element, When> computed;
  for (int phase = 0; phase < tiles.phases(); ++phase) {
    for (std::int64_t tile = 0; tile < tiles.tilesOf(phase); ++tile) {
      for (std::size_t step = 0; step < skews.size(); ++step) {
        tiles.forEachBox(phase, tile, skews[step], [&](const Part& box) {
          for (std::int64_t y = box.first[1]; y < box.first[1] + box.extent[1]; ++y) {
            for (std::int64_t x = box.first[0]; x < box.first[0] + box.extent[0]; ++x)
              REQUIRE(computed.try_emplace({step, x, y}, When{phase, tile}).second);
          }
        });
      }
    }
  }
  REQUIRE(computed.size() == static_cast<std::size_t>(steps * extent[0] * extent[1]));
  const auto isPeriodic = [&](std::size_t d) {
    for (const TimeTiles::Axis& axis : axes) {
      if (axis.dimension == d) return axis.isPeriodic;
    }
    return false;
  };
  for (const auto& [element, when] : computed) {
    const auto& [step, x, y] = element;
    if (step == 0) continue;
    for (std::int64_t dy = -reach; dy <= reach; ++dy) {
      for (std::int64_t dx = -reach; dx <= reach; ++dx) {
        std::int64_t nx = x + dx, ny = y + dy;
        if (isPeriodic(0)) nx = (nx + extent[0]) % extent[0];
        if (isPeriodic(1)) ny = (ny + extent[1]) % extent[1];
        if (nx < 0 || nx >= extent[0] || ny < 0 || ny >= extent[1]) continue;
        const When& before = computed.at({step - 1, nx, ny});
        const bool isOrdered =
            before.phase < when.phase || (before.phase == when.phase && before.tile == when.tile);
        REQUIRE(isOrdered);
        if (step + 1 == skews.size()) continue;  // the next step overwrites what this one reads
        const When& after = computed.at({step + 1, x, y});
        REQUIRE((when.phase < after.phase || (when.phase == after.phase && when.tile == after.tile)));
      }
    }
  }
}

TEST_CASE("tiles compute everything once, after all that it needs") {
  for (const bool isPeriodic : {false, true}) {
    checkOrder({7, 40, 1, 1}, {{1, 4, isPeriodic}}, 5, 1);
    checkOrder({5, 41, 1, 1}, {{1, 3, isPeriodic}}, 3, 3);
    checkOrder({5, 12, 1, 1}, {{1, 1, isPeriodic}}, 6, 1);
    checkOrder({33, 1, 1, 1}, {{0, 4, isPeriodic}}, 4, 1);
    checkOrder({26, 31, 1, 1}, {{1, 3, isPeriodic}, {0, 2, !isPeriodic}}, 5, 1);
    checkOrder({26, 31, 1, 1}, {{1, 3, isPeriodic}, {0, 2, isPeriodic}}, 3, 2);
  }
}

TileProblem heat(const Extents& extent) {
  return {.extent = extent,
          .bytes = 8,
          .bytesOfTiles = 16,
          .bytesOfCalls = 12,
          .cache = 1 << 20,
          .threads = 2,
          .mostIterations = 1000,
          .skew = [](std::int64_t n) { return Extents{n - 1, n - 1}; }};
}

TEST_CASE("tiles are as long as the cache allows, and there are none where they save nothing") {
  const std::optional<TileChoice> plane = chooseTiles(heat({4096, 4096, 1, 1}));
  REQUIRE(plane);
  REQUIRE(plane->tiles.axes().size() == 1);
  CHECK(plane->tiles.axes()[0].dimension == 1);
  CHECK(plane->tiles.length(plane->tiles.axes()[0]) == 32);
  CHECK(plane->iterations == 17);
  CHECK(plane->gain > 5);
  const std::optional<TileChoice> line = chooseTiles(heat({1 << 24, 1, 1, 1}));
  REQUIRE(line);
  CHECK(line->iterations == 32);
  const std::optional<TileChoice> wide = chooseTiles(heat({1 << 20, 64, 1, 1}));
  REQUIRE(wide);
  CHECK(wide->tiles.axes().size() == 2);
  CHECK_FALSE(chooseTiles(heat({100, 100, 1, 1})));  // stays in the cache
  CHECK_FALSE(chooseTiles(heat({0, 100, 1, 1})));
  TileProblem anywhere = heat({4096, 4096, 1, 1});
  anywhere.skew = [](std::int64_t n) { return n == 1 ? Extents{} : Extents{anyDistance, anyDistance}; };
  CHECK_FALSE(chooseTiles(anywhere));
  TileProblem once = heat({4096, 4096, 1, 1});
  once.mostIterations = 1;
  CHECK_FALSE(chooseTiles(once));
}

}  // namespace
}  // namespace sk::native
