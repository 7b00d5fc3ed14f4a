// SPDX-License-Identifier: MIT
//
// Promises: compute programs push and scatter as a loop over the elements does. Order::Any gives up the order of pushes, and which
// sums of floats are rounded, but nothing else. Calls ask for Target::Compute, which throws rather than draw.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "order.sk.hpp"
#include "support/configuration_file.hpp"
#include "support/devices.hpp"
#include "support/values.hpp"

namespace {

using namespace run_tests;
using sk::Order, sk::Target;

constexpr sk::CallOptions dispatched{.target = Target::Compute};
constexpr sk::CallOptions loosely{.target = Target::Compute, .order = Order::Any};

int valueOf(std::int64_t i) { return static_cast<int>((i * 7919) % 65536) - 32768; }

std::vector<int> values(std::int64_t count) {
  std::vector<int> list;
  for (std::int64_t i = 0; i < count; ++i) list.push_back(valueOf(i));
  return list;
}

std::vector<int> odd(const std::vector<int>& list) {
  std::vector<int> kept;
  for (const int x : list) {
    if ((x & 1) != 0) kept.push_back(x);
  }
  return kept;
}

std::vector<int> sorted(std::vector<int> list) {
  std::ranges::sort(list);
  return list;
}

/// Few targets, so that many elements meet.
std::vector<int> targets(std::int64_t count, int most) {
  std::vector<int> list;
  for (std::int64_t i = 0; i < count; ++i) list.push_back(static_cast<int>((i * 31) % most) - 1);
  return list;
}

}  // namespace

// A tile has 256 texels or more. 2^19 packed elements are 512 tiles, as many as a group scans at a time; 2^19 + 1 elements are
// not packed.
TEST_CASE("work groups push in order, and all of it in any order") {
  sk::Device& device = run_tests::device("glsl430");
  auto r = device.stream<int>({0});
  for (const std::int64_t size : {1, 4, 255, 257, 1024, (1 << 19) + 4, (1 << 19) + 1}) {
    INFO("size " << size);
    const std::vector<int> list = values(size);
    const auto x = streamOf<int>(device, list);
    order::keepOdd.with(dispatched)(x, r);
    CHECK(r.read() == odd(list));
    if (size > 1 << 19) continue;  // tiles that keep no order need no scan
    order::keepOdd.with(loosely)(x, r);
    CHECK(sorted(r.read()) == sorted(odd(list)));
  }
  auto plane = device.stream<int>({64, 52});
  const std::vector<int> list = values(plane.size());
  plane.write(list);
  order::keepOdd.with(dispatched)(plane, r);
  CHECK(r.read() == odd(list));
  order::keepOdd.with(dispatched)(plane.domain({3, 1}, {60, 50}), r);
  CHECK(r.read() == odd(plane.domain({3, 1}, {60, 50}).read()));
  order::keepOdd.with(dispatched)(r, r);
  CHECK(r.size() == static_cast<std::int64_t>(odd(plane.domain({3, 1}, {60, 50}).read()).size()));
}

TEST_CASE("kernels that push use library functions") {
  sk::Device& device = run_tests::device("glsl430");
  const auto at = streamOf<float>(device, {0.25F, 1.25F, 2.75F, 0.5F, 4});
  auto r = device.stream<float>({0});
  order::pick.with(dispatched)(at, at, r);
  CHECK(r.read() == std::vector<float>{1.25F, 0.5F, 4});
}

TEST_CASE("an output that nothing is pushed to is empty") {
  sk::Device& device = run_tests::device("glsl430");
  auto r = device.stream<int>({0}), nothing = device.stream<int>({3});
  order::pushTwice.with(dispatched)(streamOf<int>(device, {5, 6, 7}), r, nothing);
  CHECK(r.read() == std::vector<int>{5, -5, 6, -6, 7, -7});
  CHECK(nothing.size() == 0);
}

TEST_CASE("any order changes no number of pushes anywhere") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<int> list = values(20011);
    auto r = device.stream<int>({0});
    order::keepOdd.with({.order = Order::Any})(streamOf<int>(device, list), r);
    CHECK(sorted(r.read()) == sorted(odd(list)));
  });
}

