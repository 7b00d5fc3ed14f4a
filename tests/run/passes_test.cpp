// SPDX-License-Identifier: MIT
//
// Kernels with multipass plans against plain C++, on devices with guaranteed limits and with their own. All results are
// exact: the values are chosen so that no operation rounds.
#include "passes.sk.hpp"

#include <array>
#include <utility>

#include "support/devices.hpp"
#include "support/host_array.hpp"
#include "support/values.hpp"

using namespace run_tests;
using passes::Plenty;
using sk::bool2, sk::float2, sk::float4, sk::int2;

namespace {

/// Calls test(device) on devices with the guaranteed limits of either profile, which need many passes, on planes and on
/// layers, and with a device's own limits. The programs are large; run.gathers reads linearised streams.
template <class Test>
void onEveryLimit(const Test& test) {
  struct Limits {
    const char* profile;
    const char* limits;
    std::int32_t texture;
  };
  for (const auto& [profile, limits, texture] :
       {Limits{"glsl330", "guaranteed", 0}, Limits{"glsl330", "device", smallLimits[1]},
        Limits{"essl300", "guaranteed", smallLimits[1]}}) {
    INFO("profile " << profile << ", limits " << limits << ", texture limit " << texture);
    sk::Device device({.profile = profile, .textureLimit = texture, .limits = limits});
    test(device);
  }
}

template <class T>
struct Streams {
  Streams(sk::Device& device, const sk::Shape& shape, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) list.push_back(device.stream<T>(shape));
  }
  std::vector<sk::Stream<T>> list;
};

int mixed(int n, int rounds) {
  auto bits = static_cast<unsigned>(n);
  for (int k = 0; k < rounds; ++k) bits = bits * 1103515245u + 12345u;
  return static_cast<int>(bits);
}

}  // namespace

TEST_CASE("32 inputs and 16 outputs of float4") {
  onEveryLimit([](sk::Device& device) {
    for (const sk::Shape& shape : {sk::Shape{0}, sk::Shape{1}, sk::Shape{13, 7}, sk::Shape{5, 101}}) {
      Streams<float4> x(device, shape, 32), r(device, shape, 16);
      std::vector<std::vector<float4>> in;
      for (std::size_t i = 0; i < 32; ++i) {
        in.push_back(values<float4>(shape.size(), static_cast<std::uint32_t>(i)));
        x.list[i].write(in[i]);
      }
      const auto call = [&]<std::size_t... i, std::size_t... j>(std::index_sequence<i...>,
                                                                std::index_sequence<j...>) {
        passes::transform(x.list[i]..., 0.5f, r.list[j]...);
      };
      call(std::make_index_sequence<32>(), std::make_index_sequence<16>());
      for (std::size_t j = 0; j < 16; ++j) {
        INFO("output " << j << " of " << shape.size());
        CHECK(difference(r.list[j].read(), [&](std::size_t e) {
                float4 t{0.5f, 0.5f, 0.5f, 0.5f};
                for (std::size_t i = 0; i < 32; ++i) {
                  const auto w = static_cast<float>(static_cast<int>((i * 7 + j * 3) % 5) - 2);
                  t = {t.x + w * in[i][e].x, t.y + w * in[i][e].y, t.z + w * in[i][e].z,
                       t.w + w * in[i][e].w};
                }
                return t;
              }) == "");
      }
    }
  });
}

TEST_CASE("forty gathers in a loop") {
  constexpr std::size_t count = 40;
  onEveryLimit([](sk::Device& device) {
    for (const std::int64_t length : {1, 61, 1009}) {
      std::vector<std::vector<int>> in;
      std::vector<sk::Stream<int>> g;
      for (std::size_t i = 0; i < count; ++i) {  // of several lengths
        const std::int64_t own = length + static_cast<std::int64_t>(i) % 3;
        in.push_back(values<int>(own, static_cast<std::uint32_t>(i)));
        for (int& value : in.back()) value %= 100000;
        g.push_back(streamOf<int>(device, in.back()));
      }
      auto r = device.stream<int>({length});
      const auto call = [&]<std::size_t... i>(std::index_sequence<i...>) { passes::walk(9, g[i]..., r); };
      call(std::make_index_sequence<count>());
      CHECK(difference(r.read(), [&](std::size_t p) {
              int t = 0;
              for (int k = 0; k < 9; ++k) {
                bool goesOn = false;
                for (std::size_t i = 0; i < count && !goesOn; ++i) {
                  t += in[i][std::min(p + static_cast<std::size_t>(k), in[i].size() - 1)];
                  if (t > 1000000) {
                    t -= 1000003;
                    goesOn = (t & 7) == static_cast<int>(i % 8);
                  }
                }
                if (!goesOn && t % 5 == 4) break;
              }
              return t;
            }) == "");
    }
  });
}

