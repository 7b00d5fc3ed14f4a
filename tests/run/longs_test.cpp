// SPDX-License-Identifier: MIT
//
// Integers of 64 bits against C++'s: the operators for every pair of numbers near the limits of 8 to 64 bits, conversions, functions,
// and longs as elements, uniforms, members, indices, cases and counters.
#include "longs.sk.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "sk/algorithm.hpp"
#include "support/double_configs.hpp"
#include "support/values.hpp"

using namespace run_tests;

namespace {

using Long = std::int64_t;
using Ulong = std::uint64_t;

/// Numbers beside powers of two, where words, signs and carries change.
std::vector<Long> extremes() {
  std::vector<Long> list = {0, 7, -7, 1'000'000'007, -6'700'417, 0x123456789abcdef0, 0x7edcba9876543210};
  for (const int bit : {0, 1, 8, 24, 31, 32, 33, 53, 62, 63}) {
    const Ulong power = Ulong{1} << bit;
    for (const Ulong near : {power - 1, power, power + 1, 0 - power, 1 - power})
      list.push_back(static_cast<Long>(near));
  }
  return list;
}

/// All pairs of extremes.
struct Pairs {
  std::vector<Long> a, b;
  Pairs() {
    for (const Long x : extremes()) {
      for (const Long y : extremes()) {
        a.push_back(x);
        b.push_back(y);
      }
    }
  }
  std::int64_t size() const { return static_cast<std::int64_t>(a.size()); }
};

std::vector<Ulong> asUnsigned(const std::vector<Long>& list) { return {list.begin(), list.end()}; }
Long wrapped(Ulong value) { return static_cast<Long>(value); }

constexpr Long square = 1'000'000'000'000;
constexpr Long least = std::numeric_limits<Long>::min();

/// As docs/language.md defines it.
Long quotient(Long a, Long b) { return b == 0 ? a : b == -1 ? wrapped(0 - static_cast<Ulong>(a)) : a / b; }
Long remainderOf(Long a, Long b) { return b == 0 || b == -1 ? 0 : a % b; }

std::pair<Ulong, Ulong> product(Ulong a, Ulong b) {
  const Ulong a0 = a & 0xffffffff, a1 = a >> 32, b0 = b & 0xffffffff, b1 = b >> 32;
  const Ulong middle = a1 * b0 + (a0 * b0 >> 32), other = a0 * b1 + (middle & 0xffffffff);
  return {a * b, a1 * b1 + (middle >> 32) + (other >> 32)};
}

template <class T, class F>
void checkEach(const std::vector<T>& actual, const Pairs& pairs, F&& expected) {
  for (std::size_t i = 0; i < actual.size(); ++i) {
    if (actual[i] == expected(pairs.a[i], pairs.b[i])) continue;
    INFO(pairs.a[i] << " and " << pairs.b[i]);
    CHECK(actual[i] == expected(pairs.a[i], pairs.b[i]));
  }
}

template <class T>
std::vector<sk::Stream<T>> streams(sk::Device& device, int count, std::int64_t size) {
  std::vector<sk::Stream<T>> list;
  for (int i = 0; i < count; ++i) list.push_back(device.stream<T>({size}));
  return list;
}

}  // namespace

TEST_CASE("longs are computed as in C++, and wrap") {
  const Pairs pairs;
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto a = streamOf<Long>(device, pairs.a), b = streamOf<Long>(device, pairs.b);
    auto r = streams<Long>(device, 8, pairs.size());
    longs::arithmetic(a, b, r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7]);
    checkEach(r[0].read(), pairs, [](Ulong x, Ulong y) { return wrapped(x + y); });
    checkEach(r[1].read(), pairs, [](Ulong x, Ulong y) { return wrapped(x - y); });
    checkEach(r[2].read(), pairs, [](Ulong x, Ulong y) { return wrapped(x * y); });
    checkEach(r[3].read(), pairs, quotient);
    checkEach(r[4].read(), pairs, remainderOf);
    checkEach(r[5].read(), pairs, [](Long x, Long y) { return x & y; });
    checkEach(r[6].read(), pairs, [](Long x, Long y) { return x | y; });
    checkEach(r[7].read(), pairs, [](Long x, Long y) { return x ^ y; });
  });
}

