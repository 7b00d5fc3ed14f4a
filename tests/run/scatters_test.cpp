// SPDX-License-Identifier: MIT
//
// Promises: a scatter output has the same result as running the elements one after another, for every type, rank and layout,
// on views and in place. Integers are exact in all 32 bits. Floats are compared bit for bit, too: the device adds in the order
// of the elements, and the values here are small multiples of 1/8, whose sums are exact.
#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "scatters.sk.hpp"
#include "support/devices.hpp"

namespace {

using run_tests::onEveryLayout, run_tests::onDrawnLayouts;

constexpr std::int64_t sizes[] = {0, 1, 2, 67, 1009, 4001};

/// Random indices, some of them outside the extent.
std::vector<int> indicesInto(std::int64_t extent, std::int64_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> index(-2, static_cast<int>(extent) + 2);
  std::vector<int> list;
  for (std::int64_t i = 0; i < count; ++i) list.push_back(index(random));
  if (count > 3) list[1] = INT32_MIN, list[2] = INT32_MAX;
  return list;
}

template <class T>
std::vector<T> anyBits(std::int64_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<T> list;
  for (std::int64_t i = 0; i < count; ++i) list.push_back(static_cast<T>(random()));
  return list;
}

std::vector<float> eighths(std::int64_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<float> list;
  for (std::int64_t i = 0; i < count; ++i) list.push_back(static_cast<float>(random() % 401) / 8.0F - 25.0F);
  return list;
}

/// Compares kernel(at, x, r) over streams with fold(r[i], x) over arrays.
template <class T, class Kernel, class Fold>
void compare(sk::Device& device, const Kernel& kernel, const std::vector<T>& x, const std::vector<T>& before,
             const Fold& fold) {
  const auto extent = static_cast<std::int64_t>(before.size());
  const auto count = static_cast<std::int64_t>(x.size());
  const std::vector<int> at = indicesInto(extent, count, 7);
  std::vector<T> expected = before;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (at[i] >= 0 && at[i] < extent) {
      T& old = expected[static_cast<std::size_t>(at[i])];
      old = fold(old, x[i]);
    }
  }
  auto ats = device.stream<int>({count});
  auto xs = device.stream<T>({count});
  auto r = device.stream<T>({extent});
  ats.write(at);
  xs.write(x);
  r.write(before);
  kernel(ats, xs, r);
  CHECK(r.read() == expected);
}

TEST_CASE("sums and extremes of one component") {
  onDrawnLayouts([](sk::Device& device) {
    for (const std::int64_t size : sizes) {
      INFO("size " << size);
      const std::vector<int> ints = anyBits<int>(size, 1), someInts = anyBits<int>(53, 2);
      const std::vector<unsigned> uints = anyBits<unsigned>(size, 3), someUints = anyBits<unsigned>(101, 4);
      const std::vector<float> floats = eighths(size, 5), someFloats = eighths(67, 6);
      compare<float>(device, sumFloats, floats, someFloats, [](float a, float b) { return a + b; });
      compare<float>(device, lowestFloats, floats, someFloats,
                     [](float a, float b) { return std::min(a, b); });
      compare<int>(device, subtractInts, ints, someInts, [](int a, int b) {
        return static_cast<int>(static_cast<unsigned>(a) - static_cast<unsigned>(b));
      });
      compare<int>(device, highestInts, ints, someInts, [](int a, int b) { return std::max(a, b); });
      compare<unsigned>(device, highestUints, uints, someUints,
                        [](unsigned a, unsigned b) { return std::max(a, b); });
    }
  });
}

