// SPDX-License-Identifier: MIT
//
// Uses of gathers: elements of every type, helper functions and kernels with gather parameters, computed indices, a stream
// that is both gather and input.
#include "gathers.sk.hpp"

#include <numeric>

#include "support/devices.hpp"
#include "support/host_array.hpp"
#include "support/values.hpp"

using namespace run_tests;
using sk::float2, sk::float3, sk::float4, sk::int3, sk::int4;

namespace {

gathers::Cell cellAt(std::size_t i) {
  const auto k = static_cast<std::uint32_t>(i);
  return {valueAt<float2>(k), valueAt<bool>(k), {int(k), int(2 * k), -int(k)}};
}

bool isSameCell(const gathers::Cell& a, const gathers::Cell& b) {
  return a.v == b.v && a.on == b.on && a.n == b.n;
}

}  // namespace

TEST_CASE("gathers hold elements of every type, and borders are of that type") {
  std::vector<int> i(20);
  std::iota(i.begin(), i.end(), -5);
  onSomeLayouts([&](sk::Device& device) {
    const HostArray<gathers::Cell> c({9}, cellAt);
    const HostArray<float3> f({6, 7},
                              [](std::size_t k) { return valueAt<float3>(static_cast<std::uint32_t>(k)); });
    const HostArray<float4> h({5},
                              [](std::size_t k) { return valueAt<float4>(static_cast<std::uint32_t>(k)); });
    const std::vector<std::uint8_t> b = {1, 0, 0, 1, 0, 0, 0, 1};
    const sk::Shape shape{20};
    auto r = device.stream<float2>(shape);
    auto s = device.stream<float3>(shape);
    auto t = device.stream<int3>(shape);
    auto u = device.stream<float4>(shape);
    const auto index = streamOf<int>(device, i);
    gathers::types(c.on(device), f.on(device), streamOf<bool>(device, b), h.on(device), index, r, s, t, u);
    const auto cell = [&](std::size_t k) { return c[{std::clamp(i[k], 0, 8)}]; };
    CHECK(difference(r.read(), [&](std::size_t k) {
            const auto one = cell(k);
            return one.on ? one.v : float2{-one.v.x, -one.v.y};
          }) == "");
    CHECK(difference(s.read(), [&](std::size_t k) {
            const bool isInside = i[k] >= 0 && i[k] < 6 && i[k] + 1 < 7;
            return isInside ? f[{i[k], i[k] + 1}] : float3{1, 2, 3};
          }) == "");
    CHECK(difference(t.read(), [&](std::size_t k) {
            const int on = i[k] < 0 || i[k] >= 8 || b[static_cast<std::size_t>(i[k])] != 0;
            const auto n = cell(k).n;
            return int3{n.x + on, n.y + on, n.z + on};
          }) == "");
    CHECK(difference(u.read(), [&](std::size_t k) {
            return i[k] >= 0 && i[k] < 5 ? h[{i[k]}] : float4{1, 0, 0, 1};
          }) == "");

    auto cells = device.stream<gathers::Cell>(shape);
    gathers::border_struct(c.on(device), index, cells);
    const auto read = cells.read();
    for (std::size_t k = 0; k < i.size(); ++k) {
      const bool isInside = i[k] >= 0 && i[k] < 9;
      CHECK(isSameCell(read[k], isInside ? c[{i[k]}] : gathers::Cell{{1, 2}, true, {3, 4, 5}}));
    }
  });
}

TEST_CASE("helpers and kernels take gathers, with the mode that the outermost kernel declares") {
  const sk::Shape shape{6, 9};
  const HostArray<float> u(shape,
                           [](std::size_t i) { return valueAt<float>(static_cast<std::uint32_t>(i)); });
  const HostArray<float> w({4, 5},
                           [](std::size_t i) { return valueAt<float>(static_cast<std::uint32_t>(i + 100)); });
  const HostArray<float> k({3}, [](std::size_t i) { return float(i) + 0.5f; });
  const HostArray<float> x(shape,
                           [](std::size_t i) { return valueAt<float>(static_cast<std::uint32_t>(i + 200)); });
  const auto atU = [&](std::int64_t px, std::int64_t py) { return u[{(py + 12) % 6, (px + 18) % 9}]; };
  const auto atW = [&](std::int64_t px, std::int64_t py) {
    return px < 0 || px >= 5 || py < 0 || py >= 4 ? 100.0f : w[{py, px}];
  };
  const auto atK = [&](std::int64_t i) {
    const std::int64_t m = ((i % 6) + 6) % 6;
    return k[{m < 3 ? m : 5 - m}];
  };
  std::vector<float> r, s;
  for (std::int64_t py = 0; py < 6; ++py) {
    for (std::int64_t px = 0; px < 9; ++px) {
      const auto rowsU = [&](std::int64_t a, std::int64_t b) { return atU(a, b) + atU(a, b + 1); };
      const auto rowsW = [&](std::int64_t a, std::int64_t b) { return atW(a, b) + atW(a, b + 1); };
      const float sidesU = atU(px - 1, py) + atU(px + 1, py), sidesW = atW(px - 1, py) + atW(px + 1, py);
      const float xv = x[{py, px}];
      float one = (px & 1) == 0 ? rowsU(px, py) : rowsW(px, py) + sidesW;
      one += py > 2 ? rowsW(-1, 0) : rowsU(-1, 0) + sidesU;
      one += atU(px, py) * 2 + xv + float(px) * 0.5f;
      float two = atW(px, py) * 2 + one + float(px) * 0.5f;
      two += atK(px - 2) * 3 + atU(py, 0) + sidesU;
      r.push_back(one);
      s.push_back(two);
    }
  }
  onSomeLayouts([&](sk::Device& device) {
    auto one = device.stream<float>(shape), two = device.stream<float>(shape);
    gathers::outer(u.on(device), w.on(device), k.on(device), x.on(device), one, two);
    // Values are multiples of 1/256 below 1000, so that no order of additions rounds.
    CHECK(difference(one.read(), r) == "");
    CHECK(difference(two.read(), s) == "");
  });
}