TEST_CASE("32 gathers of rank 3") {
  constexpr std::size_t count = 32;
  onEveryLimit([](sk::Device& device) {
    const sk::Shape domain{3, 4, 23};
    std::vector<HostArray<int>> in;
    std::vector<sk::Stream<int>> g;
    for (std::uint32_t i = 0; i < count; ++i) {  // of several shapes
      const sk::Shape shape{3 + i % 2, 4, 20 + i % 3};
      in.emplace_back(shape, [&](std::size_t k) {
        return static_cast<int>(hashed(static_cast<std::uint32_t>(k) + 999 * i));
      });
      g.push_back(in.back().on(device));
    }
    auto r = device.stream<int>(domain);
    const auto call = [&]<std::size_t... i>(std::index_sequence<i...>) { passes::deepWalk(3, g[i]..., r); };
    call(std::make_index_sequence<count>());
    CHECK(difference(r.read(), [&](std::size_t e) {
            const Position p = positionOf(domain, e);
            unsigned t = 0;
            for (int k = 0; k < 3; ++k) {
              for (std::size_t i = 0; i < count; ++i) {
                const auto at = [&](std::int64_t dx, std::int64_t dy, std::int64_t dz) {
                  const auto wrapped = [&](std::size_t d, std::int64_t by) {
                    const std::int64_t n = in[i].shape()[static_cast<int>(d)];
                    return ((p[d] + by) % n + n) % n;
                  };
                  return static_cast<unsigned>(in[i][{wrapped(0, dz), wrapped(1, dy), wrapped(2, dx)}]);
                };
                const auto n = static_cast<std::int64_t>(i);
                t = t * 3 + at(k, -n, t & 1u) + at(n, 0, -k);
              }
            }
            return static_cast<int>(t);
          }) == "");
  });
}

TEST_CASE("control flow goes its way in every pass") {
  constexpr std::int64_t count = 1500;
  auto n = values<int>(count);
  for (std::size_t i = 0; i < n.size(); ++i) n[i] = i < 50 ? static_cast<int>(i) - 25 : n[i];
  const auto x = values<float>(count, 1);
  struct Row {
    int a;
    float b;
    int c, d;
    float e, f;
    int g;
    int2 h;
    bool i;
    unsigned j;
  };
  const auto expected = [&](std::size_t at) {
    Row row{};
    const int costly = mixed(n[at], 200);
    int other = mixed(n[at] ^ 77, 100);
    const int low = other & 1;
    other >>= 1;
    row.a = costly;
    row.i = n[at] > 0;
    if (n[at] % 3 == 0) {
      row.b = row.e = row.f = -1;
      row.c = row.d = row.g = low;
      row.h = {costly, other};
      row.j = 5;
      return row;
    }
    int sum = 0;
    for (int k = 0; k < 12 && sum <= 40; ++k) sum += (costly >> k & 1) != 0 ? k : 0;
    row.b = (n[at] & 3) == 0 ? 1 : x[at];
    row.c = (n[at] & 3) == 0 ? costly : other;
    row.d = static_cast<int>(static_cast<unsigned>(row.c) + static_cast<unsigned>(low));
    row.e = row.b + x[at];
    row.f = x[at] * 2;
    row.g = static_cast<int>(static_cast<unsigned>(sum) + static_cast<unsigned>(row.d));
    row.h = {sum, other};
    row.j = static_cast<unsigned>(costly) >> 3;
    return row;
  };
  onEveryLimit([&](sk::Device& device) {
    auto a = device.stream<int>({count}), c = device.stream<int>({count}), d = device.stream<int>({count}),
         g = device.stream<int>({count});
    auto b = device.stream<float>({count}), e = device.stream<float>({count}),
         f = device.stream<float>({count});
    auto h = device.stream<int2>({count});
    auto i = device.stream<bool>({count});
    auto j = device.stream<unsigned>({count});
    passes::branches(streamOf<int>(device, n), streamOf<float>(device, x), a, b, c, d, e, f, g, h, i, j);
    CHECK(difference(a.read(), [&](std::size_t at) { return expected(at).a; }) == "");
    CHECK(difference(b.read(), [&](std::size_t at) { return expected(at).b; }) == "");
    CHECK(difference(c.read(), [&](std::size_t at) { return expected(at).c; }) == "");
    CHECK(difference(d.read(), [&](std::size_t at) { return expected(at).d; }) == "");
    CHECK(difference(e.read(), [&](std::size_t at) { return expected(at).e; }) == "");
    CHECK(difference(f.read(), [&](std::size_t at) { return expected(at).f; }) == "");
    CHECK(difference(g.read(), [&](std::size_t at) { return expected(at).g; }) == "");
    CHECK(difference(h.read(), [&](std::size_t at) { return expected(at).h; }) == "");
    CHECK(difference(i.read(), [&](std::size_t at) -> std::uint8_t { return expected(at).i; }) == "");
    CHECK(difference(j.read(), [&](std::size_t at) { return expected(at).j; }) == "");
  });
}