TEST_CASE("pushes without a bound, beside others and elements") {
  sk::Device& device = run_tests::device("glsl430");
  for (const std::int64_t size : {1, 300, 5000}) {
    std::vector<sk::int2> list, kept;
    std::vector<int> copies, sums;
    for (std::int64_t i = 0; i < size; ++i) {
      const sk::int2 x = {valueOf(i), static_cast<int>(i * 5 % 23)};
      list.push_back(x);
      sums.push_back(x.x + x.y);
      if (x.x > 0) kept.push_back(x);
      for (int k = 0; k < (x.y & 7); ++k) copies.push_back(x.x + k);
    }
    auto r = device.stream<sk::int2>({0});
    auto s = device.stream<int>({7});
    auto t = device.stream<int>({size});
    for (const sk::CallOptions& options : {dispatched, loosely}) {
      order::divide.with(options)(streamOf<sk::int2>(device, list), r, s, t);
      CHECK(r.read() == kept);
      CHECK(sorted(s.read()) == sorted(copies));
      CHECK(t.read() == sums);
    }
    order::divide.with(dispatched)(streamOf<sk::int2>(device, list), r, s, t);
    CHECK(s.read() == copies);
  }
}

TEST_CASE("one push, beside elements and scatters") {
  sk::Device& device = run_tests::device("glsl430");
  for (const std::int64_t size : {3, 1024, 20001}) {
    INFO("size " << size);
    const std::vector<int> list = values(size);
    std::vector<int> twice, last(8, 1), sums(8, 1);
    std::vector<sk::float2> thirds;
    for (std::int64_t i = 0; i < size; ++i) {
      const int x = list[static_cast<std::size_t>(i)];
      twice.push_back(2 * x);
      if (x % 3 == 0) thirds.push_back({static_cast<float>(x), static_cast<float>(i)});
      last[static_cast<std::size_t>(x & 7)] = x;
      sums[static_cast<std::size_t>(x & 7)] += x;
    }
    const auto x = streamOf<int>(device, list);
    auto r = device.stream<int>({0});
    auto s = device.stream<sk::float2>({0});
    for (const sk::CallOptions& options : {dispatched, loosely}) {
      auto t = device.stream<int>({size});
      auto u = streamOf<int>(device, std::vector<int>(8, 1)),
           v = streamOf<int>(device, std::vector<int>(8, 1));
      order::sieve.with(options)(x, r, s, t, u, v);
      CHECK(t.read() == twice);
      CHECK(v.read() == sums);
      CHECK(sorted(r.read()) == sorted(odd(list)));
      CHECK(s.size() == static_cast<std::int64_t>(thirds.size()));
      if (options.order == Order::Any) continue;
      CHECK(r.read() == odd(list));
      CHECK(s.read() == thirds);
      CHECK(u.read() == last);
    }
  }
}

TEST_CASE("integers are combined atomically") {
  sk::Device& device = run_tests::device("glsl430");
  const std::vector<int> list = values(3001);
  std::vector<int> counts(16, 5), most(16, -10);
  std::vector<std::uint32_t> least(16, 4000000000u);
  auto r = streamOf<int>(device, counts), s = streamOf<int>(device, most);
  auto t = streamOf<std::uint32_t>(device, least);
  order::count.with(dispatched)(streamOf<int>(device, list), r, t, s);
  for (const int x : list) {
    const auto at = static_cast<std::size_t>(x & 15);
    --counts[at];
    most[at] = std::max(most[at], x);
    least[at] = std::min(least[at], static_cast<std::uint32_t>(x));
  }
  CHECK(r.read() == counts);
  CHECK(s.read() == most);
  CHECK(t.read() == least);
}

