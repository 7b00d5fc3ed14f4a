// SPDX-License-Identifier: MIT
//
// Promises: sk::sort, order, unique and partition do what std::stable_sort, std::unique and std::stable_partition
// do, on every device, for every type of keys and values.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include <catch2/catch.hpp>

#include "algorithm.sk.hpp"
#include "error_of.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "support/streams.hpp"

namespace run_tests {
namespace {

using Catch::Matchers::Contains;

std::vector<int> iota(std::size_t count) {
  std::vector<int> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

template <class T>
bool isNan(T x) {
  return x != x;  // NOLINT: false for integers
}

template <class T>
std::vector<int> orderOf(const std::vector<T>& keys, bool isDescending) {
  std::vector<int> order = iota(keys.size());
  std::ranges::stable_sort(order, [&](int left, int right) {
    const T a = keys[static_cast<std::size_t>(left)], b = keys[static_cast<std::size_t>(right)];
    if (isNan(a) || isNan(b)) return !isNan(a) && isNan(b);
    return isDescending ? b < a : a < b;
  });
  return order;
}

template <class T>
std::vector<T> inOrder(const std::vector<T>& values, const std::vector<int>& order) {
  std::vector<T> result;
  for (const int i : order) result.push_back(values[static_cast<std::size_t>(i)]);
  return result;
}

/// Values by their bits, so that NaNs and zeros can be compared.
template <class T>
auto bitsOf(const std::vector<T>& values) {
  using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
  std::vector<Bits> bits;
  for (const T& value : values) bits.push_back(std::bit_cast<Bits>(value));
  return bits;
}

template <class T>
void checkSort(sk::Device& device, const std::vector<T>& keys, const sk::Shape& shape = {}) {
  for (const bool isDescending : {false, true}) {
    INFO(keys.size() << " keys, descending: " << isDescending);
    const std::vector<int> expected = orderOf(keys, isDescending);
    auto alone = streamOf(device, keys, shape), paired = streamOf(device, keys, shape);
    auto values = streamOf(device, iota(keys.size()), shape);
    CHECK(sk::order(alone, {.descending = isDescending}).read() == expected);
    sk::sort(alone, {.descending = isDescending});
    sk::sort(paired, values, {.descending = isDescending});
    CHECK(bitsOf(alone.read()) == bitsOf(inOrder(keys, expected)));
    CHECK(bitsOf(paired.read()) == bitsOf(inOrder(keys, expected)));
    CHECK(values.read() == expected);
  }
}

/// Keys of few distinct values and the extremes of the type.
template <class T>
std::vector<T> keysOf(std::size_t count, unsigned seed = 3) {
  using Limits = std::numeric_limits<T>;
  std::mt19937 random(seed);
  std::vector<T> special{Limits::lowest(), Limits::max(), T{0}, T{1}};
  if constexpr (std::is_floating_point_v<T>) {
    const T nan = Limits::quiet_NaN();
    special.insert(special.end(),
                   {-T{0}, nan, std::copysign(nan, T{-1}), Limits::infinity(), -Limits::infinity()});
  }
  std::vector<T> keys(count);
  for (T& key : keys) {
    const unsigned pick = random() % 32;
    key = pick < special.size() ? special[pick] : static_cast<T>(static_cast<int>(random() % 1000) - 500);
  }
  return keys;
}

TEST_CASE("keys of any length are sorted, with values or without, and equal keys keep their order") {
  onEveryTarget([](sk::Device& device) {
    for (const std::size_t n : {0U, 1U, 2U, 13U, 4099U, 40009U}) checkSort(device, keysOf<float>(n));
    checkSort(device, keysOf<int>(4099));
    checkSort(device, keysOf<std::uint32_t>(4099));
    checkSort(device, keysOf<double>(4099));
  });
}

TEST_CASE("sorted, reversed and equal keys are sorted") {
  onEveryTarget([](sk::Device& device) {
    std::vector<int> keys = iota(3001);
    checkSort(device, keys);
    std::ranges::reverse(keys);
    checkSort(device, keys);
    checkSort(device, std::vector<int>(3001, 7));
  });
}

TEST_CASE("streams of any rank are sorted as rows, and views without what is around them") {
  onEveryTarget([](sk::Device& device) {
    checkSort(device, keysOf<int>(24 * 31), {24, 31});
    checkSort(device, keysOf<float>(5 * 6 * 7), {5, 6, 7});
    const std::vector<int> all = keysOf<int>(20 * 30);
    auto keys = streamOf(device, all, {20, 30});
    const auto part = keys.domain({2, 3}, {11, 25});
    const std::vector<int> inside = part.read();
    sk::sort(part);
    CHECK(part.read() == inOrder(inside, orderOf(inside, false)));
    keys.domain({2, 3}, {11, 25}).write(inside);
    CHECK(keys.read() == all);  // all else is as it was
  });
}

TEST_CASE("values of any element type follow their keys") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<int> keys = keysOf<int>(997), order = orderOf(keys, false);
    std::vector<algorithms::Particle> particles;
    std::vector<std::uint8_t> bools;
    for (int i = 0; i < 997; ++i) {
      particles.push_back({{0.5F * static_cast<float>(i), 1.0F, 2.0F}, i});
      bools.push_back(static_cast<std::uint8_t>(i % 3 == 0));
    }
    auto k = streamOf(device, keys), same = streamOf(device, keys);
    auto structs = streamOf(device, particles);
    auto flags = device.stream<bool>({997});
    flags.write(bools);
    sk::sort(k, structs);
    sk::sort(same, flags);
    std::vector<int> ids, places;
    for (const algorithms::Particle& p : structs.read()) {
      ids.push_back(p.id);
      places.push_back(static_cast<int>(2 * p.position.x));
    }
    CHECK(ids == order);
    CHECK(places == order);
    CHECK(flags.read() == inOrder(bools, order));
  });
}