TEST_CASE("a stream may be gather and element of one call, and output as well") {
  onSomeLayouts([](sk::Device& device) {
    const auto x = values<float>(131);
    auto stream = streamOf<float>(device, x);
    auto below = device.stream<int>({131});
    auto median = device.stream<float>({131});
    gathers::rank(stream, stream, below, median);
    CHECK(difference(below.read(), [&](std::size_t i) {
            int count = 0;
            for (std::size_t k = 0; k < x.size(); ++k) count += x[k] < x[i] || (x[k] == x[i] && k < i);
            return count;
          }) == "");
    CHECK(difference(median.read(), [&](std::size_t) { return x[65]; }) == "");
    gathers::rank(stream, stream, below, stream);
    CHECK(difference(stream.read(), [&](std::size_t) { return x[65]; }) == "");

    const HostArray<int> a({11, 67}, [](std::size_t i) { return static_cast<int>(i); });
    auto turned = device.stream<int>({67, 11});
    gathers::transpose(a.on(device), turned);
    CHECK(difference(turned.read(),
                     [&](std::size_t i) { return a[{std::int64_t(i % 11), std::int64_t(i / 11)}]; }) == "");
    const HostArray<int> square({9, 9}, [](std::size_t i) { return static_cast<int>(i); });
    auto inPlace = square.on(device);
    gathers::transpose(inPlace, inPlace);
    CHECK(difference(inPlace.read(), [&](std::size_t i) {
            return square[{std::int64_t(i % 9), std::int64_t(i / 9)}];
          }) == "");
  });
}

TEST_CASE("gathers know their extents, and addresses may be computed from elements") {
  onSomeLayouts([](sk::Device& device) {
    auto r = device.stream<int4>({2, 3}), s = device.stream<int4>({2, 3});
    gathers::extents(device.stream<int>({77}), device.stream<float2>({5, 66}), device.stream<float>({2, 1}),
                     r, s);
    CHECK(difference(r.read(), [](std::size_t) { return int4{77, 1, 1, 1}; }) == "");
    CHECK(difference(s.read(), [](std::size_t) { return int4{66, 5, 1, 1}; }) == "");

    std::vector<int> next(101), start(101);
    for (int i = 0; i < 101; ++i) {
      next[std::size_t(i)] = (i * 7 + 3) % 101;
      start[std::size_t(i)] = 100 - i;
    }
    auto at = device.stream<int>({101});
    gathers::chase(streamOf<int>(device, next), streamOf<int>(device, start), 5, at);
    CHECK(difference(at.read(), [&](std::size_t i) {
            int k = start[i];
            for (int step = 0; step < 5; ++step) k = next[std::size_t(k)];
            return next[std::size_t(next[std::size_t(k)])] * 1000 + k;
          }) == "");

    const std::vector<float> a = {-1, 2, 3, -4};
    const auto element = [&](int i) { return a[std::size_t(std::clamp(i, 0, 3))]; };
    const std::vector<int> i = {-4, -3, -2, -1, 0, 1, 2, 3, 9};
    auto chosen = device.stream<float>({9});
    gathers::conditional(streamOf<float>(device, a), streamOf<int>(device, i), chosen);
    CHECK(difference(chosen.read(), [&](std::size_t k) {
            return i[k] >= 0 && element(i[k]) > 0 ? element(i[k])
                   : i[k] < -2                    ? -1
                                                  : element(-i[k]) + element(2);
          }) == "");
  });
}

TEST_CASE("a matrix product is exact in small integers") {
  const HostArray<float> a({7, 13}, [](std::size_t i) { return float(i % 10) - 4; });
  const HostArray<float> b({13, 5}, [](std::size_t i) { return float(i % 7) - 3; });
  onSomeLayouts([&](sk::Device& device) {
    auto c = device.stream<float>({7, 5});
    gathers::matrix(a.on(device), b.on(device), c);
    CHECK(difference(c.read(), [&](std::size_t i) {
            float sum = 0;
            for (std::int64_t k = 0; k < 13; ++k)
              sum += a[{std::int64_t(i / 5), k}] * b[{k, std::int64_t(i % 5)}];
            return sum;
          }) == "");
  });
}