TEST_CASE("sums and extremes of vectors") {
  onDrawnLayouts([](sk::Device& device) {
    for (const std::int64_t size : {std::int64_t{1}, std::int64_t{1009}}) {
      std::vector<sk::int3> ints(static_cast<std::size_t>(size));
      std::vector<sk::int2> pairs(ints.size());
      std::vector<sk::uint4> uints(ints.size());
      std::vector<sk::float2> floats(ints.size());
      const std::vector<int> bits = anyBits<int>(4 * size, 8);
      for (std::size_t i = 0; i < ints.size(); ++i) {
        const int* b = &bits[4 * i];
        const auto u = [&](int k) { return static_cast<unsigned>(b[k]); };
        ints[i] = {b[0], b[1], b[2]};
        pairs[i] = {b[0], b[3]};
        uints[i] = {u(0), u(1), u(2), u(3)};
        floats[i] = {static_cast<float>(b[0] % 1000), static_cast<float>(b[1] % 1000)};
      }
      compare<sk::int3>(device, sumInts, ints, std::vector<sk::int3>(90, {1, -2, 3}),
                        [](sk::int3 a, sk::int3 b) {
                          const auto add = [](int p, int q) {
                            return static_cast<int>(static_cast<unsigned>(p) + static_cast<unsigned>(q));
                          };
                          return sk::int3{add(a.x, b.x), add(a.y, b.y), add(a.z, b.z)};
                        });
      compare<sk::int2>(
          device, lowestInts, pairs, std::vector<sk::int2>(90, {INT32_MAX, 0}),
          [](sk::int2 a, sk::int2 b) { return sk::int2{std::min(a.x, b.x), std::min(a.y, b.y)}; });
      compare<sk::uint4>(device, lowestUints, uints, std::vector<sk::uint4>(90, {UINT32_MAX, 5, 0, 1u << 31}),
                         [](sk::uint4 a, sk::uint4 b) {
                           return sk::uint4{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z),
                                            std::min(a.w, b.w)};
                         });
      compare<sk::float2>(
          device, highestFloats, floats, std::vector<sk::float2>(90, {-2000.0F, 3.0F}),
          [](sk::float2 a, sk::float2 b) { return sk::float2{std::max(a.x, b.x), std::max(a.y, b.y)}; });
    }
  });
}

TEST_CASE("more sums at one place than a float can count") {
  onDrawnLayouts([](sk::Device& device) {
    if (device.limits().textureSize < 1024) return;
    const std::int64_t count = 300007;
    std::vector<unsigned> x(static_cast<std::size_t>(count), 0u);
    std::vector<unsigned> expected(300, 0u);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = i % 10 == 0 ? static_cast<unsigned>(i / 10 % 299) : 299u;
      ++expected[x[i]];
    }
    auto xs = device.stream<unsigned>({count});
    auto r = device.stream<unsigned>({300});
    xs.write(x);
    r.write(std::vector<unsigned>(300, 0u));
    histogram(xs, r);
    CHECK(r.read() == expected);
  });
}

TEST_CASE("the last store wins, of structs too, and the rest stays") {
  onDrawnLayouts([](sk::Device& device) {
    const std::vector<int> at = indicesInto(211, 700, 9);
    std::vector<int> last(211, -1);
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (at[i] >= 0 && at[i] < 211) last[static_cast<std::size_t>(at[i])] = static_cast<int>(i);
    }
    auto ats = device.stream<int>({700});
    auto r = device.stream<Mark>({211});
    ats.write(at);
    r.write(std::vector<Mark>(211, Mark{-1, {9, 9, 9, 9}, false}));
    storeMarks(ats, r);
    const std::vector<Mark> got = r.read();
    bool isRight = true;
    for (std::size_t i = 0; i < got.size(); ++i) {
      const sk::float4 colour =
          last[i] < 0 ? sk::float4{9, 9, 9, 9} : sk::float4{static_cast<float>(i), 1, 2, 3};
      isRight = isRight && got[i].id == last[i] && got[i].set == (last[i] >= 0) && got[i].colour == colour;
    }
    CHECK(isRight);
  });
}