TEST_CASE("ulongs are computed as in C++, and wrap") {
  const Pairs pairs;
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto a = streamOf<Ulong>(device, asUnsigned(pairs.a)), b = streamOf<Ulong>(device, asUnsigned(pairs.b));
    auto r = streams<Ulong>(device, 5, pairs.size());
    longs::unsignedArithmetic(a, b, r[0], r[1], r[2], r[3], r[4]);
    checkEach(r[0].read(), pairs, [](Ulong x, Ulong y) { return x + y; });
    checkEach(r[1].read(), pairs, [](Ulong x, Ulong y) { return x - y; });
    checkEach(r[2].read(), pairs, [](Ulong x, Ulong y) { return x * y; });
    checkEach(r[3].read(), pairs, [](Ulong x, Ulong y) { return y == 0 ? x : x / y; });
    checkEach(r[4].read(), pairs, [](Ulong x, Ulong y) { return y == 0 ? 0 : x % y; });
  });
}

TEST_CASE("longs are divided by literals") {
  std::vector<Long> a = extremes();
  for (std::uint32_t i = 0; i < 200; ++i) a.push_back(wrapped(Ulong{hashed(i)} << 32 | hashed(i + 500)));
  const auto size = static_cast<std::int64_t>(a.size());
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto r = streams<sk::long2>(device, 3, size);
    auto u = streams<sk::ulong2>(device, 2, size);
    longs::byLiterals(streamOf<Long>(device, a), streamOf<Ulong>(device, asUnsigned(a)), r[0], r[1], r[2],
                      u[0], u[1]);
    const auto seven = r[0].read(), large = r[1].read(), negative = r[2].read();
    const auto day = u[0].read(), most = u[1].read();
    for (std::size_t i = 0; i < a.size(); ++i) {
      INFO(a[i]);
      const auto bits = static_cast<Ulong>(a[i]);
      CHECK((seven[i] == sk::long2{a[i] / 7, a[i] % 7}));
      CHECK((large[i] == sk::long2{a[i] / 16777216, (a[i] >> 3) / 16777216 + a[i] % 16777217}));
      CHECK((negative[i] == sk::long2{a[i] / -10, a[i] % -10}));
      CHECK((day[i] == sk::ulong2{bits / 86400, bits % 86400}));
      CHECK((most[i] == sk::ulong2{bits / 16777215, bits % 16777215}));
    }
  });
}

TEST_CASE("offsets of neighbors and rows of matrices saturate to the nearest one") {
  const std::vector<Long> by = {1, Long{1} << 32, -(Long{1} << 32), Long{1} << 31, 0, -1};
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto r = device.stream<float>({6}), row = device.stream<float>({6});
    longs::offsets(streamOf<Long>(device, by), sk::float2x2{{{1, 2}, {3, 4}}},
                   streamOf<float>(device, {0, 1, 2, 3, 4, 5}), r, row);
    CHECK(r.read() == std::vector<float>{1, 5, 0, 5, 4, 4});
    CHECK(row.read() == std::vector<float>{4, 4, 2, 4, 2, 2});
  });
}