TEST_CASE("loops repeat dispatches that combine atomically") {
  sk::Device& device = run_tests::device("glsl430");
  std::vector<int> at(100);
  for (std::size_t i = 0; i < at.size(); ++i) at[i] = static_cast<int>(i % 7);
  const auto x = streamOf<int>(device, at);
  auto r = streamOf<int>(device, std::vector<int>(16, 0)), s = streamOf<int>(device, std::vector<int>(16, 0));
  auto t = streamOf<std::uint32_t>(device, std::vector<std::uint32_t>(16, 9));
  sk::Loop loop = device.record([&] { order::count.with(dispatched)(x, r, t, s); });
  loop.repeat(9);
  CHECK(r.read()[0] == -9 * 15);
  CHECK(r.read()[6] == -9 * 14);
  CHECK(s.read()[6] == 6);
}

TEST_CASE("the lowest and highest floats, with infinities, zeros and NaN") {
  sk::Device& device = run_tests::device("glsl430");
  constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> x = {1, -2, nan, 0.0F, -0.0F, inf, -inf, nan, 3e-45F, -3e-45F};
  const std::vector<int> at = {0, 0, 0, 1, 1, 2, 2, 3, 4, 4};
  const std::vector<float> before = {0.5F, 0.25F, 7, nan, 0, nan};
  auto low = streamOf<float>(device, before), high = streamOf<float>(device, before);
  order::lowest.with(dispatched)(streamOf<float>(device, x), streamOf<int>(device, at), low);
  order::highest.with(dispatched)(streamOf<float>(device, x), streamOf<int>(device, at), high);
  const std::vector<float> l = low.read(), h = high.read();
  CHECK(std::vector<float>(l.begin(), l.begin() + 3) == std::vector<float>{-2, -0.0F, -inf});
  CHECK(std::signbit(l[1]));
  CHECK(std::vector<float>(h.begin(), h.begin() + 3) == std::vector<float>{1, 0.25F, inf});
  CHECK((std::isnan(l[3]) && std::isnan(h[3]) && std::isnan(l[5])));
  CHECK((l[4] == -3e-45F && h[4] == 3e-45F));
}

TEST_CASE("the last store wins in compute programs, too") {
  sk::Device& device = run_tests::device("glsl430");
  const std::int64_t count = 4099;
  const std::vector<int> list = values(count);
  std::vector<sk::int2> at;
  std::vector<order::Mark> marks(6 * 5, {7, {8, 9}});
  std::vector<int> last(6, 3);
  for (std::int64_t i = 0; i < count; ++i) {
    at.push_back({static_cast<int>(i * 7 % 6), static_cast<int>(i * 3 % 7) - 1});
    if (at.back().y < 0 || at.back().y >= 5) {
      last[static_cast<std::size_t>(at.back().x)] = list[static_cast<std::size_t>(i)];
      continue;
    }
    const int x = list[static_cast<std::size_t>(i)];
    marks[static_cast<std::size_t>(at.back().y * 6 + at.back().x)] = {x, {static_cast<float>(x), 1}};
    last[static_cast<std::size_t>(at.back().x)] = x;
  }
  auto r = device.stream<order::Mark>({5, 6});
  r.write(std::vector<order::Mark>(30, {7, {8, 9}}));
  auto s = streamOf<int>(device, std::vector<int>(6, 3));
  order::mark.with(dispatched)(streamOf<int>(device, list), streamOf<sk::int2>(device, at), r, s);
  const std::vector<order::Mark> got = r.read();
  CHECK(std::ranges::equal(got, marks, [](const order::Mark& a, const order::Mark& b) {
    return a.id == b.id && a.value == b.value;
  }));
  CHECK(s.read() == last);
  // in any order, each element still stores whole structs
  order::mark.with(loosely)(streamOf<int>(device, list), streamOf<sk::int2>(device, at), r, s);
  for (const order::Mark& one : r.read()) CHECK(one.value.x == static_cast<float>(one.id));
}

TEST_CASE("a dispatch that reads what it stores to reads the old elements") {
  sk::Device& device = run_tests::device("glsl430");
  const std::vector<int> list = values(1000);
  auto r = streamOf<int>(device, list);
  order::turn.with(dispatched)(r, r, r);
  std::vector<int> turned;
  for (auto x = list.rbegin(); x != list.rend(); ++x) turned.push_back(2 * *x);
  CHECK(r.read() == turned);
}

