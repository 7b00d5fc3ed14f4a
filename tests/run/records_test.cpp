// SPDX-License-Identifier: MIT
//
// Promises: pushes and scatters of elements in lanes keep the order of a loop over the elements, whatever path each element
// takes, and whatever the number of lanes and threads (CMakeLists.txt runs this with several).
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "records.sk.hpp"
#include "sk/sk.hpp"

namespace {

constexpr std::int64_t sizes[] = {0, 1, 2, 7, 31, 64, 257, 1009, 4099, 70001, 600011};

/// Pseudorandom numbers below `limit`.
std::vector<int> someInts(std::int64_t count, int limit, std::uint32_t seed = 1) {
  std::vector<int> values(static_cast<std::size_t>(count));
  for (int& value : values) {
    seed = seed * 1664525U + 1013904223U;
    value = static_cast<int>((seed >> 8) % static_cast<std::uint32_t>(limit));
  }
  return values;
}

std::vector<float> someFloats(std::int64_t count) {
  std::vector<float> values;
  for (const int value : someInts(count, 1 << 20, 7)) values.push_back(std::sin(static_cast<float>(value)));
  return values;
}

template <class T>
sk::Stream<T> streamOf(sk::Device& device, const std::vector<T>& values) {
  auto stream = device.stream<T>({static_cast<std::int64_t>(values.size())});
  stream.write(values);
  return stream;
}

template <class T>
bool haveSameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

// ---- pushes ----------------------------------------------------------------------------------------

TEST_CASE("a stream that is pushed to again has room for more, or less") {
  sk::Device device = sk::Device::native();
  auto r = device.stream<int>({0});
  for (const std::int64_t size : {70001, 5, 0, 600011, 64}) {
    std::vector<int> x = someInts(size, 1000);
    keepSome(streamOf(device, x), r);
    std::erase_if(x, [](int value) { return value % 5 == 3; });
    REQUIRE(haveSameBits(r.read(), x));
    keepSome(r, r);  // keeps all, and reads what it replaces
    REQUIRE(haveSameBits(r.read(), x));
  }
}

TEST_CASE("one push for some of the elements") {
  sk::Device device = sk::Device::native();
  for (const std::int64_t size : sizes) {
    const std::vector<int> x = someInts(size, 1000);
    std::vector<int> expected;
    std::ranges::copy_if(x, std::back_inserter(expected), [](int value) { return value % 5 != 3; });
    auto r = device.stream<int>({0});
    keepSome(streamOf(device, x), r);
    CAPTURE(size);
    CHECK(haveSameBits(r.read(), expected));
  }
}

void walkOne(int x, std::vector<int>& r, std::vector<sk::float2>& s) {
  const int n = x % 7;
  for (int k = 0; k < n; ++k) {
    if (k == 3 && (x & 8) != 0) continue;
    r.push_back(x * 16 + k);
    switch ((x + k) % 4) {
      case 0: s.push_back({static_cast<float>(x), static_cast<float>(k)}); break;
      case 1: r.push_back(-k); [[fallthrough]];
      case 2: s.push_back({static_cast<float>(k), -1}); break;
      default:
        if (k > 4) return;
    }
    if (k == 5 && (x & 16) != 0) break;
    for (int j = 0; j < (x >> k & 3); ++j) r.push_back(j);
  }
  r.push_back(-x);
}

TEST_CASE("pushes in loops of different lengths, switches and after early returns") {
  sk::Device device = sk::Device::native();
  for (const std::int64_t size : sizes) {
    const std::vector<int> x = someInts(size, 5000);
    std::vector<int> r;
    std::vector<sk::float2> s;
    for (const int value : x) walkOne(value, r, s);
    auto rs = device.stream<int>({0});
    auto ss = device.stream<sk::float2>({0});
    walk(streamOf(device, x), rs, ss);
    CAPTURE(size);
    CHECK(haveSameBits(rs.read(), r));
    CHECK(haveSameBits(ss.read(), s));
  }
}

TEST_CASE("rows of a view are pushed one after the other") {
  sk::Device device = sk::Device::native();
  const std::int64_t width = 53, height = 40;
  const std::vector<int> x = someInts(width * height, 5000);
  auto stream = device.stream<int>({height, width});
  stream.write(x);
  std::vector<int> r;
  std::vector<sk::float2> s;
  for (std::int64_t row = 2; row < 39; ++row) {
    for (std::int64_t i = 3; i < 50; ++i) walkOne(x[static_cast<std::size_t>(row * width + i)], r, s);
  }
  auto rs = device.stream<int>({0});
  auto ss = device.stream<sk::float2>({0});
  walk(stream.domain({2, 3}, {39, 50}), rs, ss);
  CHECK(haveSameBits(rs.read(), r));
  CHECK(haveSameBits(ss.read(), s));
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

/// Limits how many bytes of address space the process may add while this object lives.
class MemoryLimit {
 public:
  explicit MemoryLimit(std::size_t more) {
    getrlimit(RLIMIT_AS, &before_);
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlimit limit{pages * 4096 + more, before_.rlim_max};
    setrlimit(RLIMIT_AS, &limit);
  }
  ~MemoryLimit() { setrlimit(RLIMIT_AS, &before_); }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  rlimit before_{};
};

TEST_CASE("pushes that find no memory throw, and the next call works") {
  sk::Device device = sk::Device::native();
  const std::vector<int> counts(64, 1 << 28);
  const auto count = streamOf(device, counts);
  const auto three = streamOf(device, std::vector<int>{3});
  auto r = device.stream<sk::float4>({0});
  endless(three, r);  // makes the allocations that happen only once
  {
    const MemoryLimit limit(std::size_t{1} << 28);
    CHECK_THROWS_WITH(endless(count, r), Catch::Contains("endless: there is no host memory for "));
  }
  CHECK(r.size() == 3);
  endless(streamOf(device, std::vector<int>{1, 2}), r);
  CHECK(haveSameBits(r.read(), {sk::float4{0, 0, 0, 0}, sk::float4{0, 0, 0, 0}, sk::float4{1, 1, 1, 1}}));
}

#endif

// ---- scatters --------------------------------------------------------------------------------------

/// Calls store(i, at[i]) for each element i whose index is in [0, count).
template <class Store>
void forEachInside(const std::vector<int>& at, std::size_t count, Store&& store) {
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (at[i] >= 0 && static_cast<std::size_t>(at[i]) < count) store(i, static_cast<std::size_t>(at[i]));
  }
}

/// Indices of which some are outside: far away, just before the first element, or just after the last.
std::vector<int> someIndices(std::int64_t count, int limit) {
  std::vector<int> at = someInts(count, limit + 2);
  for (std::size_t i = 0; i < at.size(); ++i) {
    --at[i];
    if (i % 101 == 100) at[i] = std::numeric_limits<int>::max() - static_cast<int>(i % 3);
    if (i % 103 == 102) at[i] = std::numeric_limits<int>::min() + static_cast<int>(i % 3);
  }
  return at;
}

TEST_CASE("collisions have the bits of a loop") {
  sk::Device device = sk::Device::native();
  for (const std::int64_t size : sizes) {
    for (const int bins : {1, 3, 256, 100003}) {
      CAPTURE(size, bins);
      const auto count = static_cast<std::size_t>(bins);
      const std::vector<int> at = someIndices(size, bins);
      const std::vector<float> x = someFloats(size);
      const auto ats = streamOf(device, at);
      const auto xs = streamOf(device, x);

      std::vector<float> sums(count, 0.5F), low(count, 0.25F);
      std::vector<sk::int2> last(count, sk::int2{-1, -2}), pairs;
      for (int i = 0; i < size; ++i) pairs.push_back({i, -i});
      auto sumStream = streamOf(device, sums);
      auto lowStream = streamOf(device, low);
      auto lastStream = streamOf(device, last);
      forEachInside(at, count, [&](std::size_t i, std::size_t to) {
        sums[to] += x[i];
        low[to] = std::fmin(low[to], x[i]);
        last[to] = pairs[i];
      });
      addFloats(ats, xs, sumStream);
      lowest(ats, xs, lowStream);
      storeLast(ats, streamOf(device, pairs), lastStream);
      CHECK(haveSameBits(sumStream.read(), sums));
      CHECK(haveSameBits(lowStream.read(), low));
      CHECK(haveSameBits(lastStream.read(), last));
    }
  }
}

TEST_CASE("narrow elements are stored in order, too") {
  sk::Device device = sk::Device::native();
  const std::vector<int> at = someIndices(70001, 50);
  std::vector<sk::half> x, last(50, sk::half(-2.0F));
  for (const float value : someFloats(70001)) x.emplace_back(value);
  auto stream = streamOf(device, last);
  forEachInside(at, 50, [&](std::size_t i, std::size_t to) { last[to] = x[i]; });
  storeHalves(streamOf(device, at), streamOf(device, x), stream);
  CHECK(haveSameBits(stream.read(), last));
}

struct AllTargets {
  std::vector<float> total = std::vector<float>(150, 0);
  std::vector<int> last = std::vector<int>(97, -1);
  std::vector<sk::float2> least = std::vector<sk::float2>(120, sk::float2{9, 9});
  std::vector<int> most = std::vector<int>(5 * 90, -5);
  std::vector<int> pushed;

