// SPDX-License-Identifier: MIT
//
// Promises: a kernel with folded outputs gives its other outputs the values that a kernel without them gives, and its
// folded ones those of a reduce of the same elements, whichever streams it reads and writes; and what it cannot do is
// refused before anything runs.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "folded_outputs.sk.hpp"
#include "sk/native/parallel.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "support/streams.hpp"

namespace run_tests {
namespace {

using Catch::Matchers::Contains;

std::vector<int> numbers(std::size_t count, int seed = 1) {
  std::vector<int> x;
  for (std::size_t i = 0; i < count; ++i)
    x.push_back(static_cast<int>((i * 7919 + 13 * i * i) % 101) - 40 + seed);
  return x;
}

std::vector<float> floats(std::size_t count, int seed = 1) {
  std::vector<float> x;
  for (const int number : numbers(count, seed)) x.push_back(static_cast<float>(number) / 8);
  return x;
}

/// Whether elements of step agree: a GPU's driver may round a * p + b once or twice, in each program as it likes. Products
/// are below 4 and sums below 16 here.
bool agree(const std::vector<float>& a, const std::vector<float>& b) {
  return std::ranges::equal(a, b, [](float x, float y) { return std::abs(x - y) <= 0x1p-20F; });
}

TEST_CASE("a step of conjugate gradients gives what a kernel and a reduce give") {
  onEveryTarget([](sk::Device& device) {
    for (const std::size_t n : {1U, 3U, 64U, 4099U, 300000U}) {
      INFO(n << " elements");
      const auto p = streamOf(device, floats(n, 1)), q = streamOf(device, floats(n, 2));
      const auto x = streamOf(device, floats(n, 3)), r = streamOf(device, floats(n, 4));
      auto xn = streamOf(device, floats(n)), rn = streamOf(device, floats(n));
      auto xs = streamOf(device, floats(n)), rs = streamOf(device, floats(n));
      auto rr = device.scalar<float>();
      folded::step(0.37f, p, q, x, r, xn, rn, rr);
      folded::stepAlone(0.37f, p, q, x, r, xs, rs);
      CHECK(agree(xn.read(), xs.read()));
      CHECK(agree(rn.read(), rs.read()));
      double exact = 0;
      for (const float value : rn.read()) exact += double{value} * double{value};
      CHECK(rr.read() == Approx(exact).epsilon(3e-7));
      CHECK(folded::squares(rs) == Approx(rr.read()).epsilon(3e-7));
      auto one = device.stream<float>({1});  // a stream of one element, and an argument that is a scalar
      const auto a = device.scalar<float>(0.37f);
      folded::step(a, p, q, x, r, xn, rn, one);
      CHECK(agree(xn.read(), xs.read()));
      CHECK(one.read()[0] == rr.read());
    }
  });
}

TEST_CASE("several accumulators fold each block of streams of any shape") {
  onEveryTarget([](sk::Device& device) {
    struct Case {
      sk::Shape domain, blocks;
    };
    for (const Case& one :
         {Case{{50}, {1}}, Case{{70000}, {7}}, Case{{12, 20}, {12, 1}}, Case{{12, 20}, {3, 4}},
          Case{{300, 260}, {1, 260}}, Case{{3, 4, 10}, {3, 1, 5}}, Case{{2, 3, 4, 50}, {2, 3, 1, 1}},
          Case{{5, 7}, {5, 7}}, Case{{1050, 1024}, {1, 1}}}) {
      INFO(one.domain.size() << " elements, " << one.blocks.size() << " blocks");
      const auto n = static_cast<std::size_t>(one.domain.size());
      const std::vector<int> x = numbers(n);
      const auto in = streamOf(device, x, one.domain);
      auto y = device.stream<int>(one.domain);
      auto total = device.stream<int>(one.blocks), most = device.stream<int>(one.blocks);
      auto positive = device.stream<int>(one.blocks);
      folded::count(in, y, total, most, positive);
      const auto blocks = static_cast<std::size_t>(one.blocks.size());
      std::vector<int> ys, totals(blocks), mosts(blocks, std::numeric_limits<int>::min()), positives(blocks);
      for (std::size_t i = 0; i < n; ++i) {
        std::size_t block = 0, rest = i, step = n;
        for (int d = 0; d < one.domain.rank(); ++d) {
          step /= static_cast<std::size_t>(one.domain[d]);
          const std::size_t index = rest / step;
          rest %= step;
          block = block * static_cast<std::size_t>(one.blocks[d]) +
                  index / static_cast<std::size_t>(one.domain[d] / one.blocks[d]);
        }
        totals[block] += 3 * x[i] + 1;
        mosts[block] = std::max(mosts[block], x[i]);
        positives[block] += x[i] > 0 ? 1 : 0;
        ys.push_back(3 * x[i] + 1 + (x[i] > 0 ? 1000 : 0));
      }
      CHECK(y.read() == ys);
      CHECK(total.read() == totals);
      CHECK(most.read() == mosts);
      CHECK(positive.read() == positives);
    }
  });
}

TEST_CASE("the first element may be what a fold starts from") {
  onEveryTarget([](sk::Device& device) {
    for (const int n : {1, 5, 20000}) {
      INFO(n << " elements");
      std::vector<folded::Hit> hits;
      std::vector<float> doubled;
      for (int i = 0; i < n; ++i) {
        hits.push_back({static_cast<float>((i * 37 + 11) % 1000 + 2), i});
        doubled.push_back(2 * hits.back().t);
      }
      const auto nearest = *std::ranges::min_element(hits, {}, &folded::Hit::t);
      const auto h = streamOf(device, hits);
      auto t = device.stream<float>({n});
      auto best = device.stream<folded::Hit>({1});
      folded::nearest(h, t, best);
      CHECK(t.read() == doubled);
      CHECK(best.read()[0].t == nearest.t);
      CHECK(best.read()[0].id == nearest.id);
    }
  });
}

TEST_CASE("order is kept, and an overload combines partial results") {
  onEveryTarget([](sk::Device& device) {
    for (const std::size_t n : {1U, 40U, 17U * 256U, 70001U}) {
      INFO(n << " elements");
      const std::vector<int> x = numbers(n);
      std::vector<int> ys;
      unsigned a = 1, b = 0;
      for (const int value : x) {
        ys.push_back(value + 1);
        a *= static_cast<unsigned>(value);
        b = b * static_cast<unsigned>(value) + static_cast<unsigned>(value + 1);
      }
      auto y = streamOf(device, x);
      auto f = device.stream<folded::Line>({1});
      folded::compose(y, y, f);  // in place
      CHECK(y.read() == ys);
      CHECK(static_cast<unsigned>(f.read()[0].a) == a);
      CHECK(static_cast<unsigned>(f.read()[0].b) == b);
    }
  });
}

TEST_CASE("a kernel that calls one folds the element, into an accumulator or a variable") {
  onEveryTarget([](sk::Device& device) {
    const auto q = streamOf(device, floats(500, 1)), r = streamOf(device, floats(500, 2));
    auto rn = device.stream<float>({500}), square = device.stream<float>({500});
    auto sum = device.scalar<float>(), rr = device.scalar<float>();
    folded::stepAndSum(2, q, r, rn, sum, rr);
    folded::stepOfOne(2, q, r, square);
    double sums = 0, squares = 0;
    const std::vector<float> values = rn.read(), ones = square.read();
    for (std::size_t i = 0; i < values.size(); ++i) {
      CHECK(ones[i] == values[i] * values[i]);
      sums += values[i];
      squares += values[i] * values[i];
    }
    CHECK(sum.read() == Approx(sums).epsilon(1e-6));
    CHECK(rr.read() == Approx(squares).epsilon(1e-6));
  });
}

TEST_CASE("stencils, borders, iterators, indices, arrays and gathers") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> u = floats(60 * 130);
    auto in = streamOf(device, u, {60, 130}), v = device.stream<float>({60, 130});
    auto change = device.scalar<float>();
    folded::smooth(in, v, change);
    const auto at = [&](int y, int x) {
      return u[static_cast<std::size_t>((y + 60) % 60 * 130 + (x + 130) % 130)];
    };
    std::vector<float> expected;
    float most = 0;
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 130; ++x) {
        expected.push_back((at(y, x - 1) + at(y, x + 1) + at(y - 1, x) + at(y + 1, x)) / 4);
        most = std::max(most, std::abs(expected.back() - at(y, x)));
      }
    }
    CHECK(v.read() == expected);
    CHECK(change.read() == most);
    folded::smooth(in, in, change);  // in place: reads what was there before
    CHECK(in.read() == expected);
    CHECK(change.read() == most);

    const auto row = streamOf(device, std::vector<float>{5, 3, 9, 4, 8});
    auto sums = device.stream<float>({5});
    auto least = device.scalar<float>();
    folded::edges(row, sums, least);
    CHECK(sums.read() == std::vector<float>{2, 8, 9, 11, 8});
    CHECK(least.read() == 2);

    constexpr int n = 5003;
    std::vector<int> x, table, ys;
    long long sum = 0;
    constexpr std::array weight = {1, -2, 3, 5};
    for (int i = 0; i < 50; ++i) table.push_back(i * i % 17);
    for (int i = 0; i < n; ++i) {
      x.push_back(i * 7 % 50);
      ys.push_back(weight[static_cast<std::size_t>((i + 100) & 3)] *
                   table[static_cast<std::size_t>(x.back())]);
      sum += static_cast<long long>(ys.back()) * i;
    }
    auto y = device.stream<int>({n});
    auto total = device.stream<int>({1});
    auto last = device.stream<sk::int2>({1});
    folded::placed(sk::iter(100, 100 + n), weight, streamOf(device, x), streamOf(device, table), y, total,
                   last);
    CHECK(y.read() == ys);
    CHECK(total.read()[0] == static_cast<int>(sum));
    CHECK(last.read()[0].x == n - 1);
    CHECK(last.read()[0].y == 100 + n - 1);
  });
}