TEST_CASE("floats are added in any order only where that is asked for") {
  const ConfigurationFile file("[kernels.\"order::add\"]\norder = \"any\"\n");
  onEveryTarget([&](sk::Device& device) {
    std::vector<float> x, sums(9, 1);
    const std::vector<int> at = targets(2000, 9);
    for (std::size_t i = 0; i < at.size(); ++i) {
      x.push_back(static_cast<float>(valueOf(static_cast<std::int64_t>(i)) >> 6));  // sums are exact
      if (at[i] >= 0) sums[static_cast<std::size_t>(at[i])] += x.back();
    }
    auto r = streamOf<float>(device, std::vector<float>(9, 1));
    order::add.with({.order = Order::Any})(streamOf<float>(device, x), streamOf<int>(device, at), r);
    CHECK(r.read() == sums);
  });
  sk::Device configured({.profile = "glsl430", .configuration = file.path});
  const auto y = streamOf<float>(configured, {1, 2});
  auto s = streamOf<float>(configured, {0, 0});
  order::add.with(dispatched)(y, streamOf<int>(configured, {1, 1}), s);
  CHECK(s.read() == std::vector<float>{0, 3});
}

// Sums are rounded at each step here, so that another order has other bits.
TEST_CASE("compute programs add floats in the order of the elements") {
  sk::Device& device = run_tests::device("glsl430");
  for (const auto& [size, bins] :
       {std::pair{1, 3}, {255, 7}, {4099, 1}, {70000, 300}, {70000, 70001}, {66000, 3}}) {
    INFO("size " << size << ", bins " << bins);
    const std::vector<int> at = targets(size, bins + 2);  // some of them outside
    std::vector<float> x, sums(static_cast<std::size_t>(bins), 0.1F);
    for (int i = 0; i < size; ++i) x.push_back(static_cast<float>(valueOf(i)) * 0.37F);
    const std::vector<float> before = sums;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (at[i] >= 0 && at[i] < bins) sums[static_cast<std::size_t>(at[i])] += x[i];
    }
    const auto xs = streamOf<float>(device, x);
    const auto ats = streamOf<int>(device, at);
    auto r = streamOf<float>(device, before), s = streamOf<float>(device, before);
    order::add.with(dispatched)(xs, ats, r);
    CHECK(r.read() == sums);
    if (size > 5000) continue;
    order::add.with({.target = Target::Fragment})(xs, ats, s);
    CHECK(s.read() == sums);
  }
}

TEST_CASE("compute programs combine vectors in the order of the elements, and in views") {
  sk::Device& device = run_tests::device("glsl430");
  const int size = 5003;
  std::vector<sk::float3> x, sums(6 * 9, {1, 2, 3});
  std::vector<sk::int2> at;
  std::vector<int> ints = values(size), line;
  std::vector<sk::float2> pairs, most(40, {-7, 0.5F});
  std::vector<sk::int4> least(40, {5, 6, 7, 8});
  for (int i = 0; i < size; ++i) {
    const float f = static_cast<float>(valueOf(i)) / 7;
    x.push_back({f, f / 3, -f});
    at.push_back({i * 7 % 8 - 1, i * 3 % 5});
    line.push_back(i * 11 % 42 - 1);
    pairs.push_back({f, -2 * f});
    if (at.back().x >= 0 && at.back().x < 6 && at.back().y < 4) {
      sk::float3& old = sums[static_cast<std::size_t>((at.back().y + 1) * 9 + at.back().x + 2)];
      old = {old.x + f, old.y + f / 3, old.z - f};
    }
    if (line.back() < 0 || line.back() >= 40) continue;
    const auto n = static_cast<std::size_t>(line.back());
    most[n] = {std::max(most[n].x, f), std::max(most[n].y, -2 * f)};
    const int v = ints[static_cast<std::size_t>(i)];
    least[n] = {std::min(least[n].x, v), std::min(least[n].y, -v), std::min(least[n].z, v + 1),
                std::min(least[n].w, v & 7)};
  }
  const auto lines = streamOf<int>(device, line);
  for (const Order kept : {Order::Kept, Order::Any}) {
    const sk::CallOptions options{.target = Target::Compute, .order = kept};
    auto r = device.stream<sk::float3>({6, 9});
    r.write(std::vector<sk::float3>(54, {1, 2, 3}));
    order::addVectors.with(options)(streamOf<sk::float3>(device, x), streamOf<sk::int2>(device, at),
                                    r.domain({1, 2}, {5, 8}));
    if (kept == Order::Kept) CHECK(r.read() == sums);
    if (kept == Order::Kept) {
      auto s = streamOf<sk::float2>(device, std::vector<sk::float2>(40, {-7, 0.5F}));
      order::highestVectors.with(options)(streamOf<sk::float2>(device, pairs), lines, s);
      CHECK(s.read() == most);
    }
    auto t = streamOf<sk::int4>(device, std::vector<sk::int4>(40, {5, 6, 7, 8}));
    order::lowestInts.with(options)(streamOf<int>(device, ints), lines, t);
    CHECK(t.read() == least);
  }
}