TEST_CASE("every rank, and views") {
  onEveryLayout([](sk::Device& device) {
    auto at2 = device.stream<sk::int2>({3, 3});
    auto ux = device.stream<unsigned>({3, 3});
    at2.write(
        std::vector<sk::int2>{{0, 0}, {4, 0}, {5, 0}, {0, 69}, {0, 70}, {-1, 2}, {4, 69}, {2, 5}, {2, 5}});
    ux.write(std::vector<unsigned>{1, 2, 3, 4, 5, 6, 7, 8, 9});
    auto plane = device.stream<unsigned>({72, 9});
    plane.write(std::vector<unsigned>(72 * 9, 100u));
    storePlane(at2, ux, plane.domain({1, 2}, {71, 7}));
    std::vector<unsigned> expected(72 * 9, 100u);
    const auto put = [&](int x, int y, unsigned v) {
      expected[static_cast<std::size_t>((y + 1) * 9 + x + 2)] = v;
    };
    put(0, 0, 1), put(4, 0, 2), put(0, 69, 4), put(4, 69, 7), put(2, 5, 9);
    CHECK(plane.read() == expected);

    auto at3 = device.stream<sk::int3>({4});
    auto ix = device.stream<int>({4});
    at3.write(std::vector<sk::int3>{{6, 4, 2}, {0, 0, 0}, {0, 0, 3}, {0, 5, 0}});
    ix.write(std::vector<int>{-1, -2, -3, -4});
    auto volume = device.stream<int>({3, 5, 7});
    volume.write(std::vector<int>(105, 0));
    storeVolume(at3, ix, volume);
    std::vector<int> ints(105, 0);
    ints[104] = -1, ints[0] = -2;
    CHECK(volume.read() == ints);

    auto at4 = device.stream<sk::int4>({2});
    auto fx = device.stream<float>({2});
    at4.write(std::vector<sk::int4>{{1, 0, 2, 3}, {1, 0, 2, 4}});
    fx.write(std::vector<float>{0.5F, 2.0F});
    auto four = device.stream<float>({5, 4, 2, 3});
    four.write(std::vector<float>(120, 0.0F));
    storeFour(at4, fx, four.domain({1, 1, 0, 1}, {5, 4, 2, 3}));
    std::vector<float> floats(120, 0.0F);
    floats[((4 * 4 + 3) * 2 + 0) * 3 + 2] = 0.5F;
    CHECK(four.read() == floats);
  });
}

TEST_CASE("several scatters an element, beside an output") {
  onDrawnLayouts([](sk::Device& device) {
    const int n = 1009;
    const std::vector<float> x = eighths(n, 11);
    std::vector<float> halves(n, 1.0F), twice;
    std::vector<int> last(400, -7);
    for (int i = 0; i < n; ++i) {
      const float half = x[static_cast<std::size_t>(i)] / 2;
      const auto add = [&](int at, float v) {
        if (at >= 0 && at < n) halves[static_cast<std::size_t>(at)] += v;
      };
      twice.push_back(4 * half);
      add(i, half);
      if (i % 2 == 0) add(i + 1, half);
      add(i, 1), add(i - 1, 1);
      last[static_cast<std::size_t>(i / 3)] = i;
    }
    auto xs = device.stream<float>({n});
    auto h = device.stream<float>({n});
    auto l = device.stream<int>({400});
    xs.write(x);
    h.write(std::vector<float>(n, 1.0F));
    l.write(std::vector<int>(400, -7));
    splat(xs, h, l, xs);
    CHECK(h.read() == halves);
    CHECK(l.read() == last);
    CHECK(xs.read() == twice);
  });
}

TEST_CASE("as many scatters as an element says") {
  onDrawnLayouts([](sk::Device& device) {
    std::vector<int> count(257), expected(64, 0);
    for (int i = 0; i < 257; ++i) {
      count[static_cast<std::size_t>(i)] = i % 4 == 0 ? i % 23 : 0;
      for (int k = 0; k < count[static_cast<std::size_t>(i)]; ++k) {
        expected[static_cast<std::size_t>((i * 7 + k * 3) % 64)] += k + 1;
      }
    }
    auto counts = device.stream<int>({257});
    auto r = device.stream<int>({64});
    counts.write(count);
    r.write(std::vector<int>(64, 0));
    spread(counts, r);
    CHECK(r.read() == expected);
  });
}

TEST_CASE("as many scatters as the outputs are long") {
  onDrawnLayouts([](sk::Device& device) {
    auto rows = device.stream<int>({3});
    auto picture = device.stream<std::uint32_t>({5, 37});
    auto columns = device.stream<int>({11});
    rows.write(std::vector<int>{0, 2, 4});
    picture.fill(7);
    columns.fill(1);
    fillRow(rows, picture, columns);
    std::vector<std::uint32_t> expected(5 * 37, 7);
    for (const std::size_t row : {0, 2, 4})
      std::fill_n(expected.begin() + static_cast<std::ptrdiff_t>(row * 37), 37, 8u);
    CHECK(picture.read() == expected);
    CHECK(columns.read() == std::vector<int>(11, 1 + 3 * 5));
  });
}