TEST_CASE("constants for a call switch off a fold and its streams") {
  onEveryTarget([](sk::Device& device) {
    const auto x = streamOf(device, std::vector<int>{1, 2, 3});
    const auto extra = streamOf(device, std::vector<int>{10, 20, 30});
    auto y = device.stream<int>({3});
    auto sum = device.scalar<int>();
    folded::chosen(true, true, x, extra, y, sum);
    CHECK(y.read() == std::vector<int>{2, 4, 6});
    CHECK(sum.read() == 72);
    folded::chosen(false, false, x, sk::none, y, sum);
    CHECK(y.read() == std::vector<int>{1, 2, 3});
    CHECK(sum.read() == 0);
    CHECK_THAT(errorOf([&] { folded::chosen(false, true, x, sk::none, y, sum); }), Contains("sk::none"));
  });
}

TEST_CASE("streams may be read and written in one call") {
  onEveryTarget([](sk::Device& device) {
    for (const std::size_t n : {7U, 5000U, 70000U}) {
      INFO(n << " elements");
      const std::vector<float> x(n, 1.5f);
      const double count = static_cast<double>(n);
      auto own = streamOf(device, x);
      auto before = device.scalar<float>(), after = device.scalar<float>(2.0f);
      folded::both(after, own, own, before, after);  // reads the scalar into which it folds
      CHECK(own.read() == std::vector<float>(n, 3.5f));
      CHECK(before.read() == Approx(1.5 * count));
      CHECK(after.read() == Approx(3.5 * count));
      // the constant and a result are elements of the stream that is also read and written
      auto whole = streamOf(device, std::vector<float>(n + 1, 1.0f));
      auto part = whole.domain({0}, {static_cast<std::int64_t>(n)});
      auto last = whole.domain({static_cast<std::int64_t>(n)}, {static_cast<std::int64_t>(n) + 1});
      folded::both(last, part, part, before, last);
      std::vector<float> expected(n + 1, 2.0f);
      expected.back() = static_cast<float>(2 * count);
      CHECK(whole.read() == expected);
      CHECK(before.read() == Approx(count));

      const std::vector<int> z = numbers(n);
      std::vector<int> ys;
      int sum = 0;
      for (std::size_t i = 0; i < n; ++i) {
        ys.push_back(z[std::min(i + 1, n - 1)] + z[i]);
        sum += ys.back() + z[i];
      }
      auto same = streamOf(device, z);
      auto total = device.scalar<int>();
      folded::shifted(same, same, same, total);
      CHECK(same.read() == ys);
      CHECK(total.read() == sum);
    }
  });
}