TEST_CASE("longs shift by counts modulo 64") {
  std::vector<Long> a;
  std::vector<int> n;
  for (const Long x : extremes()) {
    for (const int count : {0, 1, 7, 31, 32, 33, 63, 64, 97, -1}) {
      a.push_back(x);
      n.push_back(count);
    }
  }
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto r = streams<Long>(device, 2, static_cast<std::int64_t>(a.size()));
    auto u = streams<Ulong>(device, 2, static_cast<std::int64_t>(a.size()));
    longs::shifts(streamOf<Long>(device, a), streamOf<Ulong>(device, asUnsigned(a)), streamOf<int>(device, n),
                  r[0], r[1], u[0], u[1]);
    const auto left = r[0].read(), right = r[1].read();
    const auto uLeft = u[0].read(), uRight = u[1].read();
    for (std::size_t i = 0; i < a.size(); ++i) {
      INFO(a[i] << " by " << n[i]);
      const auto bits = static_cast<Ulong>(a[i]);
      CHECK(left[i] == wrapped(bits << (n[i] & 63)));
      CHECK(right[i] == a[i] >> (n[i] & 63));
      CHECK(uLeft[i] == bits << (n[i] & 63));
      CHECK(uRight[i] == bits >> (n[i] & 63));
    }
  });
}

TEST_CASE("longs are negated, stepped and compared") {
  const Pairs pairs;
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto a = streamOf<Long>(device, pairs.a), b = streamOf<Long>(device, pairs.b);
    auto r = streams<Long>(device, 3, pairs.size());
    auto u = device.stream<Ulong>({pairs.size()});
    longs::unaries(a, streamOf<Ulong>(device, asUnsigned(pairs.a)), r[0], r[1], u, r[2]);
    checkEach(r[0].read(), pairs, [](Ulong x, Ulong) { return wrapped(0 - x); });
    checkEach(r[1].read(), pairs, [](Long x, Long) { return ~x; });
    checkEach(u.read(), pairs, [](Ulong x, Ulong) { return 0 - x; });
    checkEach(r[2].read(), pairs, [](Ulong x, Ulong) { return wrapped(x + 1); });
    auto bits = streams<int>(device, 2, pairs.size());
    longs::comparisons(a, b, bits[0], bits[1]);
    checkEach(bits[0].read(), pairs, [](Long x, Long y) {
      return (x < y) + 2 * (x <= y) + 4 * (x > y) + 8 * (x >= y) + 16 * (x == y) + 32 * (x != y) +
             64 * (x != 0) + 128 * (y == 0);
    });
    checkEach(bits[1].read(), pairs, [](Ulong x, Ulong y) {
      return (x < y) + 2 * (x <= y) + 4 * (x > y) + 8 * (x >= y) + 16 * (x == y) + 32 * (x != 0 && y != 0);
    });
  });
}

TEST_CASE("functions of longs") {
  const Pairs pairs;
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto a = streamOf<Long>(device, pairs.a), b = streamOf<Long>(device, pairs.b);
    auto r = streams<Long>(device, 6, pairs.size());
    auto counts = device.stream<sk::int4>({pairs.size()});
    auto uHigh = device.stream<Ulong>({pairs.size()});
    longs::functions(a, b, r[0], r[1], r[2], r[3], r[4], counts, r[5], uHigh);
    checkEach(r[0].read(), pairs, [](Long x, Long y) { return std::min(x, y); });
    checkEach(r[1].read(), pairs, [](Long x, Long y) { return std::max(x, y); });
    checkEach(r[2].read(), pairs, [](Long x, Long) { return std::clamp(x, -square, square); });
    checkEach(r[3].read(), pairs,
              [](Long x, Long) { return x < 0 ? wrapped(0 - static_cast<Ulong>(x)) : x; });
    checkEach(r[4].read(), pairs, [](Long x, Long) { return Long{x > 0} - Long{x < 0}; });
    const auto words = counts.read();
    for (std::size_t i = 0; i < words.size(); ++i) {
      const auto x = static_cast<Ulong>(pairs.a[i]);
      INFO(pairs.a[i]);
      CHECK((words[i] == sk::int4{std::popcount(x), std::countl_zero(x), std::countr_zero(x),
                                  std::popcount(static_cast<Ulong>(pairs.b[i]))}));
    }
    checkEach(uHigh.read(), pairs, [](Ulong x, Ulong y) { return product(x, y).second; });
    checkEach(r[5].read(), pairs, [](Long x, Long y) {
      const Ulong high = product(static_cast<Ulong>(x), static_cast<Ulong>(y)).second;
      return wrapped(high - (x < 0 ? static_cast<Ulong>(y) : 0) - (y < 0 ? static_cast<Ulong>(x) : 0));
    });
  });
}

