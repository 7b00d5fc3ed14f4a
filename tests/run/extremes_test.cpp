// SPDX-License-Identifier: MIT
//
// Promises: scans, pushes, sorts and rows are exact beyond 2^24 elements, where floats cannot count any more, and of any
// number of rows and whatever these hold; and a loop ends with its first iteration or at `most`.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include <catch2/catch.hpp>

#include "extremes.sk.hpp"
#include "sk/algorithm.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "support/streams.hpp"

namespace run_tests {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
constexpr std::int64_t many = (std::int64_t{1} << 24) + 1;

TEST_CASE("more elements than floats can count are scanned, pushed and sorted") {
  sk::Device& native = device("native");
  auto x = native.stream<int>({many}), y = native.stream<int>({many});
  x.fill(1);
  extremes::prefix(x, y);
  std::vector<int> numbers(static_cast<std::size_t>(many));
  std::iota(numbers.begin(), numbers.end(), 1);
  CHECK(y.read() == numbers);
  auto kept = native.stream<int>({0});
  extremes::keep(y, kept);
  const std::vector<int> third = kept.read();
  REQUIRE(std::ssize(third) == many / 3);
  CHECK(std::ranges::all_of(third, [next = 0](int value) mutable { return value == (next += 3); }));
  // an odd factor gives all values of the lowest bits, once; most of the time goes into digits that differ
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = static_cast<int>((static_cast<std::uint32_t>(i) * 40503u) & 0xffffu);
  y.write(numbers);
  sk::sort(y);
  const std::vector<int> sorted = y.read();
  CHECK(std::ranges::is_sorted(sorted));
  // 2^24 + 1 elements: each of the 2^16 values 2^8 times, and 0 once more
  CHECK(sorted[256] == 0);
  CHECK(sorted[257] == 1);
  CHECK(sorted.back() == 0xffff);
}

TEST_CASE("a million rows without elements, and one row with all") {
  constexpr std::int64_t rows = 1'000'000;
  onEveryTarget([](sk::Device& device) {
    std::vector<std::int32_t> starts(rows + 1, 0);
    std::fill(starts.begin() + rows / 3 + 1, starts.end(), 100003);
    const sk::Rows one(streamOf(device, starts));
    auto x = device.stream<int>({100003}), out = device.stream<int>({rows});
    x.fill(1);
    extremes::total(one(x), out);
    std::vector<int> expected(rows);
    expected[rows / 3] = 100003;
    CHECK(out.read() == expected);
    const sk::Rows none(streamOf(device, std::vector<std::int32_t>(rows + 1, 100003)));
    out.fill(7);
    extremes::total(none(x), out);
    CHECK(out.read() == std::vector<int>(rows));
  });
}

TEST_CASE("keys that are all NaN, infinite, or zeros of both signs are sorted") {
  onEveryTarget([](sk::Device& device) {
    for (const auto& [a, b] : {std::pair{nan, nan}, {inf, -inf}, {-0.0F, 0.0F}, {nan, -0.0F}}) {
      INFO(a << " and " << b);
      std::vector<float> list(5003);
      for (std::size_t i = 0; i < list.size(); ++i) list[i] = i % 3 == 0 ? a : b;
      const auto comesFirst = [](float p, float q) { return p < q || (std::isnan(q) && !std::isnan(p)); };
      std::vector<int> places(list.size());
      std::iota(places.begin(), places.end(), 0);
      auto keys = streamOf(device, list);
      auto values = streamOf(device, places);
      sk::sort(keys, values);
      std::ranges::stable_sort(places, [&](int p, int q) {
        return comesFirst(list[static_cast<std::size_t>(p)], list[static_cast<std::size_t>(q)]);
      });
      CHECK(values.read() == places);  // equal keys keep their order
    }
  });
}

TEST_CASE("a loop ends with its first iteration, or at most") {
  onEveryTarget([](sk::Device& device) {
    auto x = device.stream<int>({5});
    auto done = device.scalar<bool>();
    auto steps = device.scalar<int>(0), last = device.scalar<int>(1);
    sk::Loop loop = device.record([&] {
      extremes::add(1, x, x);
      steps += 1;
      done = steps == last;
    });
    x.fill(0);
    CHECK(loop.until(done, {.every = 5, .most = 1000}) == 1);
    CHECK(x.read() == std::vector<int>(5, 1));
    last.assign(-1);  // never
    CHECK(loop.until(done, {.every = 5, .most = 33}) == 33);
    CHECK(loop.until(done, {.every = 50, .most = 1}) == 1);
    CHECK(x.read() == std::vector<int>(5, 35));
  });
}

}  // namespace
}  // namespace run_tests
