// SPDX-License-Identifier: MIT
//
// bitonic_sort.sk against std::sort and std::stable_sort, exactly.
#include "programs/bitonic_sort.sk.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;

namespace {

/// Sorts floats or items in place.
template <class T>
void sort(sk::Stream<T>& items) {
  const auto n = static_cast<int>(items.size());
  for (int run = 1; run < n; run *= 2) {
    bitonic_sort::exchange(2 * run - 1, items,
                           items);   // compares each element with its mirror image in the other run
    for (int distance = run / 2; distance > 0; distance /= 2) {
      bitonic_sort::exchange(distance, items, items);
    }
  }
}

const std::vector<std::int64_t> sizes = {0, 1, 2, 3, 7, 8, 63, 64, 65, 256, 1021};

}  // namespace

TEST_CASE("bitonic sort: keys of every length are sorted") {
  onDrawnLayouts([](sk::Device& device) {
    for (const std::int64_t n : sizes) {
      INFO(n << " keys");
      auto keys = values<float>(n);
      auto stream = streamOf<float>(device, keys);
      sort(stream);
      std::sort(keys.begin(), keys.end());
      CHECK(difference(stream.read(), keys) == "");
    }
  });
}

TEST_CASE("bitonic sort: more keys than a row of a texture has texels") {
  sk::Device& es = device("essl300");
  auto keys = values<float>(20011);
  auto stream = streamOf<float>(es, keys);
  sort(stream);
  std::sort(keys.begin(), keys.end());
  CHECK(difference(stream.read(), keys) == "");
}

TEST_CASE("bitonic sort: equal keys keep their order") {
  onDrawnLayouts([](sk::Device& device) {
    for (const std::int64_t n : sizes) {
      INFO(n << " items");
      std::vector<float> keys;
      std::vector<bitonic_sort::Item> items;
      for (int i = 0; i < n; ++i) {
        keys.push_back(static_cast<float>(hashed(static_cast<std::uint32_t>(i)) % 10));
        items.push_back({keys.back(), i});
      }
      auto stream = device.stream<bitonic_sort::Item>({n});
      bitonic_sort::number(streamOf<float>(device, keys), stream);
      sort(stream);
      std::stable_sort(items.begin(), items.end(), [](auto a, auto b) { return a.key < b.key; });
      const auto sorted = stream.read();
      REQUIRE(sorted.size() == items.size());
      for (std::size_t i = 0; i < items.size(); ++i) {
        CHECK(sorted[i].key == items[i].key);
        CHECK(sorted[i].id == items[i].id);
      }
    }
  });
}

TEST_CASE("bitonic sort: NaN comes last, and nothing is lost") {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  auto keys = values<float>(203);
  const float special[] = {nan, 0.0f, inf, -0.0f, nan, -inf, 3e38f, nan};
  for (std::size_t i = 0; i < keys.size(); i += 5) keys[i] = special[i / 5 % 8];
  auto sorted = keys;
  // totalOrder of IEEE 754, with positive NaN only: -0 precedes 0, and NaN is the largest.
  std::sort(sorted.begin(), sorted.end(), [](float a, float b) {
    if (std::isnan(a) || std::isnan(b)) return !std::isnan(a) && std::isnan(b);
    return a < b || (a == b && std::signbit(a) && !std::signbit(b));
  });
  onDrawnLayouts([&](sk::Device& device) {
    auto stream = streamOf<float>(device, keys);
    sort(stream);
    const auto result = stream.read();
    CHECK(difference(result, sorted) == "");
    CHECK(std::equal(result.begin(), result.end(), sorted.begin(), [](float a, float b) {
      return std::isnan(a) ? std::isnan(b) : std::bit_cast<int>(a) == std::bit_cast<int>(b);
    }));
  });
}