TEST_CASE("longs become the nearest floats and doubles, and the low bits of narrower integers") {
  std::vector<Long> a = extremes();
  for (std::uint32_t i = 0; i < 400; ++i) {  // halfway between floats and doubles, and beside it
    const Ulong random = Ulong{hashed(i)} << 32 | hashed(i + 1000);
    const int shift = static_cast<int>(i % 50);
    a.push_back(wrapped(random >> shift));
    const int cut = i % 2 == 0 ? 39 : 10;
    for (const Ulong near : {0, 1, 2})
      a.push_back(wrapped(((random >> cut << cut) | Ulong{1} << (cut)) - 1 + near));
  }
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig& config) {
    const auto size = static_cast<std::int64_t>(a.size());
    auto i = device.stream<int>({size});
    auto u = device.stream<std::uint32_t>({size});
    auto f = streams<float>(device, 2, size);
    auto d = streams<double>(device, 2, size);
    auto c = device.stream<std::int8_t>({size});
    longs::toOthers(streamOf<Long>(device, a), i, u, f[0], f[1], d[0], d[1], c);
    const auto is = i.read();
    const auto us = u.read();
    const auto fs = f[0].read(), gs = f[1].read();
    const auto ds = d[0].read(), es = d[1].read();
    const auto cs = c.read();
    for (std::size_t k = 0; k < a.size(); ++k) {
      INFO(a[k]);
      const auto bits = static_cast<Ulong>(a[k]);
      CHECK(is[k] == static_cast<int>(a[k]));
      CHECK(us[k] == static_cast<std::uint32_t>(a[k]));
      CHECK(fs[k] == static_cast<float>(a[k]));
      CHECK(gs[k] == static_cast<float>(bits));
      CHECK(cs[k] == static_cast<std::int8_t>(a[k]));
      const double error = config.isNative() ? 0 : 0x1p-48;
      CHECK(std::fabs(ds[k] - static_cast<double>(a[k])) <= error * std::fabs(static_cast<double>(a[k])));
      CHECK(std::fabs(es[k] - static_cast<double>(bits)) <= error * static_cast<double>(bits));
    }
  });
}

TEST_CASE("floats and doubles truncate to longs and saturate") {
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<float> f = {0,        -0.0F,   0.75F,          -0.75F,   1,         -1.5F,      0x1p24F + 2,
                          -0x1p31F, 0x1p40F, 0x1.fffffep62F, 0x1p63F,  -0x1p63F,  -0x1.8p63F, 0x1.fffffep63F,
                          0x1p64F,  1e30F,   -1e30F,         infinity, -infinity, NAN,        1e-40F};
  for (std::uint32_t i = 0; i < 200; ++i) {
    const float x = std::ldexp(static_cast<float>(hashed(i)) / 0x1p32F + 0.5F, static_cast<int>(i % 66));
    f.push_back(i % 3 == 0 ? -x : x);
  }
  const auto toLong = [](double x) -> Long {
    return std::isnan(x) ? 0
           : x >= 0x1p63 ? std::numeric_limits<Long>::max()
           : x < -0x1p63 ? least
                         : static_cast<Long>(x);
  };
  const auto toUlong = [](double x) -> Ulong {
    return !(x > 0) ? 0 : x >= 0x1p64 ? std::numeric_limits<Ulong>::max() : static_cast<Ulong>(x);
  };
  const std::vector<double> d(f.begin(), f.end());
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    const auto size = static_cast<std::int64_t>(f.size());
    auto a = streams<Long>(device, 2, size);
    auto b = streams<Ulong>(device, 2, size);
    longs::fromFloats(streamOf<float>(device, f), streamOf<double>(device, d), a[0], b[0], a[1], b[1]);
    const auto fromFloat = a[0].read(), fromDouble = a[1].read();
    const auto uFromFloat = b[0].read(), uFromDouble = b[1].read();
    for (std::size_t k = 0; k < f.size(); ++k) {
      INFO(f[k]);
      CHECK(fromFloat[k] == toLong(f[k]));
      CHECK(uFromFloat[k] == toUlong(f[k]));
      CHECK(fromDouble[k] == toLong(f[k]));
      CHECK(uFromDouble[k] == toUlong(f[k]));
    }
  });
}

