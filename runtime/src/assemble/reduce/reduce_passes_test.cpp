// SPDX-License-Identifier: MIT
//
// Tests which programs and passes are planned for reductions.
#include "assemble/reduce/reduce_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "assemble/program/sample_kernels.hpp"
#include "assemble/reduce/scan_plan.hpp"

using namespace sk::assemble;

namespace {

constexpr std::int32_t mostLayers = 256;

}  // namespace

TEST_CASE("a linearised stream is seen with as few axes as it allows") {
  const auto walk = [](const Index4& extent, const Index4& blocks) {
    RegionLayout input{.linear = true, .extent = extent, .stride = stridesOf(extent), .shift = 4};
    RegionLayout result{.linear = true, .extent = blocks, .stride = stridesOf(blocks), .shift = 4};
    const ReduceVariant variant = planReduction(input, result, {{1024, mostLayers}}).front().variant;
    return std::pair(variant.walk, int{variant.axes});
  };
  CHECK(walk({4, 5, 6, 7}, {1, 1, 1, 1}).first == Walk::Line);
  CHECK(walk({4, 5, 6, 7}, {1, 5, 6, 7}).first == Walk::Line);
  CHECK(walk({4, 5, 6, 7}, {1, 1, 2, 7}).first == Walk::Line);
  CHECK(walk({4, 5, 6, 7}, {4, 5, 6, 1}) == std::pair(Walk::Box, 2));
  CHECK(walk({4, 5, 6, 7}, {4, 5, 1, 1}) == std::pair(Walk::Box, 2));
  CHECK(walk({4, 6, 6, 7}, {2, 3, 2, 1}) == std::pair(Walk::Box, 4));
}

TEST_CASE("a reduction to a value takes two programs and the fewest passes") {
  const RegionLayout square{.extent = {4096, 4096, 1, 1}};
  const auto passes = planReduction(square, valueLayout(), {{16384, 256}, 32});
  REQUIRE(passes.size() == 5);
  CHECK(passes[0].variant.walk == Walk::Rows);
  CHECK(passes[0].variant.run == 32);
  CHECK(passes[0].texture == TextureShape{128, 4096, 0});
  for (std::size_t i = 1; i < passes.size(); ++i) CHECK(passes[i].variant == passes[1].variant);
  CHECK(passes.back().draws == std::vector<Rect>{{0, 0, 1, 1}});
}

TEST_CASE("of few elements, programs know of no shape") {
  const auto program = [](std::int32_t width, std::int32_t height) {
    const RegionLayout rows{.extent = {width, height, 1, 1}};
    return planReduction(rows, valueLayout(), {{16384, 256}, 32}).front().variant;
  };
  for (std::int32_t width = 2; width < 100; ++width) CHECK(program(width, width + 1) == program(2, 3));
  CHECK(program(1024, 1024).run == 32);
  CHECK(program(1001, 1001).run == 0);
}

TEST_CASE("a linearised stream is folded by rows where it ends with one, or where order does not count") {
  const auto first = [](std::int32_t count, bool inAnyOrder) {
    const RegionLayout line = linearLayout(count, *linearTexture(count, {1024, mostLayers}));
    const Division division{.blocks = {1, 1, 1, 1}, .inAnyOrder = inAnyOrder};
    return planReduction(line, valueLayout(), {{1024, mostLayers}}, division).front().variant;
  };
  CHECK(first(1 << 16, false).walk == Walk::Rows);
  CHECK(first((1 << 16) - 1, false).walk == Walk::Line);
  CHECK(first((1 << 16) - 1, true).walk == Walk::Rows);
  CHECK(first((1 << 16) - 1, true).column);
}

TEST_CASE("long runs are columns of parts, whose number is known where all have as many") {
  const auto plan = [](std::int32_t width, std::int32_t height) {
    const RegionLayout plane{.extent = {width, height, 1, 1}};
    const Division division{.blocks = {1, 1, 1, 1}, .inAnyOrder = true, .inGroups = true};
    return planReduction(plane, valueLayout(), {.texture = {16384, mostLayers}, .longRun = 64}, division);
  };
  const std::vector<ReducePass> passes = plan(1024, 1024);
  REQUIRE(passes.size() == 4);
  CHECK(passes[0].variant.column);
  CHECK(int{passes[0].variant.run} == 64);
  CHECK(int{passes[0].variant.part} == 8);
  CHECK(passes[0].texture == TextureShape{1024, 16, 0});
  CHECK(int{plan(1024, 72).front().variant.run} == 36);
  CHECK(int{plan(1024, 72).front().variant.part} == 4);
  CHECK(int{plan(1024, 67).front().variant.run} == 0);
  CHECK(int{plan(1024, 67).front().variant.part} == 8);
}

