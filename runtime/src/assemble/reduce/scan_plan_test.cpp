// SPDX-License-Identifier: MIT
//
// Promises: a dispatched scan takes one pass, or three while the totals of its tiles fit into one, whose groups cover all
// items; lines that are one element apart are walked side by side. Digits of exact sums have room for what runs add.
#include <catch2/catch.hpp>

#include "assemble/reduce/scan_plan.hpp"

using namespace sk::assemble;

namespace {

constexpr ReduceLimits dispatched{.texture = {16384, 256, true}, .fanIn = scanRun, .grouped = true};

RegionLayout packedLine(std::int32_t count) {
  RegionLayout layout = linearLayout(count / lanes, *linearTexture(count / lanes, dispatched.texture));
  layout.packed = true;
  layout.extent[0] = count;
  layout.stride = stridesOf(layout.extent);
  return layout;
}

ScanPlan plan(const RegionLayout& elements, const Lines& lines, const ScanAccess& access) {
  return planScan(elements, elements, dispatched, lines, access, false);
}

std::int64_t groupsOf(const ReducePass& pass) { return std::int64_t{pass.groups.width} * pass.groups.height; }

}  // namespace

TEST_CASE("a line is scanned in tiles, in one pass or three") {
  constexpr std::int32_t count = 1 << 24;
  ScanAccess access{.byIndex = false, .byTexel = true, .elementRun = 4, .partialRun = 16, .chained = false};
  const ScanPlan three = plan(packedLine(count), {count, 1}, access);
  REQUIRE(three.folds.size() == 1);
  REQUIRE(three.scans.size() == 2);
  CHECK(three.folds[0].variant.unit == ScanUnit::Tile);
  CHECK(three.folds[0].texture.width * three.folds[0].texture.height == 4096);
  CHECK(groupsOf(three.scans[0]) == 1);
  CHECK(groupsOf(three.scans[1]) == 4096);
  CHECK(three.scans[1].variant.carried);
  access.chained = true;
  const ScanPlan one = plan(packedLine(count), {count, 1}, access);
  CHECK(one.folds.empty());
  REQUIRE(one.scans.size() == 1);
  CHECK(one.scans[0].variant.chained);
  CHECK(groupsOf(one.scans[0]) == 4096);
  const ScanPlan tile = plan(packedLine(4096), {4096, 1}, access);
  REQUIRE(tile.scans.size() == 1);
  CHECK(!tile.scans[0].variant.chained);  // there is nothing before its only tile
}

TEST_CASE("tiles of whole pairs of rows are fetched and stored two rows at once") {
  constexpr std::int32_t count = 1 << 24;
  const ScanAccess access{
      .byIndex = false, .byTexel = true, .elementRun = 4, .partialRun = 16, .chained = true};
  const auto pairs = [&](const RegionLayout& result) {
    const ScanPlan scan = planScan(packedLine(count), result, dispatched, {count, 1}, access, false);
    for (const UniformValue& uniform : scan.scans.back().uniforms) {
      if (uniform.name == "sk_pairs") return uniform.value[0];
    }
    return -1;
  };
  RegionLayout result = packedLine(count);
  CHECK(pairs(result) == result.shift);
  RegionLayout shifted = result;
  shifted.origin[0] = 4 << result.shift;  // one row
  CHECK(pairs(shifted) == 0);
  ++result.shift;
  CHECK(pairs(result) == 0);
}

TEST_CASE("more groups than fit into a row are dispatched in rows") {
  constexpr std::int32_t count = 40000 * 4096;
  const ScanPlan scan =
      plan(packedLine(count), {count, 1},
           {.byIndex = false, .byTexel = true, .elementRun = 4, .partialRun = 16, .chained = true});
  CHECK(scan.scans[0].groups.width == 1 << groupRowShift);
  CHECK(scan.scans[0].groups.height == 2);
}

TEST_CASE("lines across rows are walked side by side, and short lines item by item") {
  RegionLayout plane;
  plane.extent = {100, 1000, 1, 1};
  const ScanAccess access{
      .byIndex = false, .byTexel = false, .elementRun = 16, .partialRun = 16, .chained = true};
  const ScanPlan across = plan(plane, {1000, 100}, access);
  REQUIRE(across.folds.size() == 1);
  CHECK(across.folds[0].variant.unit == ScanUnit::Item);  // an invocation for each run
  CHECK(across.folds[0].variant.run == 32);
  for (const ReducePass& pass : across.scans) CHECK(pass.variant.unit == ScanUnit::Run);
  CHECK(groupsOf(across.scans.back()) == (32 * 100 + tileGroup - 1) / tileGroup);
  const ScanPlan along = plan(plane, {100, 1}, access);
  CHECK(along.scans.back().variant.unit == ScanUnit::Item);
}

TEST_CASE("digits of exact sums have room for runs") {
  constexpr ReduceLimits drawn{.texture = {16384, 256, true}, .fanIn = scanRun};
  for (const std::int32_t length : {1, 16, 31, 32, 100, 4000, 1 << 20}) {
    for (const std::int32_t inner : {1, 3}) {
      for (const bool byTexel : {false, true}) {
        if (byTexel && (inner > 1 || length % lanes != 0)) continue;
        RegionLayout elements = byTexel ? packedLine(length) : RegionLayout{.extent = {inner, length, 1, 1}};
        if (!byTexel && inner == 1) elements.extent = {length, 1, 1, 1};
        ScanAccess access{.byIndex = false, .byTexel = byTexel, .ofDigits = true};
        for (const std::int32_t tileRun : {0, 1, 2}) {  // of 52 bytes of accumulators: 1
          access.elementRun = access.partialRun = tileRun;
          for (const ReduceLimits& limits : {drawn, dispatched}) {
            INFO(length << ", " << inner << " apart, " << tileRun);
            const ScanPlan scan = planScan(elements, elements, limits, {length, inner}, access, false);
            CHECK(keepsRoom(scan));
          }
        }
      }
    }
  }
  // the check finds runs that are too long
  const RegionLayout plane{.extent = {3, 100, 1, 1}};
  CHECK_FALSE(keepsRoom(plan(plane, {100, 3}, {.byIndex = false})));
}