TEST_CASE("narrower integers become longs") {
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    const std::vector<int> i = {0, -1, 2147483647, -2147483647 - 1};
    const std::vector<std::uint32_t> u = {0, 4294967295U, 5, 2147483648U};
    const std::vector<std::int16_t> s = {1, -1, -32768, 32767};
    const std::vector<sk::half> h = {sk::half(1.5F), sk::half(-2.5F), sk::half(65504.0F), sk::half(0.0F)};
    auto r = streams<Long>(device, 4, 4);
    auto b = device.stream<Ulong>({4});
    longs::fromIntegers(streamOf<int>(device, i), streamOf<std::uint32_t>(device, u),
                        streamOf<std::int16_t>(device, s), streamOf<sk::half>(device, h), r[0], b, r[1], r[2],
                        r[3]);
    CHECK(r[0].read() == std::vector<Long>(i.begin(), i.end()));
    CHECK(b.read() == std::vector<Ulong>{0, ~Ulong{0}, 2147483647, 0xffffffff80000000});
    CHECK(r[1].read() == std::vector<Long>(u.begin(), u.end()));
    CHECK(r[2].read() == std::vector<Long>(s.begin(), s.end()));
    CHECK(r[3].read() == std::vector<Long>{1, -2, 65504, 0});
  });
}

TEST_CASE("literals and constants of 64 bits") {
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig& config) {
    auto a = device.stream<sk::long4>({4});
    auto b = device.stream<sk::ulong4>({4});
    auto d = device.stream<double>({4});
    auto f = device.stream<float>({4});
    longs::literals(streamOf<int>(device, {0, 1, 2, 3}), a, b, d, f);
    const Ulong powers[] = {1, Ulong{1} << 20, Ulong{1} << 40, Ulong{1} << 63};
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK((a.read()[i] == sk::long4{std::numeric_limits<Long>::max(), least, 1'000'000'000'000'000'000,
                                      1'000'000'000'000}));
      CHECK((b.read()[i] == sk::ulong4{~Ulong{0}, powers[i], 16, 3'000'000'000}));
      if (config.isNative()) CHECK(d.read()[i] == 9007199254740992.0);
      CHECK(f.read()[i] == 16777216.0F);
    }
  });
}