TEST_CASE("work groups fold long runs part by part, whether all are as long or not") {
  const auto first = [](std::int32_t width, std::int32_t height) {
    const RegionLayout plane{.extent = {width, height, 1, 1}};
    const Division division{.blocks = {1, 1, 1, 1}, .inAnyOrder = true, .inGroups = true};
    const ReduceLimits limits{.texture = {32768, mostLayers}, .grouped = true, .longRun = 16};
    return planReduction(plane, valueLayout(), limits, division).front();
  };
  CHECK(first(4096, 4096).variant.grouped);
  CHECK(int{first(4096, 4096).variant.run} == 16);
  CHECK(int{first(4096, 4096).variant.part} == 8);
  CHECK(first(4096, 4096).texture == TextureShape{256, 16, 0});
  CHECK(int{first(1025, 16411).variant.run} == 0);
  CHECK(int{first(1025, 16411).variant.part} == 8);
  CHECK(first(1025, 16411).texture == TextureShape{65, 65, 0});
}

TEST_CASE("work groups fold two rows each where there are many, and order does not count") {
  const auto only = [](std::int32_t rows, bool inAnyOrder) {
    const RegionLayout plane{.packed = true, .extent = {512, rows, 1, 1}};
    const RegionLayout result{.extent = {1, rows, 1, 1}};
    const Division division{.blocks = result.extent,
                            .byIndex = true,
                            .byTexel = true,
                            .inAnyOrder = inAnyOrder,
                            .inGroups = true,
                            .byGroups = true};
    const ReduceLimits limits{.texture = {32768, mostLayers}, .grouped = true};
    const std::vector<ReducePass> passes = planReduction(plane, result, limits, division);
    REQUIRE(passes.size() == 1);
    return passes.front();
  };
  CHECK(only(4096, true).variant.twoBlocks);
  CHECK(only(4096, true).draws == std::vector<Rect>{{0, 0, 1, 2048}});
  for (const ReducePass& pass : {only(4096, false), only(4097, true), only(256, true)}) {
    CHECK_FALSE(pass.variant.twoBlocks);
    CHECK(pass.draws.front().height >= 256);
  }
}

TEST_CASE("of a dispatched reduction to a value, the last pass alone writes to a buffer") {
  const RegionLayout plane{.extent = {1024, 1024, 1, 1}};
  const Division division{.blocks = {1, 1, 1, 1}, .inAnyOrder = true, .inGroups = true};
  const ReduceLimits limits{.texture = {16384, mostLayers}, .grouped = true, .toBuffer = true};
  const std::vector<ReducePass> passes = planReduction(plane, valueLayout(), limits, division);
  REQUIRE(passes.size() == 2);
  CHECK_FALSE(passes[0].variant.toBuffer);
  CHECK(passes[1].variant.toBuffer);
}

TEST_CASE("values of components of 32 bits may end in a buffer") {
  CHECK(mayEndInBuffer(samples::sum));
  CHECK_FALSE(mayEndInBuffer(samples::weigh));  // its `best` has a bool
}

TEST_CASE("as many elements as there may be are folded to one") {
  const TextureLimits textures{16384, 256};
  const RegionLayout all = linearLayout(sk::mostElements, *linearTexture(sk::mostElements, textures));
  for (const bool grouped : {false, true}) {
    for (const std::int32_t fanIn : {2, 32}) {
      const std::vector<ReducePass> passes =
          planReduction(all, valueLayout(), {.texture = textures, .fanIn = fanIn, .grouped = grouped},
                        {.blocks = {1, 1, 1, 1}, .inAnyOrder = grouped, .inGroups = grouped});
      std::int64_t left = sk::mostElements;
      for (const ReducePass& pass : passes) {
        std::int64_t results = 0;
        for (const Rect& rect : pass.draws) {
          REQUIRE((rect.x >= 0 && rect.y >= 0 && rect.width > 0 && rect.height > 0));
          results += std::int64_t{rect.width} * rect.height;
        }
        CHECK(results < left);
        CHECK(results * fanIn * (grouped ? groupSize : 1) >= left);
        left = results;
      }
      CHECK(passes.back().toResult);
      CHECK(left == 1);
    }
  }
}

TEST_CASE("digits of exact sums have room for what an invocation folds") {
  const auto division = [](const Index4& blocks, bool byTexel, bool byGroups, bool ofDigits) {
    return Division{.blocks = blocks,
                    .byIndex = byGroups,
                    .byTexel = byTexel,
                    .inAnyOrder = true,
                    .inGroups = true,
                    .byGroups = byGroups,
                    .ofDigits = ofDigits};
  };
  for (const std::int32_t width : {4, 32, 512, 40000}) {
    for (const std::int32_t height : {1, 7, 33, 1030, 4096}) {
      for (const bool byTexel : {false, true}) {
        for (const std::int32_t longRun : {0, 16, 64}) {
          for (const bool grouped : {false, true}) {
            const RegionLayout plane{.packed = byTexel, .extent = {width, height, 1, 1}};
            const ReduceLimits limits{.texture = {32768, mostLayers}, .grouped = grouped, .longRun = longRun};
            INFO(width << " x " << height << ", runs of " << longRun);
            CHECK(keepsRoom(
                planReduction(plane, valueLayout(), limits, division({1, 1, 1, 1}, byTexel, false, true))));
            if (!grouped) continue;
            const RegionLayout rows{.extent = {1, height, 1, 1}};
            CHECK(keepsRoom(planReduction(plane, rows, limits, division(rows.extent, byTexel, true, true))));
          }
        }
      }
    }
  }
  // the check finds invocations that fold too much
  const RegionLayout plane{.packed = true, .extent = {40000, 2, 1, 1}}, rows{.extent = {1, 2, 1, 1}};
  const ReduceLimits limits{.texture = {32768, mostLayers}, .grouped = true};
  CHECK_FALSE(keepsRoom(planReduction(plane, rows, limits, division(rows.extent, true, true, false))));
}