TEST_CASE("keys are compared as they are stored") {
  for (sk::Device* on : {&device("glsl330"), &device("native")}) {
    const std::vector<float> close{1.0F, 1.0001F, 0.5F};  // the first two are one half
    auto halves = streamOf(*on, close, {}, sk::Storage::Half);
    CHECK(sk::order(halves, {.descending = true}).read() == std::vector<int>{0, 1, 2});
  }
  sk::Device reference = sk::Device::reference();
  auto keys = reference.stream<float>({2});
  keys.writeReals(std::vector<double>{1 + 1e-12, 1});
  sk::sort(keys);
  CHECK(keys.readReals() == std::vector<double>{1, 1 + 1e-12});
}

TEST_CASE("unique brings the first of equal neighbours to the front") {
  onEveryTarget([](sk::Device& device) {
    for (const std::size_t n : {0U, 1U, 4099U}) {
      std::vector<float> keys = keysOf<float>(n);
      for (std::size_t i = 1; i < n; ++i) keys[i] = i % 3 == 0 ? keys[i] : keys[i - 1];
      auto stream = streamOf(device, keys);
      auto values = streamOf(device, iota(n));
      const auto count = static_cast<std::size_t>(sk::unique(stream, values));
      std::vector<float> expected = keys, got = stream.read();
      expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
      REQUIRE(count == expected.size());
      CHECK(bitsOf(inOrder(keys, values.read())) == bitsOf(got));
      got.resize(count);
      CHECK(bitsOf(got) == bitsOf(expected));
    }
    auto alone = streamOf<int>(device, {1, 1, 2, 2, 1});
    CHECK(sk::unique(alone) == 3);
    CHECK(alone.read() == std::vector<int>{1, 2, 1, 1, 2});
  });
}

TEST_CASE("partition brings flagged values to the front in their order") {
  onEveryTarget([](sk::Device& device) {
    for (const std::size_t n : {0U, 1U, 2U, 4099U}) {
      const std::vector<int> flags = keysOf<int>(n);
      std::vector<std::uint8_t> bools;
      for (const int flag : flags) bools.push_back(static_cast<std::uint8_t>(flag % 2 != 0));
      std::vector<int> odd = iota(n), nonzero = odd;
      const auto index = [](int i) { return static_cast<std::size_t>(i); };
      const auto odds = std::ranges::stable_partition(odd, [&](int i) { return bools[index(i)] != 0; });
      const auto rest = std::ranges::stable_partition(nonzero, [&](int i) { return flags[index(i)] != 0; });
      auto marks = device.stream<bool>({static_cast<std::int64_t>(n)});
      marks.write(bools);
      auto values = streamOf(device, iota(n)), others = streamOf(device, iota(n));
      CHECK(sk::partition(marks, values) == static_cast<std::int64_t>(n - odds.size()));
      CHECK(values.read() == odd);
      CHECK(sk::partition(streamOf(device, flags), others) == static_cast<std::int64_t>(n - rest.size()));
      CHECK(others.read() == nonzero);
    }
  });
}

template <class S>
concept CanSort = requires(S&& s) { sk::sort(s); };
static_assert(CanSort<sk::Stream<int>&> && CanSort<sk::View<double>> && CanSort<const sk::View<float>&>);
static_assert(!CanSort<const sk::Stream<int>&> && !CanSort<sk::View<const int>>);
static_assert(!CanSort<sk::Stream<bool>&> && !CanSort<sk::Stream<sk::float2>&>);

TEST_CASE("calls of algorithms that make no sense are errors") {
  sk::Device& gl = device("glsl330");
  sk::Device& native = device("native");
  auto keys = streamOf<int>(gl, {3, 1, 2});
  auto few = streamOf<int>(gl, {1, 2});
  auto elsewhere = streamOf<int>(native, {1, 2, 3});
  sk::Stream<int> none;
  CHECK_THAT(errorOf([&] { sk::sort(keys, few); }), Contains("sk::sort: keys have shape {3}, values {2}"));
  CHECK_THAT(errorOf([&] { sk::sort(keys, elsewhere); }), Contains("different devices"));
  CHECK_THAT(errorOf([&] { sk::sort(keys, keys); }), Contains("the same stream"));
  CHECK_THAT(errorOf([&] { sk::sort(none); }), Contains("sk::sort: there is no stream"));
  CHECK_THAT(errorOf([&] { sk::order(none); }), Contains("sk::order: there is no stream"));
  CHECK_THAT(errorOf([&] { sk::unique(keys, few); }), Contains("sk::unique: keys have shape"));
  CHECK_THAT(errorOf([&] { sk::partition(keys, few); }), Contains("sk::partition: flags have shape"));
  CHECK_THAT(errorOf([&] { gl.record([&] { sk::sort(keys); }); }),
             Contains("sk::sort: the device is recording"));
  CHECK(keys.read() == std::vector<int>{3, 1, 2});
}

}  // namespace
}  // namespace run_tests
