// SPDX-License-Identifier: MIT
//
// Matrices against plain loops over rows. Elements are small integers, so that every product and sum is exact; only an
// inverse rounds.
#include "matrices.sk.hpp"

#include <cmath>

#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;
using sk::float2;
using sk::float2x2;

namespace {

float smallAt(std::uint32_t i) { return static_cast<float>(hashed(i + 3u) % 17u) - 8.0f; }

float2x2 matrixAt(std::uint32_t i) {
  return {{{smallAt(4 * i), smallAt(4 * i + 1)}, {smallAt(4 * i + 2), smallAt(4 * i + 3)}}};
}

float2x2 product(const float2x2& a, const float2x2& b) {
  float2x2 r{};
  const auto row = [&](const float2& v) {
    return float2{v.x * b[0].x + v.y * b[1].x, v.x * b[0].y + v.y * b[1].y};
  };
  r[0] = row(a[0]);
  r[1] = row(a[1]);
  return r;
}

float2 applied(const float2x2& a, const float2& v) {
  return {a[0].x * v.x + a[0].y * v.y, a[1].x * v.x + a[1].y * v.y};
}

template <class Make>
auto listOf(std::int64_t count, const Make& make) {
  std::vector<decltype(make(0u))> list;
  for (std::int64_t i = 0; i < count; ++i) list.push_back(make(static_cast<std::uint32_t>(i)));
  return list;
}

}  // namespace

TEST_CASE("products, sums and comparisons of matrices") {
  for (const std::int64_t count : {0, 1, 211}) {
    const auto a = listOf(count, matrixAt);
    const auto b = listOf(count, [](std::uint32_t i) { return i % 3 == 0 ? matrixAt(i) : matrixAt(i + 50); });
    const auto v = listOf(count, [](std::uint32_t i) { return float2{smallAt(i), smallAt(i + 9)}; });
    onSomeLayouts([&](sk::Device& device) {
      auto ab = device.stream<float2x2>({count});
      auto scaled = device.stream<float2x2>({count});
      auto av = device.stream<float2>({count});
      auto same = device.stream<bool>({count});
      matrices::products(streamOf<float2x2>(device, a), streamOf<float2x2>(device, b),
                         streamOf<float2>(device, v), ab, scaled, av, same);
      CHECK(difference(ab.read(), [&](std::size_t i) { return product(a[i], b[i]); }) == "");
      CHECK(difference(av.read(), [&](std::size_t i) { return applied(a[i], v[i]); }) == "");
      CHECK(difference(scaled.read(), [&](std::size_t i) {
              const auto one = [](const float2& x, const float2& y) {
                return float2{x.x - y.x / 4, x.y - y.y / 4};
              };
              return float2x2{{one(a[i][0], b[i][0]), one(a[i][1], b[i][1])}};
            }) == "");
      CHECK(difference(same.read(), [&](std::size_t) { return std::uint8_t{1}; }) == "");
    });
  }
}

TEST_CASE("rows and elements, read and written at any index") {
  const std::int64_t count = 97;
  using sk::float3;
  using sk::float3x3;
  const auto a = listOf(count, [](std::uint32_t i) {
    float3x3 m{};
    for (std::uint32_t r = 0; r < 3; ++r)
      m[r] = {smallAt(9 * i + r), smallAt(9 * i + r + 3), smallAt(9 * i + r + 6)};
    return m;
  });
  const auto numbers = listOf(count, [](std::uint32_t i) { return static_cast<int>(i); });
  onSomeLayouts([&](sk::Device& device) {
    auto r = device.stream<float3x3>({count});
    auto row = device.stream<float3>({count});
    auto e = device.stream<float>({count});
    matrices::elements(streamOf<int>(device, numbers), streamOf<float3x3>(device, a), r, row, e);
    CHECK(difference(row.read(), [&](std::size_t i) { return a[i][i % 3]; }) == "");
    CHECK(difference(e.read(), [&](std::size_t i) {
            const float3 v = a[i][i % 3];
            return i / 3 % 3 == 0 ? v.x : i / 3 % 3 == 1 ? v.y : v.z;
          }) == "");
    CHECK(difference(r.read(), [&](std::size_t i) {
            float3x3 m = a[i];
            const float3 v = a[i][i % 3];
            m[i % 3].x = 100;
            m[1] = {m[1].x + v.x, m[1].y + v.y, m[1].z + v.z};
            m[2].z = v.x;
            m[2].x = v.y;
            return m;
          }) == "");
  });
}