TEST_CASE("a struct of more planes than a pass writes") {
  constexpr std::int64_t count = 333;
  std::vector<Plenty> p, q;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto made = [](std::uint32_t k) {
      return Plenty{valueAt<float4>(k),     valueAt<int>(k),
                    valueAt<float2>(k),     valueAt<bool>(k),
                    valueAt<unsigned>(k),   valueAt<int2>(k),
                    valueAt<sk::float3>(k), {valueAt<bool>(k + 1), valueAt<bool>(k + 2)},
                    valueAt<sk::int4>(k),   valueAt<float>(k + 9)};
    };
    p.push_back(made(i));
    q.push_back(made(i + 1000));
  }
  onEveryLimit([&](sk::Device& device) {
    auto r = device.stream<Plenty>({count});
    auto s = device.stream<float>({count});
    auto view = r.domain({0}, {count});
    passes::plenty(streamOf<Plenty>(device, p), streamOf<Plenty>(device, q), 2, view, s);
    const auto read = r.read();
    const auto sums = s.read();
    for (std::size_t i = 0; i < p.size(); ++i) {
      const float4 more = q[std::min(i + 2, q.size() - 1)].a;
      const float4 a{p[i].a.x + more.x, p[i].a.y + more.y, p[i].a.z + more.z, p[i].a.w + more.w};
      REQUIRE(read[i].a == a);
      REQUIRE(read[i].b == p[i].b);
      REQUIRE(read[i].c == p[i].c);
      REQUIRE(read[i].d == p[i].d);
      REQUIRE(read[i].e == p[i].e);
      REQUIRE(read[i].f == int2{q[i].f.y, q[i].f.x});
      REQUIRE(read[i].g == p[i].g);
      REQUIRE(read[i].h == bool2{p[i].d, p[i].h.y});
      REQUIRE(read[i].i == p[i].i);
      REQUIRE(read[i].j == p[i].j);
      REQUIRE(sums[i] == a.x + p[i].j);
    }
  });
}

TEST_CASE("several passes read what was there before the call") {
  onEveryLimit([](sk::Device& device) {
    for (const bool isView : {false, true}) {
      const sk::Shape shape{9, 20};
      std::vector<std::vector<int>> before;
      std::vector<sk::Stream<int>> s;
      for (std::uint32_t i = 0; i < 9; ++i) {
        before.push_back(values<int>(shape.size(), i));
        s.push_back(streamOf<int>(device, shape, before[i]));
      }
      const sk::Index begin = isView ? sk::Index{2, 3} : sk::Index{0, 0},
                      end = isView ? sk::Index{8, 19} : sk::Index{9, 20};
      const auto at = [&](std::size_t i) { return s[i].domain(begin, end); };
      passes::rotate(5, at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7), at(8), at(0), at(1), at(2),
                     at(3), at(4), at(5), at(6), at(7), at(8));
      for (std::size_t k = 0; k < 9; ++k) {
        INFO("output " << k << (isView ? " in a view" : ""));
        CHECK(difference(s[k].read(), [&](std::size_t i) {
                const auto row = static_cast<std::int64_t>(i) / 20,
                           column = static_cast<std::int64_t>(i) % 20;
                if (row < begin[0] || row >= end[0] || column < begin[1] || column >= end[1])
                  return before[k][i];
                const auto old = [&](std::size_t j) { return static_cast<unsigned>(before[j][i]); };
                const auto sum =
                    static_cast<unsigned>(mixed(static_cast<int>(old(0) + old(1) + old(2)), 300));
                const unsigned result[] = {old(1) + 5,   old(2) + sum, old(3) + old(1) + 5,
                                           old(4) + sum, old(5),       old(6),
                                           old(7) + sum, old(8),       old(0) + sum};
                return static_cast<int>(result[k]);
              }) == "");
      }
    }
  });
}

TEST_CASE("streams that values of spec parameters switch off cost no passes") {
  sk::Device device({.profile = "essl300", .limits = "guaranteed"});
  const sk::Shape shape{40};
  Streams<float> r(device, shape, 5);
  const std::vector<float> x(40, 1.0F);
  const auto in = streamOf<float>(device, shape, x);
  const auto passes = [&](auto&& call) {
    device.countPasses(true);
    call();
    device.finish();
    return device.passCount().passes;
  };
  const sk::None n = sk::none;
  CHECK(passes([&] {
          passes::choose(false, in, n, n, n, n, n, n, n, n, n, n, n, n, n, n, n, n, r.list[0], n, n, n, n);
        }) == 1);
  CHECK(r.list[0].read() == x);
  CHECK(passes([&] {
          passes::choose(true, in, in, in, in, in, in, in, in, in, in, in, in, in, in, in, in, in, r.list[0],
                         r.list[1], r.list[2], r.list[3], r.list[4]);
        }) > 1);
  CHECK(r.list[4].read() == std::vector<float>(40, 64.0F));
}

TEST_CASE("there are two kinds of limits") {
  CHECK_THROWS_WITH(sk::Device(sk::DeviceOptions{.limits = "none"}),
                    "there are no limits 'none'; choose device or guaranteed (option or SK_LIMITS)");
  CHECK(sk::Device(sk::DeviceOptions{.profile = "essl300", .limits = "guaranteed"}).limits().drawBuffers ==
        4);
}