TEST_CASE("inputs repeat, and views are read and written") {
  onEveryTarget([](sk::Device& device) {
    auto u = streamOf(device, floats(40 * 30), {40, 30});
    const std::vector<float> before = u.read();
    const auto row = streamOf(device, std::vector<float>{4}, {1, 1});
    auto rr = device.stream<float>({10, 1});
    auto xn = device.stream<float>({10, 20});
    folded::step(1, u.domain({5, 5}, {15, 25}), row, u.domain({20, 0}, {30, 20}), u.domain({5, 5}, {15, 25}),
                 xn, u.domain({25, 10}, {35, 30}), rr);
    std::vector<float> after = before, sums;
    for (std::size_t y = 0; y < 10; ++y) {
      float sum = 0;
      for (std::size_t x = 0; x < 20; ++x) {
        const float value = before[(y + 5) * 30 + x + 5] - 4;
        after[(y + 25) * 30 + x + 10] = value;
        sum += value * value;
      }
      sums.push_back(sum);
    }
    CHECK(u.read() == after);
    const std::vector<float> folds = rr.read();
    for (std::size_t y = 0; y < 10; ++y) CHECK(folds[y] == Approx(sums[y]).epsilon(1e-5));
  });
}

TEST_CASE("outputs may be every other element of a stream") {
  onEveryTarget([](sk::Device& device) {
    constexpr std::int64_t width = 1500;
    auto wide = streamOf(device, std::vector<float>(4 * 2 * width, 7.0f), {4, 2 * width});
    auto odd = sk::stride(wide, {1, 2}, {0, 1});
    auto old = device.stream<float>({4, 1}), made = device.stream<float>({4, 1});
    folded::both(1, streamOf(device, std::vector<float>(4 * width, 2.0f), {4, width}), odd, old, made);
    std::vector<float> expected;
    for (std::int64_t i = 0; i < 4 * width; ++i) expected.insert(expected.end(), {7, 3});
    CHECK(wide.read() == expected);
    CHECK(old.read() == std::vector<float>(4, 2 * width));
    CHECK(made.read() == std::vector<float>(4, 3 * width));
    // in an order that is kept, elements that are not neighbours are folded together
    auto numbersOf = streamOf(device, std::vector<int>(2 * 5000, 1), {10000});
    auto f = device.stream<folded::Line>({1});
    folded::compose(streamOf(device, std::vector<int>(5000, 1)), sk::stride(numbersOf, {2}, {0}), f);
    std::vector<int> both;
    for (int i = 0; i < 5000; ++i) both.insert(both.end(), {2, 1});
    CHECK(numbersOf.read() == both);
    CHECK(f.read()[0].b == 10000);
  });
}