TEST_CASE("vectors of longs") {
  const std::vector<Long> all = extremes();
  const auto count = all.size();
  std::vector<sk::long3> v(count), w(count);
  std::vector<int> n(count);
  for (std::size_t i = 0; i < count; ++i) {
    v[i] = {all[i], all[(i + 3) % count], all[(i + 8) % count]};
    w[i] = {all[(i + 5) % count], i % 2 == 0 ? v[i].y : all[i], all[(i * 7) % count]};
    n[i] = static_cast<int>(i % 3);
  }
  constexpr Ulong s = 0x1234567890;
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto r = device.stream<sk::long3>({static_cast<std::int64_t>(count)});
    auto masks = device.stream<sk::long3>({static_cast<std::int64_t>(count)});
    auto counts = device.stream<sk::int3>({static_cast<std::int64_t>(count)});
    longs::vectors(streamOf<sk::long3>(device, v), streamOf<sk::long3>(device, w), streamOf<int>(device, n),
                   Long{s}, r, masks, counts);
    const auto actual = r.read(), actualMasks = masks.read();
    const auto actualCounts = counts.read();
    for (std::size_t i = 0; i < count; ++i) {
      INFO(i);
      const Long x[] = {v[i].x, v[i].y, v[i].z}, y[] = {w[i].x, w[i].y, w[i].z};
      Ulong e[3];
      for (int c = 0; c < 3; ++c) e[c] = static_cast<Ulong>(x[c]) * s + static_cast<Ulong>(y[2 - c]);
      e[0] -= 1;
      e[1] -= 1;
      e[n[i]] = static_cast<Ulong>(x[n[i]] / 7);
      std::swap(e[0], e[2]);
      std::swap(e[0], e[2]);
      e[2] = e[2];
      // r.zx = r.xz exchanges both
      std::swap(e[0], e[2]);
      if (n[i] == 1) {
        for (Ulong& part : e) part <<= 1;
      }
      CHECK((actual[i] == sk::long3{wrapped(e[0]), wrapped(e[1]), wrapped(e[2])}));
      const bool less[] = {x[0] < y[0], x[1] < y[1], x[2] < y[2]};
      CHECK((actualMasks[i] == sk::long3{-Long{less[0]}, -Long{less[1]}, -Long{less[2]}}));
      int c[3];
      for (int k = 0; k < 3; ++k) {
        c[k] = std::popcount(static_cast<Ulong>(x[k])) +
               std::countl_zero(static_cast<Ulong>(std::max(x[k], y[k]))) +
               (less[0] || less[1] || less[2] ? 100 : 0) + (x[k] == y[k] ? 1000 : 0);
      }
      CHECK((actualCounts[i] == sk::int3{c[0], c[1], c[2]}));
    }
  });
}

TEST_CASE("longs in structs, arrays, gathers and uniforms, and as indices") {
  const Ulong high = Ulong{1} << 40;
  std::vector<longs::Entry> x;
  std::vector<Long> n = {0, 1, 2, 3, -1, std::numeric_limits<Long>::max(), least, Long{1} << 32};
  for (std::size_t i = 0; i < n.size(); ++i)
    x.push_back({static_cast<Long>(i) << 33, static_cast<float>(i), {high + i, high * i}});
  const longs::Entry y{-5, 2, {high - 1, 9}};
  const std::vector<sk::ulong2> table = {{1, high}, {2, 2 * high}, {3, 3 * high}};
  const Ulong powers[] = {1, Ulong{1} << 20, Ulong{1} << 40, Ulong{1} << 63};
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto r = device.stream<longs::Entry>({8});
    auto picked = device.stream<Ulong>({8});
    longs::structs(streamOf<longs::Entry>(device, x), y, streamOf<sk::ulong2>(device, table),
                   streamOf<Long>(device, n), r, picked);
    const auto entries = r.read();
    const auto sums = picked.read();
    for (std::size_t i = 0; i < n.size(); ++i) {
      INFO(n[i]);
      CHECK(entries[i].id == x[i].id - 5);
      CHECK((entries[i].range == sk::ulong2{x[i].range.x, x[i].range.y ^ (high - 1)}));
      const auto at = static_cast<std::size_t>(std::clamp<Long>(n[i], 0, 2));
      const Ulong list[] = {x[i].range.x, 9, 7};
      CHECK(sums[i] == list[at] + table[at].y + powers[n[i] & 3]);
    }
  });
}

TEST_CASE("a switch over a long, and a loop that counts with one") {
  const std::vector<Long> a = {10'000'000'000, -10'000'000'000, 5, 10'000'000'000 - (Long{1} << 32), 0,
                               1'410'065'408};
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto r = device.stream<int>({6});
    auto sum = device.stream<Long>({6});
    longs::branches(streamOf<Long>(device, a), r, sum);
    CHECK(r.read() == std::vector<int>{1, 3, 3, 4, 4, 4});
    for (std::size_t k = 0; k < a.size(); ++k) {
      Long expected = 0;
      for (Long i = a[k]; i > a[k] - 5; --i) expected += i % 3 == 0 ? 0 : i;
      CHECK(sum.read()[k] == expected);
    }
  });
}