namespace {

Index4 valueOf(const ReducePass& pass, std::string_view uniform) {
  return std::ranges::find(pass.uniforms, uniform, &UniformValue::name)->value;
}

/// The most additions of a pass that a number, or a partial result, takes part in.
std::int64_t additionsOf(const ReducePass& pass) {
  const ReduceVariant& variant = pass.variant;
  const std::int64_t each = variant.packed ? lanes : 1;
  const std::int64_t ofGroup = variant.twoBlocks ? 7 : 8;
  if (variant.walk == Walk::GroupedPartials) return valueOf(pass, "sk_fan")[0] - 1 + ofGroup;
  if (variant.walk == Walk::Rows || variant.walk == Walk::PartialRows) {
    const Index4 shape = valueOf(pass, "sk_run_shape");
    const std::int64_t run = std::int64_t{shape[0]} * shape[1] + (variant.column && variant.run == 0 ? 1 : 0);
    const std::int64_t part = variant.part;
    // of the first part: those in it, then the other parts, and what remains
    const std::int64_t inRun =
        part == 0 ? run * each - 1 : part * each - 1 + run / part - 1 + run % part * each;
    return inRun + (variant.grouped ? ofGroup : 0);
  }
  const std::int64_t fan = valueOf(pass, "sk_fan")[0];
  if (!variant.grouped) return fan * each - 1;
  const std::int64_t invocations = std::int64_t{1} << ofGroup;
  return (fan + invocations - 1) / invocations * each - 1 + ofGroup;
}

/// docs/accuracy.md, "Sums"
double statedDepth(double count, bool byBlocks) {
  const double fewer = byBlocks ? count / 0x1p16 : count;
  const double passes = fewer <= 1 ? 0 : std::ceil(std::log(fewer) / std::log(30.0) - 1e-12);
  return 31 * passes + (byBlocks ? 518 : 8);
}

}  // namespace

TEST_CASE("no tree is deeper than stated") {
  for (const std::int32_t width : {1, 2, 4, 17, 32, 33, 100, 512, 1028, 4096}) {
    for (const std::int32_t height : {1, 2, 7, 8, 31, 33, 100, 271, 1030, 4096}) {
      for (const bool byTexel : {false, true}) {
        if (byTexel && width % lanes != 0) continue;
        const auto count = static_cast<double>(width * height);
        for (const bool inAnyOrder : {false, true}) {
          for (const bool grouped : {false, true}) {
            const RegionLayout plane{.packed = byTexel, .extent = {width, height, 1, 1}};
            // as GlDevice has it
            const ReduceLimits limits{
                .texture = {32768, mostLayers}, .grouped = grouped, .longRun = grouped ? 0 : 64};
            Division division{
                .blocks = {1, 1, 1, 1}, .byTexel = byTexel, .inAnyOrder = inAnyOrder, .inGroups = true};
            std::int64_t depth = 0;
            for (const ReducePass& pass : planReduction(plane, valueLayout(), limits, division))
              depth += additionsOf(pass);
            INFO(width << " x " << height << (byTexel ? " packed" : "") << (grouped ? " in groups" : ""));
            CHECK(static_cast<double>(depth) <= statedDepth(count, false));
          }
        }
      }
    }
  }
  std::int64_t deepest = 0;
  for (const std::int32_t width : {64, 512, 1028, 32768, 65536, 300000}) {
    for (const std::int32_t height : {2, 8, 2048}) {  // many rows are folded two at a time
      for (const bool byTexel : {false, true}) {
        const RegionLayout plane{.packed = byTexel, .extent = {width, height, 1, 1}};
        const Division division{.blocks = {1, height, 1, 1},
                                .byIndex = true,
                                .byTexel = byTexel,
                                .inAnyOrder = true,
                                .inGroups = true,
                                .byGroups = true};
        const ReduceLimits limits{.texture = {32768, mostLayers}, .grouped = true};
        std::int64_t depth = 0;
        for (const ReducePass& pass : planReduction(plane, {.extent = division.blocks}, limits, division))
          depth += additionsOf(pass);
        INFO(width << " x " << height << (byTexel ? " packed" : ""));
        CHECK(static_cast<double>(depth) <= statedDepth(width, true));
        if (width <= 65536) deepest = std::max(deepest, depth);
      }
    }
  }
  CHECK(deepest == 518);
}