  void scatter(std::size_t i, int at, float x) {
    const auto add = [&](int to, float value) {
      if (to >= 0 && to < 150) total[static_cast<std::size_t>(to)] += value;
    };
    for (int k = 0; k < (at & 3); ++k) {
      add(at + k, x + static_cast<float>(k));
      last[static_cast<std::size_t>((at + k * 5) % 97)] = static_cast<int>(i) * 4 + k;
      if (x < 0) continue;
      if (at < 120) {
        sk::float2& to = least[static_cast<std::size_t>(at)];
        to = {std::fmin(to.x, x), std::fmin(to.y, -x * static_cast<float>(k))};
      }
      pushed.push_back(at * 4 + k);
    }
    if (at >= 20 && at < 110) {
      int& to = most[static_cast<std::size_t>(at % 5 * 90 + at - 20)];
      to = std::max(to, static_cast<int>(x * 1000.0F));
    }
    add(3, x);
  }
};

TEST_CASE("several scatters and pushes in loops, in the order of elements") {
  sk::Device device = sk::Device::native();
  for (const std::int64_t size : sizes) {
    CAPTURE(size);
    const std::vector<int> at = someInts(size, 140);
    const std::vector<float> x = someFloats(size);
    AllTargets expected;
    auto total = streamOf(device, expected.total);
    auto last = streamOf(device, expected.last);
    auto least = streamOf(device, expected.least);
    auto most = device.stream<int>({5, 90});
    most.write(expected.most);
    auto pushed = device.stream<int>({0});
    for (std::size_t i = 0; i < at.size(); ++i) expected.scatter(i, at[i], x[i]);
    scatterAll(streamOf(device, at), streamOf(device, x), total, last, least, most, pushed);
    CHECK(haveSameBits(total.read(), expected.total));
    CHECK(haveSameBits(last.read(), expected.last));
    CHECK(haveSameBits(least.read(), expected.least));
    CHECK(haveSameBits(most.read(), expected.most));
    CHECK(haveSameBits(pushed.read(), expected.pushed));
  }
}

TEST_CASE("a view of a stream is written at its own indices") {
  sk::Device device = sk::Device::native();
  const std::int64_t width = 70, height = 50;
  std::vector<int> expected(static_cast<std::size_t>(width * height), -1);
  auto target = device.stream<int>({height, width});
  target.write(expected);
  const std::vector<int> at = someIndices(40000, 45);
  std::vector<int> x;
  for (int i = 0; i < 40000; ++i) x.push_back(i);
  forEachInside(at, 40, [&](std::size_t i, std::size_t to) {
    const std::int64_t column = static_cast<std::int64_t>(to) / 2;
    if (column < 15)
      expected[static_cast<std::size_t>((static_cast<std::int64_t>(to) + 5) * width + column + 30)] = x[i];
  });
  storeFar(streamOf(device, at), streamOf(device, x), target.domain({5, 30}, {45, 45}));
  CHECK(haveSameBits(target.read(), expected));
}

}  // namespace