TEST_CASE("longs are scattered, pushed and gathered") {
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    const std::vector<Long> a = {1, Long{1} << 40, -(Long{1} << 40), least, 6};
    auto r = streamOf<Long>(device, {9, 9, 9, 9, 9});
    longs::stored(streamOf<Long>(device, a), streamOf<int>(device, {4, 2, 0, 1, 7}), r);
    CHECK(r.read() == std::vector<Long>{a[2], a[3], a[1], 9, a[0]});
    auto list = device.stream<Long>({5});
    longs::positive(streamOf<Long>(device, a), list);
    CHECK(list.read() == std::vector<Long>{a[0], a[1], 6});
    auto sums = device.stream<Long>({5});
    longs::gathered(streamOf<Long>(device, a), streamOf<int>(device, {-3, 1, 2, 3, 99}),
                    streamOf<Long>(device, a), sums);
    CHECK(sums.read() == std::vector<Long>{a[0] + a[1], a[1] + a[2],
                                           wrapped(static_cast<Ulong>(a[2]) + static_cast<Ulong>(a[3])),
                                           wrapped(static_cast<Ulong>(a[3]) + 6), 6 + a[0]});
  });
}

TEST_CASE("reduces and scans of longs, in one element and over many passes") {
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    for (const std::size_t count : {1U, 5U, 5000U}) {
      std::vector<int> x(count);
      std::vector<Long> y(count);
      for (std::size_t i = 0; i < count; ++i) {
        x[i] = static_cast<int>(hashed(static_cast<std::uint32_t>(i)));
        y[i] = wrapped(Ulong{hashed(static_cast<std::uint32_t>(i + 7))} << 32 | static_cast<Ulong>(i));
      }
      CHECK(longs::total(streamOf<int>(device, x)) == std::accumulate(x.begin(), x.end(), Long{0}));
      CHECK(longs::largest(streamOf<Long>(device, y)) == *std::ranges::max_element(y));
      Ulong odd = 0;
      for (const Long one : y) odd ^= static_cast<Ulong>(one);
      CHECK(longs::parity(streamOf<Ulong>(device, asUnsigned(y))) == odd);
      auto sums = device.stream<Long>({static_cast<std::int64_t>(count)});
      longs::running(streamOf<Long>(device, y), sums);
      std::vector<Long> expected(count);
      Ulong sum = 0;
      for (std::size_t i = 0; i < count; ++i) expected[i] = wrapped(sum += static_cast<Ulong>(y[i]));
      CHECK(sums.read() == expected);
    }
  });
}

TEST_CASE("longs are keys of sorts, and scalars") {
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    std::vector<Long> keys = extremes();
    auto stream = streamOf<Long>(device, keys);
    auto unsignedKeys = streamOf<Ulong>(device, asUnsigned(keys));
    sk::sort(stream);
    sk::sort(unsignedKeys, {.descending = true});
    std::ranges::sort(keys);
    CHECK(stream.read() == keys);
    auto descending = asUnsigned(keys);
    std::ranges::sort(descending, std::greater());
    CHECK(unsignedKeys.read() == descending);
    auto a = device.scalar<Long>(), b = device.scalar<Long>();
    a = Long{1} << 40;
    b = a * a + a / 3 - Long{7};
    CHECK(b.read() == (Long{1} << 40) / 3 - 7);
    auto isLess = device.scalar<bool>();
    isLess = b < a;
    CHECK(isLess.read());
    longs::total(streamOf<int>(device, {2147483647, 2147483647, 3}), b);
    CHECK(b.read() == 4294967297);
  });
}