TEST_CASE("an empty domain folds to the identity") {
  onEveryTarget([](sk::Device& device) {
    const auto x = device.stream<int>({0});
    auto y = device.stream<int>({0});
    auto total = device.scalar<int>(5), most = device.scalar<int>(5), positive = device.scalar<int>(5);
    folded::count(x, y, total, most, positive);
    CHECK(total.read() == 0);
    CHECK(most.read() == std::numeric_limits<int>::min());
    const auto hits = device.stream<folded::Hit>({0});
    auto t = device.stream<float>({0});
    auto best = device.stream<folded::Hit>({1});
    CHECK_THAT(errorOf([&] { folded::nearest(hits, t, best); }), Contains("no identity"));
  });
}

TEST_CASE("sums are as accurate as those of reduces") {
  onEveryTarget([](sk::Device& device) {
    constexpr int n = 40000;
    std::vector<float> x(n, 0.1f);
    const double exact = n * double{0.1f};
    const auto in = streamOf(device, x);
    auto y = device.stream<float>({n});
    auto old = device.scalar<float>(), made = device.scalar<float>();
    const auto both = [&](const sk::CallOptions& options) {
      y.fill(-1);
      folded::both.with(options)(0, in, y, old, made);
      CHECK(y.read() == x);
    };
    both({.accumulate = sk::Accumulate::Exact});
    CHECK(old.read() == static_cast<float>(exact));
    CHECK(made.read() == static_cast<float>(exact));
    both({.accumulate = sk::Accumulate::Tree});
    CHECK(old.read() == Approx(exact).epsilon(1e-5));
    both({.accumulate = sk::Accumulate::Extended});
    CHECK(made.read() == static_cast<float>(exact));
    folded::both.with({.precision = sk::Precision::Extended})(0, in, y, old, made);
    CHECK(old.read() == static_cast<float>(exact));
    CHECK(y.read() == x);
    folded::both.with({.precision = sk::Precision::Half})(0, in, y, old, made);
    CHECK(y.read()[0] == 0.0999755859375f);  // 0.1 as a half
    if (device.arithmetic().exactSums) {
      both({.accumulate = sk::Accumulate::Compensated});
      CHECK(old.read() == Approx(exact).epsilon(7e-8));
      both({});
      CHECK(made.read() == Approx(exact).epsilon(7e-8));
    }
  });
}

