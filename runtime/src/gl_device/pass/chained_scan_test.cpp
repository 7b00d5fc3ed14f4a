// SPDX-License-Identifier: MIT
//
// Promises: a scan of integers in one pass has the same results as one in several, wherever its line ends in a tile, and
// also if work groups never wait for each other. Runs on a software renderer, which by default takes several passes.
#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "call/check_reduction.hpp"
#include "call/resolved_reduction.hpp"
#include "gl/open_context.hpp"
#include "gl_device/gl_device.hpp"
#include "sk/types.hpp"

namespace sk {
namespace {

using program::Parameter;
using program::Role;

constexpr const program::Element& ints = ElementTraits<std::int32_t>::element();

/// Sums and the largest of two streams. It must outlive the devices, which identify it by its address.
struct SumAndMost {
  SumAndMost() {
    reduction.fold = {
        .name = "sumAndMost",
        .entry = "sumAndMost",
        .declarations = {},
        .body = "void sumAndMost(int x, int y, inout int s, inout int m) { s += x; m = max(m, y); }\n",
        .parameters = parameters,
        .sources = {}};
    reduction.combine = reduction.fold;
    reduction.combineOperands = operands;
    reduction.seeded = true;
  }

  std::array<Parameter, 4> parameters{
      {{.name = "x", .symbol = "x", .role = Role::Input, .element = &ints},
       {.name = "y", .symbol = "y", .role = Role::Input, .element = &ints},
       {.name = "s", .symbol = "s", .role = Role::Accumulator, .element = &ints, .identity = "0"},
       {.name = "m",
        .symbol = "m",
        .role = Role::Accumulator,
        .element = &ints,
        .identity = "-2147483647 - 1"}}};
  std::array<std::uint8_t, 4> operands{0, 1, 2, 3};
  program::Reduction reduction{};
};

std::vector<int> numbers(std::int64_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<int> x(static_cast<std::size_t>(count));
  for (int& v : x) v = static_cast<int>(random() % 1000) - 500;
  return x;
}

TEST_CASE("scans of integers take one pass, whether groups wait or not") {
  static const SumAndMost sumAndMost;
  for (const std::int32_t patience : {1024, -1}) {
    const DeviceChoices choices{.target = Target::Compute, .chainsScans = true, .scanPatience = patience};
    GlDevice device(gl::openContext({"software", gl::Api::Gl}), choices);
    for (const std::int64_t n : {5, 4097, 70001, 98304}) {
      for (const bool isExclusive : {false, true}) {
        CAPTURE(n, isExclusive, patience);
        const std::vector<int> x = numbers(n, 1), y = numbers(n, 2);
        const auto a = device.createStream(ints, {n}, Storage::Single),
                   b = device.createStream(ints, {n}, Storage::Single);
        detail::write(detail::wholeRegion(a.get()), x.data(), x.size());
        detail::write(detail::wholeRegion(b.get()), y.data(), y.size());
        const Argument first{.region = detail::wholeRegion(a.get())},
            second{.region = detail::wholeRegion(b.get())};
        const std::array arguments{first, second, second, first};  // crosswise
        ResolvedReduction call = checkReduction(sumAndMost.reduction, arguments, {},
                                                ScanOrder{.along = {}, .isExclusive = isExclusive});
        const std::int64_t before = device.passCount.emplace().passes;
        device.reduce(call);
        CHECK(device.passCount->passes - before == 1);
        std::vector<int> sums(x.size()), most(x.size());
        detail::read(second.region, sums.data(), sums.size());
        detail::read(first.region, most.data(), most.size());
        int s = 0, m = -2147483647 - 1;
        bool isRight = true;
        for (std::size_t i = 0; i < x.size(); ++i) {
          if (isExclusive) isRight = isRight && sums[i] == s && most[i] == m;
          s += x[i];
          m = std::max(m, y[i]);
          if (!isExclusive) isRight = isRight && sums[i] == s && most[i] == m;
        }
        CHECK(isRight);
      }
    }
  }
}

}  // namespace
}  // namespace sk