TEST_CASE("records of several outputs, of any number, beside pushes") {
  sk::Device& device = run_tests::device("glsl430");
  const int size = 3001;
  std::vector<int> n, odds;
  std::vector<float> sums(50), before;
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = static_cast<float>(i) / 9;
  before = sums;
  for (int i = 0; i < size; ++i) {
    n.push_back(i * 13 % 31);
    if (n.back() % 2 != 0) odds.push_back(n.back());
    for (int k = 0; k < (n.back() & 7); ++k)
      sums[static_cast<std::size_t>((i * 5 + k * 3) % 50)] +=
          before[static_cast<std::size_t>(k)] + 1.0F / static_cast<float>(n.back() + k + 1);
  }
  for (const Target target : {Target::Compute, Target::Fragment}) {
    auto r = streamOf<float>(device, before);
    auto odd = device.stream<int>({0});
    auto first = device.stream<float>({size});
    order::addOften.with({.target = target})(streamOf<int>(device, n), r, r, odd, first);
    CHECK(r.read() == sums);
    CHECK(odd.read() == odds);
    CHECK(first.read() == std::vector<float>(size, before[0]));
  }
  std::vector<std::vector<float>> results;
  std::vector<float> x;
  for (int i = 0; i < size; ++i) x.push_back(static_cast<float>(valueOf(i)) / 7);
  for (const Target target : {Target::Compute, Target::Fragment}) {
    auto r = streamOf<float>(device, before), s = streamOf<float>(device, before);
    order::addTwice.with({.target = target})(streamOf<float>(device, x),
                                             streamOf<int>(device, targets(size, 53)), r, s);
    results.push_back(r.read());
    results.push_back(s.read());
  }
  CHECK(results[0] == results[2]);
  CHECK(results[1] == results[3]);
}

TEST_CASE("what compute programs cannot scatter to is drawn, or refused") {
  sk::Device& device = run_tests::device("glsl430");
  const auto x = streamOf<int>(device, {0, 1, 2});
  auto r = streamOf<int>(device, {9, 9, 9, 9, 9, 9});
  order::both(x, r.domain({0}, {3}), r.domain({3}, {6}));  // two regions of one stream
  CHECK(r.read() == std::vector<int>{0, 1, 2, 0, -1, -2});
  CHECK_THROWS_WITH(order::both.with(dispatched)(x, r.domain({0}, {3}), r.domain({3}, {6})),
                    Catch::Contains("order::both") && Catch::Contains("regions of one stream"));
  sk::Device& layered = run_tests::device("glsl430", smallLimits[1]);
  const std::vector<int> list = values(200);
  auto s = layered.stream<int>({0});
  order::keepOdd(streamOf<int>(layered, list), s);
  CHECK(s.read() == odd(list));
  CHECK_THROWS_WITH(order::keepOdd.with(dispatched)(streamOf<int>(layered, list), s),
                    Catch::Contains("layers"));
}