TEST_CASE("infinities and NaN are folded as they are") {
  onEveryTarget([](sk::Device& device) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::vector<float> x(5000, 1.0f);
    x[4321] = infinity;
    auto y = device.stream<float>({5000});
    auto old = device.scalar<float>(), made = device.scalar<float>();
    folded::both(1, streamOf(device, x), y, old, made);
    CHECK(y.read()[4321] == infinity);
    CHECK(old.read() == infinity);
    CHECK(made.read() == infinity);
    x[17] = -infinity;
    folded::both(1, streamOf(device, x), y, old, made);
    CHECK(std::isnan(old.read()));
    CHECK(y.read()[17] == -infinity);
    CHECK(y.read()[18] == 2);
  });
}

TEST_CASE("elements of every kind are folded beside outputs of every kind") {
  onEveryTarget([](sk::Device& device) {
    constexpr std::int64_t n = 3001;
    std::vector<float> x;
    std::vector<sk::float4> vectors;
    std::vector<double> wide;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      x.push_back(static_cast<float>(i % 9));
      vectors.push_back({1, 2, static_cast<float>(i % 5), static_cast<float>(i % 7)});
      wide.push_back(1 + i * 0x1p-40);
      sum += wide.back() * wide.back();
    }
    auto y = device.stream<sk::half>({n});
    auto halves = device.scalar<float>();
    folded::rounded(streamOf(device, x), y, halves);
    double expected = 0;
    for (const sk::half value : y.read()) expected += static_cast<float>(value);
    CHECK(halves.read() == Approx(expected).epsilon(1e-6));
    auto doubles = device.stream<double>({n});
    auto total = device.stream<double>({1});
    folded::precise(streamOf(device, wide), doubles, total);
    CHECK(total.read()[0] == Approx(sum).epsilon(1e-12));
    CHECK(doubles.read()[7] == Approx(wide[7] * wide[7]).epsilon(1e-13));
    auto products = device.stream<sk::float2>({n}), both = device.stream<sk::float2>({1});
    auto most = device.scalar<float>();
    folded::vectors(streamOf(device, vectors), products, both, most);
    CHECK(products.read()[13].y == 2 * 6);
    float first = 0;
    for (const sk::float4& value : vectors) first += value.z;
    CHECK(both.read()[0].x == first);
    CHECK(most.read() == 6);
    auto pairs = device.stream<folded::Pair>({n});
    auto thirds = device.stream<sk::float3>({n});
    folded::paired(streamOf(device, x), pairs, thirds, halves);
    CHECK(pairs.read()[2000].low == x[2000]);
    CHECK(pairs.read()[2000].count.y == 2);
    CHECK(thirds.read()[3000].y == 2 * x[3000]);
    double triple = 0;
    for (const float value : x) triple += 3 * value;
    CHECK(halves.read() == triple);
    auto ints = device.stream<int>({4});
    auto tally = device.scalar<int>();
    folded::tally(streamOf(device, std::vector<int>{1, 2, 3, 4}), ints, tally);
    CHECK(ints.read() == std::vector<int>{2, 4, 6, 8});
    CHECK(tally.read() == 20);
  });
}

TEST_CASE("results are stored in the precision of their streams") {
  onEveryTarget([](sk::Device& device) {
    const auto x = streamOf(device, std::vector<float>(300, 0.5f));
    for (const sk::Storage storage : {sk::Storage::Half, sk::Storage::Extended}) {
      auto y = device.stream<float>({300}, storage);
      auto old = device.stream<float>({3}, storage), made = device.stream<float>({3});
      folded::both(1, x, y, old, made);
      CHECK(y.read() == std::vector<float>(300, 1.5f));
      CHECK(old.read() == std::vector<float>(3, 50));
      CHECK(made.read() == std::vector<float>(3, 150));
    }
  });
}

TEST_CASE("a loop repeats steps whose scalars stay on the device") {
  onEveryTarget([](sk::Device& device) {
    constexpr std::int64_t n = 257;
    const auto p = streamOf(device, std::vector<float>(n, 1.0f));
    auto x = streamOf(device, std::vector<float>(n, 0.0f)), r = streamOf(device, std::vector<float>(n, 8.0f));
    auto rr = device.scalar<float>(64.0f * n), a = device.scalar<float>(0.0f);
    sk::Loop loop = device.record([&] {
      a.assign(rr / (128.0f * n));
      folded::step(a, p, p, x, r, x, r, rr);
    });
    float xs = 0, rs = 8, sum = 64.0f * n;
    loop.repeat(5);
    for (int i = 0; i < 5; ++i) {
      const float step = sum / (128.0f * n);
      xs += step;
      rs -= step;
      sum = rs * rs * n;
    }
    CHECK(x.read()[100] == Approx(xs).epsilon(1e-5));
    CHECK(r.read()[256] == Approx(rs).epsilon(1e-5));
    CHECK(rr.read() == Approx(sum).epsilon(1e-5));
  });
}