TEST_CASE("reading and writing one stream, and nothing at all") {
  onDrawnLayouts([](sk::Device& device) {
    for (const std::int64_t size : sizes) {
      std::vector<int> list = anyBits<int>(size, 12);
      auto r = device.stream<int>({size});
      r.write(list);
      if (size > 0) reverse(r, r, r);
      std::reverse(list.begin(), list.end());
      CHECK(r.read() == list);
      none(r, r);
      CHECK(r.read() == list);
    }
  });
}

TEST_CASE("helpers scatter for their kernels") {
  onDrawnLayouts([](sk::Device& device) {
    for (const std::int64_t size : sizes) {
      INFO("size " << size);
      const std::vector<int> at = indicesInto(67, size, 21);
      const std::vector<float> x = eighths(size, 22);
      std::vector<float> r(67, 1), total;
      std::vector<Mark> marks(2 * 67);
      const auto add = [&](std::int64_t i, float v) {
        if (i >= 0 && i < 67) r[static_cast<std::size_t>(i)] += v;
      };
      for (std::size_t i = 0; i < x.size(); ++i) {
        for (int k = 0; k < 2; ++k) {
          const auto place = static_cast<int>(static_cast<unsigned>(at[i]) + static_cast<unsigned>(k));
          for (const int step : {0, 1}) {
            add(static_cast<int>(static_cast<unsigned>(place) + static_cast<unsigned>(step)), x[i]);
            add(static_cast<int>(static_cast<unsigned>(at[i]) + static_cast<unsigned>(step)), 1);
          }
        }
        total.push_back(2 * x[i] + 2);
        if (x[i] > 0 && at[i] >= 0 && at[i] < 67) {
          marks[67 + static_cast<std::size_t>(at[i])] = {static_cast<int>(i), {}, true};
        }
      }
      auto ats = device.stream<int>({size});
      auto xs = device.stream<float>({size}), rs = device.stream<float>({67}),
           totals = device.stream<float>({size});
      auto plane = device.stream<Mark>({2, 67});
      ats.write(at);
      xs.write(x);
      rs.write(std::vector<float>(67, 1));
      plane.write(std::vector<Mark>(2 * 67));
      handOn(ats, xs, rs, plane, totals);
      CHECK(rs.read() == r);
      CHECK(totals.read() == total);
      const std::vector<Mark> read = plane.read();
      for (std::size_t i = 0; i < marks.size(); ++i) {
        REQUIRE((read[i].id == marks[i].id && read[i].set == marks[i].set));
      }
    }
  });
}

TEST_CASE("a sparse matrix times a vector") {
  onDrawnLayouts([](sk::Device& device) {
    const std::vector<sk::int2> cell = {{0, 0}, {2, 0}, {1, 1}, {0, 2}, {1, 2}, {2, 2}};
    auto cells = device.stream<sk::int2>({6});
    auto values = device.stream<float>({6});
    auto x = device.stream<float>({3});
    auto y = device.stream<float>({3});
    cells.write(cell);
    values.write(std::vector<float>{1, 2, 3, 4, 5, 6});
    x.write(std::vector<float>{10, 20, 30});
    y.write(std::vector<float>{0, 0, 0});
    multiply(cells, values, x, y);
    CHECK(y.read() == std::vector<float>{70, 60, 320});
  });
}

TEST_CASE("scatters that do not fit say so") {
  sk::Device& device = run_tests::device("glsl330");
  auto at = device.stream<int>({4});
  auto x = device.stream<float>({4});
  auto plane = device.stream<float>({2, 2});
  CHECK_THROWS_WITH(sumFloats(at, x, plane), Catch::Contains("sumFloats: 'r'") && Catch::Contains("{2, 2}"));
  auto short_ = device.stream<float>({3});
  CHECK_THROWS_WITH(sumFloats(at, short_, x), Catch::Contains("inputs"));
}

}  // namespace