TEST_CASE("matrices from a number, rows, or numbers") {
  const std::vector<float> x = {0, 1, -3, 7.5f};
  onGlAndNative([&](sk::Device& device) {
    auto diagonal = device.stream<sk::float4x4>({4});
    auto rows = device.stream<sk::float3x3>({4});
    auto numbers = device.stream<float2x2>({4});
    matrices::diagonal(streamOf<float>(device, x), diagonal);
    matrices::made(streamOf<float>(device, x), rows, numbers);
    CHECK(difference(diagonal.read(), [&](std::size_t i) {
            const float d = x[i] + 1;
            return sk::float4x4{{{d, 0, 0, 0}, {0, d, 0, 0}, {0, 0, d, 0}, {0, 0, 0, d}}};
          }) == "");
    CHECK(difference(rows.read(), [&](std::size_t i) {
            return sk::float3x3{{{x[i], 1, 2}, {2 * x[i], 2, 4}, {2, 1, x[i]}}};
          }) == "");
    CHECK(difference(numbers.read(), [&](std::size_t i) { return float2x2{{{2, 4}, {6, 2 * x[i]}}}; }) == "");
  });
}

TEST_CASE("transposes, inverses and determinants") {
  const auto a = listOf(64, [](std::uint32_t i) {  // triangular: the determinant is the diagonal's product
    sk::float4x4 m{};
    m[0] = {2, smallAt(i), smallAt(i + 1), smallAt(i + 2)};
    m[1] = {0, -1, smallAt(i + 3), smallAt(i + 4)};
    m[2] = {0, 0, 4, smallAt(i + 5)};
    m[3] = {0, 0, 0, 1.0f + static_cast<float>(i % 3)};
    return m;
  });
  onGlAndNative([&](sk::Device& device) {
    auto t = device.stream<sk::float4x4>({64});
    auto d = device.stream<float>({64});
    matrices::inverses(streamOf<sk::float4x4>(device, a), t, d);
    CHECK(difference(d.read(), [&](std::size_t i) { return -8 * a[i][3].w; }) == "");
    const std::vector<sk::float4x4> results = t.read();
    double worst = 0;
    for (std::size_t i = 0; i < results.size(); ++i) {
      const sk::float4x4& m = a[i];
      const sk::float4 columns[4] = {{m[0].x, m[1].x, m[2].x, m[3].x},
                                     {m[0].y, m[1].y, m[2].y, m[3].y},
                                     {m[0].z, m[1].z, m[2].z, m[3].z},
                                     {m[0].w, m[1].w, m[2].w, m[3].w}};
      for (std::size_t row = 0; row < 4; ++row) {
        const sk::float4 r = results[i][row], c = columns[row];
        for (const double e : {double{r.x} - c.x, double{r.y} - c.y, double{r.z} - c.z, double{r.w} - c.w}) {
          worst = std::max(worst, std::fabs(e));
        }
      }
    }
    // The condition numbers of these matrices are below 1e4, and elements of a and its inverse are below 1e3.
    CHECK(worst < 1e-2);
  });
}

namespace {

matrices::Pose after(const matrices::Pose& a, const matrices::Pose& b) {
  const float2 shift = applied(a.turn, b.shift);
  return {product(a.turn, b.turn), {shift.x + a.shift.x, shift.y + a.shift.y}, b.id};
}

matrices::Pose poseAt(std::uint32_t i) {
  return {matrixAt(i), {smallAt(i + 1), smallAt(i + 2)}, static_cast<int>(i)};
}

bool agree(const matrices::Pose& a, const matrices::Pose& b) {
  return a.turn == b.turn && a.shift == b.shift && a.id == b.id;
}

}  // namespace