TEST_CASE("natively, a folded sum has the bits of a reduce, for any number of threads") {
  sk::Device& native = device("native");
  constexpr sk::CallOptions tree{.accumulate = sk::Accumulate::Tree};
  for (const std::size_t n : {1000U, 65537U, 1000003U}) {
    const auto p = streamOf(native, floats(n, 1)), r = streamOf(native, floats(n, 2));
    for (const std::int64_t blocks : {1, 1, 3}) {
      if (static_cast<std::int64_t>(n) % blocks != 0) continue;
      auto xn = native.stream<float>({static_cast<std::int64_t>(n)}), rn = streamOf(native, floats(n, 3));
      auto rr = native.stream<float>({blocks}), alone = native.stream<float>({blocks});
      folded::step.with(tree)(0.3f, p, p, r, r, xn, rn, rr);
      folded::squares.with(tree)(rn, alone);
      CHECK(rr.read() == alone.read());
      auto one = native.stream<float>({blocks}), own = streamOf(native, floats(n, 2));
      // a loop inside another one has a single thread
      sk::native::inParallel(2, 1 << 20, sk::native::Deal::Evenly, [&](sk::native::Range range) {
        if (range.begin == 0) folded::step.with(tree)(0.3f, p, p, own, own, xn, own, one);
      });
      CHECK(one.read() == alone.read());
      CHECK(own.read() == rn.read());
    }
  }
}

TEST_CASE("a kernel that only gathers folds, also exactly") {
  onEveryTarget([](sk::Device& device) {
    auto p = streamOf(device, std::vector<float>{1, 2, 4, 8, 16});
    auto q = device.stream<float>({5});
    for (const sk::Accumulate accumulate :
         {sk::Accumulate::Default, sk::Accumulate::Tree, sk::Accumulate::Exact}) {
      auto total = device.scalar<float>();
      folded::stencil.with({.accumulate = accumulate})(p, q, total);
      CHECK(q.read() == std::vector<float>{0, -1, -2, -4, 24});
      CHECK(total.read() == 342);  // -2 - 8 - 32 + 384
    }
  });
}

TEST_CASE("what a folded output cannot be is refused before anything runs") {
  onEveryTarget([](sk::Device& device) {
    const auto x = streamOf(device, std::vector<int>{1, 2, 3, 4, 5, 6});
    auto y = streamOf(device, std::vector<int>(6, 9));
    auto total = device.stream<int>({4});
    auto ok = device.scalar<int>(), other = device.scalar<int>();
    CHECK_THAT(errorOf([&] { folded::count(x, y, total, total, total); }),
               Contains("folded::count") && Contains("total"));
    auto most = device.stream<int>({4}), positive = device.stream<int>({4});
    CHECK_THAT(errorOf([&] { folded::count(x, y, total, most, positive); }),
               Contains("'y' has shape {6}") && Contains("divisor"));
    CHECK_THAT(errorOf([&] { folded::count(x, y, ok, other, y.domain({0}, {1})); }), Contains("overlap"));
    CHECK_THAT(
        errorOf([&] { folded::count(x, device.stream<int>({5}), ok, other, device.stream<int>({1})); }),
        Contains("'x' has shape {6}"));
    CHECK_THAT(errorOf([&] {
                 folded::count.with({.scan = sk::Scan::Exclusive})(x, y, ok, other, device.stream<int>({1}));
               }),
               Contains("is not a scan"));
    CHECK_THAT(errorOf([&] {
                 folded::count.with({.accumulate = sk::Accumulate::Exact})(x, y, ok, other,
                                                                           device.stream<int>({1}));
               }),
               Contains("exact"));
    CHECK(y.read() == std::vector<int>(6, 9));
    sk::Device second("native");
    auto foreign = second.stream<int>({1});
    CHECK_THAT(errorOf([&] { folded::count(x, y, ok, other, foreign); }), Contains("two devices"));
  });
}

}  // namespace
}  // namespace run_tests