TEST_CASE("matrices in structs and uniforms, gathered, in place and on views") {
  const matrices::Pose by = poseAt(500);
  const float2x2 also = matrixAt(501);
  for (const std::int64_t count : {1, 7, 211}) {
    const auto p = listOf(count, poseAt);
    const auto expected = [&](std::size_t i, std::size_t last) {
      matrices::Pose r = after(by, after(p[i], p[std::min(i + 1, last)]));
      r.turn = product(also, r.turn);
      return r;
    };
    onSomeLayouts([&](sk::Device& device) {
      auto stream = streamOf<matrices::Pose>(device, p);
      auto r = device.stream<matrices::Pose>({count});
      if (count > 3) {
        const auto part = stream.domain({1}, {count - 1});
        matrices::move(by, also, part, part, r.domain({2}, {count}));
        const auto moved = r.domain({2}, {count}).read();
        const auto last = static_cast<std::size_t>(count) - 2;
        CHECK(difference(
                  moved, moved.size(), [&](std::size_t i) { return expected(i + 1, last); }, agree) == "");
      }
      matrices::move(by, also, stream, stream, stream);
      CHECK(difference(
                stream.read(), p.size(), [&](std::size_t i) { return expected(i, p.size() - 1); }, agree) ==
            "");
    });
  }
}

TEST_CASE("a product of matrices keeps its order") {
  for (const std::int64_t count : {1, 2, 64, 997, 10007}) {
    // Shears and quarter turns have integer elements and do not commute.
    const auto a = listOf(count, [](std::uint32_t i) {
      switch (hashed(i) % 4) {
        case 0: return float2x2{{{1, 1}, {0, 1}}};
        case 1: return float2x2{{{1, -1}, {0, 1}}};
        case 2: return float2x2{{{0, -1}, {1, 0}}};
        default: return float2x2{{{0, 1}, {-1, 0}}};
      }
    });
    // Elements are integers modulo 64, so that every product is exact.
    std::vector<matrices::Turn> turns;
    const auto wrapped = [](float2x2 m) {
      for (float2& row : m.rows)
        row = {row.x - 64 * std::floor(row.x / 64), row.y - 64 * std::floor(row.y / 64)};
      return m;
    };
    float2x2 expected{{{1, 0}, {0, 1}}};
    for (const float2x2& m : a) {
      expected = wrapped(product(expected, m));
      turns.push_back({m});
    }
    onEveryTarget([&](sk::Device& device) {
      CHECK(matrices::turnAll(streamOf<matrices::Turn>(device, turns)).m == expected);
    });
  }
  onEveryTarget([&](sk::Device& device) {
    // 10,007 factors whose product never grows: a quarter turn between two shears.
    std::vector<float2x2> a;
    float2x2 expected{{{1, 0}, {0, 1}}};
    for (std::uint32_t i = 0; i < 10007; ++i) {
      const float s = smallAt(i / 3);
      a.push_back(i % 3 == 0   ? float2x2{{{1, s}, {0, 1}}}
                  : i % 3 == 1 ? float2x2{{{1, -s}, {0, 1}}}
                               : float2x2{{{0, -1}, {1, 0}}});
      expected = product(expected, a.back());
    }
    CHECK(matrices::product(streamOf<float2x2>(device, a)) == expected);
    CHECK(matrices::product(streamOf<float2x2>(device, {1, 10007}, a)) == expected);
    CHECK(matrices::product(device.stream<float2x2>({0})) == float2x2{{{1, 0}, {0, 1}}});
  });
}

TEST_CASE("constant matrices and arrays of them") {
  const auto v = listOf(31, [](std::uint32_t i) { return float2{smallAt(i), smallAt(i + 4)}; });
  onGlAndNative([&](sk::Device& device) {
    auto r = device.stream<float2>({31});
    matrices::turned(streamOf<float2>(device, v), r);
    CHECK(difference(r.read(), [&](std::size_t i) {
            const float2 q = {-v[i].y, v[i].x};
            return float2{4 * q.x - 2 * v[i].x + v[i].x, 4 * q.y - 2 * v[i].y + v[i].y};
          }) == "");
  });
}
