// SPDX-License-Identifier: MIT
//
// sample() against plain C++. Elements and weights have so few bits that no step rounds: results are exact unless a test
// states a bound.
#include <array>
#include <bit>
#include <limits>

#include "samples.sk.hpp"
#include "support/boundary_modes.hpp"
#include "support/devices.hpp"
#include "support/host_array.hpp"
#include "support/values.hpp"

using namespace run_tests;
using sk::float2, sk::float3, sk::float4;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();

/// The index of the neighbour below a position, limited to the range of indices, and the weight of the neighbour above.
struct Split {
  std::int64_t index;
  float weight;
};
Split splitAt(float x) {
  const double floor = std::clamp(std::floor(double{x}), -2147483648.0, 2147483520.0);
  return {static_cast<std::int64_t>(floor), std::fabs(x) >= 16777216.0f ? 0.0f : x - std::floor(x)};
}

float lerp(float a, float b, float t) { return t <= 0 ? a : t >= 1 ? b : a * (1 - t) + b * t; }

/// Component `c` of `a` at position `x` (fastest dimension first), interpolated along its first `dimensions` dimensions.
template <class T>
float interpolated(const HostArray<T>& a, const std::array<float, 4>& x, int dimensions, Position p, int c,
                   Inside inside) {
  const int rank = a.shape().rank();
  if (dimensions == 0) {
    for (int d = 0; d < rank; ++d) {
      auto& i = p[static_cast<std::size_t>(d)];
      i = inside(i, a.shape()[d]);
      if (i < 0) return outsideValue;
    }
    return std::bit_cast<std::array<float, sizeof(T) / 4>>(a[p])[static_cast<std::size_t>(c)];
  }
  const Split split = splitAt(x[static_cast<std::size_t>(dimensions - 1)]);
  auto& index = p[static_cast<std::size_t>(rank - dimensions)];
  index = split.index;
  const float low = interpolated(a, x, dimensions - 1, p, c, inside);
  index = split.index + 1;
  return lerp(low, interpolated(a, x, dimensions - 1, p, c, inside), split.weight);
}

template <class T, class X>
T sampled(const HostArray<T>& a, const X& x, Inside inside) {
  std::array<float, 4> position{};
  const auto given = std::bit_cast<std::array<float, sizeof(X) / 4>>(x);
  std::copy(given.begin(), given.end(), position.begin());
  std::array<float, sizeof(T) / 4> result{};
  for (std::size_t c = 0; c < result.size(); ++c) {
    result[c] = interpolated(a, position, a.shape().rank(), {}, static_cast<int>(c), inside);
  }
  return std::bit_cast<T>(result);
}

const std::vector<float> positions = {0,     1,          0.125f,  0.5f, 2.875f, 3.75f,    4,
                                      6.25f, -0.0f,      -0.125f, -1,   -5.5f,  17.5f,    -100.625f,
                                      1e6f,  8388607.5f, -3e7f,   3e9f, -1e30f, infinity, -infinity};

/// Position number i, of as many components as X.
template <class X>
X positionAt(std::uint32_t i) {
  std::array<float, sizeof(X) / 4> x{};
  for (std::size_t c = 0; c < x.size(); ++c) {
    x[c] = positions[hashed(4 * i + static_cast<std::uint32_t>(c)) % positions.size()];
  }
  return std::bit_cast<X>(x);
}

template <class T, class X, class Kernel>
void check(sk::Device& device, const Kernel& kernel, Inside inside, const std::vector<sk::Shape>& shapes) {
  std::vector<X> x;
  for (std::uint32_t i = 0; i < 500; ++i) {
    if constexpr (sizeof(X) == 4) {
      x.push_back(i < positions.size() ? positions[i] : static_cast<float>(i) / 8 - 20);
    } else {
      x.push_back(positionAt<X>(i));
    }
  }
  const auto where = streamOf<X>(device, x);
  auto r = device.stream<T>({500});
  for (const sk::Shape& shape : shapes) {
    INFO("shape " << sk::toString(shape));
    const HostArray<T> a(shape, [](std::size_t i) { return valueAt<T>(static_cast<std::uint32_t>(i)); });
    kernel(a.on(device), where, r);
    CHECK(difference(r.read(), [&](std::size_t i) { return sampled(a, x[i], inside); }) == "");
  }
}

template <class Line, class Plane, class Space, class Time>
void checkMode(sk::Device& device, Inside inside, const Line& line, const Plane& plane, const Space& space,
               const Time& time) {
  check<float, float>(device, line, inside, {{1}, {5}, {67}});
  check<float2, float2>(device, plane, inside, {{1, 1}, {3, 5}, {67, 2}});
  check<float, float3>(device, space, inside, {{1, 1, 1}, {3, 4, 5}});
  check<float4, float4>(device, time, inside, {{2, 3, 4, 5}});
}

}  // namespace

TEST_CASE("sample interpolates in every rank, with the boundary mode applied to each neighbour") {
  using namespace samples;
  onSomeLayouts([](sk::Device& device) {
    checkMode(device, wrapIndex, line_wrap, plane_wrap, space_wrap, time_wrap);
    if (!takesAllCases(device)) return;  // modes are text about indices, not about layouts
    checkMode(device, clampIndex, line_clamp, plane_clamp, space_clamp, time_clamp);
    checkMode(device, mirrorIndex, line_mirror, plane_mirror, space_mirror, time_mirror);
    checkMode(device, borderIndex, line_border, plane_border, space_border, time_border);
  });
}

TEST_CASE("a whole position gives the element to the bit, and a neighbour without weight does no harm") {
  const float tiny = std::numeric_limits<float>::denorm_min();
  const std::vector<float> a = {1.1f, infinity, -0.0f, notANumber, 3.3f, tiny, -infinity, 3e38f};
  std::vector<float> x;
  for (std::size_t i = 0; i < a.size(); ++i) x.push_back(static_cast<float>(i));
  onSomeLayouts([&](sk::Device& device) {
    auto r = device.stream<float>({static_cast<std::int64_t>(x.size())});
    samples::line_clamp(streamOf<float>(device, a), streamOf<float>(device, x), r);
    const auto read = r.read();
    for (std::size_t i = 0; i < a.size(); ++i) {
      INFO(i);
      CHECK((std::isnan(a[i]) ? std::isnan(read[i])
                              : std::bit_cast<std::uint32_t>(read[i]) == std::bit_cast<std::uint32_t>(a[i])));
    }
    // A position so close below 0 that the weight rounds to 1; positions between infinite elements; NaN as a position.
    const std::vector<float> near = {-1e-10f, 0.5f, 5.5f, 2.5f, notANumber};
    auto s = device.stream<float>({5});
    samples::line_clamp(streamOf<float>(device, {1.5f, infinity, 2, notANumber, 4, 5, -infinity}),
                        streamOf<float>(device, near), s);
    CHECK(difference(s.read(), std::vector<float>{1.5f, infinity, -infinity, notANumber, notANumber}) == "");
  });
}

TEST_CASE("sample rounds a few times for each dimension") {
  constexpr std::size_t count = 4000;
  const HostArray<float2> a({13, 17}, [](std::size_t i) {
    const auto k = static_cast<std::uint32_t>(i);
    return float2{static_cast<float>(hashed(k)) * 1e-9f - 2, static_cast<float>(hashed(k + 7777)) * 1e-6f};
  });
  std::vector<float2> x;
  for (std::uint32_t i = 0; i < count; ++i) {
    x.push_back({static_cast<float>(hashed(i)) * 4e-9f, static_cast<float>(hashed(i + 99999)) * 3e-9f});
  }
  onEveryTarget([&](sk::Device& device) {
    auto r = device.stream<float2>({count});
    samples::plane_wrap(a.on(device), streamOf<float2>(device, x), r);
    const auto read = r.read();
    double worst = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const auto at = [&](std::int64_t px, std::int64_t py) {
        return a[{wrapIndex(py, 13), wrapIndex(px, 17)}];
      };
      const double fx = std::floor(x[i].x), fy = std::floor(x[i].y), tx = x[i].x - fx, ty = x[i].y - fy;
      const auto px = static_cast<std::int64_t>(fx), py = static_cast<std::int64_t>(fy);
      const double low = at(px, py).x * (1 - tx) + at(px + 1, py).x * tx;
      const double high = at(px, py + 1).x * (1 - tx) + at(px + 1, py + 1).x * tx;
      worst = std::max(worst, std::fabs(read[i].x - (low * (1 - ty) + high * ty)));
    }
    // Per dimension: two weights, two products and a sum, all below 2.3 and rounded with relative error 2^-24.
    CHECK(worst <= 2 * 5 * 2.3 * 0x1p-24);
  });
}

TEST_CASE("[[filter]] is as exact as the device's filter, and exact where that cannot serve") {
  const HostArray<float2> a({13, 17},
                            [](std::size_t i) { return valueAt<float2>(static_cast<std::uint32_t>(i)); });
  std::vector<float2> x;
  std::vector<float> u;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    x.push_back(
        {static_cast<float>(hashed(i) % 400) / 8 - 15, static_cast<float>(hashed(i + 5000) % 400) / 8 - 15});
    u.push_back(x.back().x);
  }
  // Weights of 8 bits have errors up to 2^-9 in each of two dimensions, between elements in [-8, 8].
  constexpr double bound = 2 * 16 * 0x1p-9;
  onSomeLayouts([&](sk::Device& device) {
    const auto where = streamOf<float2>(device, x);
    auto r = device.stream<float2>({1000});
    const auto farthest = [&](const HostArray<float2>& from, Inside inside) {
      const auto read = r.read();
      double worst = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const float2 wanted = sampled(from, x[i], inside);
        worst = std::max(
            {worst, std::fabs(double{read[i].x} - wanted.x), std::fabs(double{read[i].y} - wanted.y)});
      }
      return worst;
    };
    const auto whole = a.on(device);
    samples::filtered_clamp(whole, where, r);
    CHECK(farthest(a, clampIndex) <= bound);
    samples::filtered_wrap(whole, where, r);
    CHECK(farthest(a, wrapIndex) <= bound);
    samples::filtered_mirror(whole, where, r);
    CHECK(farthest(a, mirrorIndex) <= bound);
    samples::filtered_border(whole, where, r);
    CHECK(farthest(a, borderIndex) == 0);
    // A view, and a stream that is too long for a texture of the small devices.
    const auto part = whole.domain({0, 0}, {7, 9});
    const HostArray<float2> inner(part.shape(),
                                  [&](std::size_t i) { return a[positionOf(part.shape(), i)]; });
    samples::filtered_wrap(part, where, r);
    CHECK(farthest(inner, wrapIndex) == 0);
    const HostArray<float> line({131},
                                [](std::size_t i) { return valueAt<float>(static_cast<std::uint32_t>(i)); });
    auto s = device.stream<float>({1000});
    samples::filtered_line_mirror(line.on(device), streamOf<float>(device, u), s);
    const auto read = s.read();
    const double allowed = device.limits().textureSize <= smallLimits[0] ? 0 : bound;
    for (std::size_t i = 0; i < u.size(); ++i) {
      REQUIRE(std::fabs(double{read[i]} - sampled(line, u[i], mirrorIndex)) <= allowed);
    }
    // Later reads of other textures are not filtered.
    samples::plane_wrap(whole, where, r);
    CHECK(farthest(a, wrapIndex) == 0);
  });
}

TEST_CASE("floats of fewer bits are interpolated as floats") {
  const auto quarter = [](std::size_t i) { return static_cast<float>(i % 9) / 4; };
  const HostArray<sk::half3> a({9}, [&](std::size_t i) {
    return sk::half3{sk::half(quarter(i)), sk::half(quarter(i + 1)), sk::half(quarter(i + 2))};
  });
  const HostArray<sk::unorm8x4> b({3, 5}, [](std::size_t i) {
    const auto one = [&](std::size_t k) { return sk::unorm8((i + k) % 3 == 0 ? 1.0f : 0.0f); };
    return sk::unorm8x4{one(0), one(1), one(2), one(3)};
  });
  const HostArray<sk::half2> c(
      {4, 6}, [&](std::size_t i) { return sk::half2{sk::half(quarter(i)), sk::half(1.0f)}; });
  const HostArray<sk::snorm16> d({7}, [](std::size_t i) { return sk::snorm16(i % 2 == 0 ? 1.0f : -1.0f); });
  std::vector<float2> x;
  for (int i = 0; i < 200; ++i)
    x.push_back({static_cast<float>(i % 40) / 4 - 1, static_cast<float>(i / 40) / 2});
  const auto floats = [](const auto& from, auto convert) {
    return HostArray<decltype(convert(from.elements()[0]))>(
        from.shape(), [&](std::size_t i) { return convert(from.elements()[i]); });
  };
  const auto af = floats(a, [](const sk::half3& v) { return float3{float(v.x), float(v.y), float(v.z)}; });
  const auto bf =
      floats(b, [](const sk::unorm8x4& v) { return float4{float(v.x), float(v.y), float(v.z), float(v.w)}; });
  const auto cf = floats(c, [](const sk::half2& v) { return float2{float(v.x), float(v.y)}; });
  const auto df = floats(d, [](const sk::snorm16& v) { return float(v); });
  onSomeLayouts([&](sk::Device& device) {
    auto r = device.stream<float3>({200});
    auto s = device.stream<float4>({200});
    auto t = device.stream<float2>({200});
    auto u = device.stream<float>({200});
    samples::narrow(a.on(device), b.on(device), c.on(device), d.on(device), streamOf<float2>(device, x), r, s,
                    t, u);
    CHECK(difference(r.read(), [&](std::size_t i) { return sampled(af, x[i].x, clampIndex); }) == "");
    CHECK(difference(s.read(), [&](std::size_t i) { return sampled(bf, x[i], clampIndex); }) == "");
    CHECK(difference(u.read(), [&](std::size_t i) { return sampled(df, x[i].x, clampIndex); }) == "");
    const auto halves = t.read();
    for (std::size_t i = 0; i < x.size(); ++i) {  // weights of 8 bits between elements in [0, 2]
      const float2 wanted = sampled(cf, x[i], clampIndex);
      REQUIRE(std::fabs(halves[i].x - wanted.x) <= 2 * 2 * 0x1p-9);
      REQUIRE(std::fabs(halves[i].y - wanted.y) <= 2 * 2 * 0x1p-9);
    }
  });
}

TEST_CASE("sample stands wherever a value may") {
  const HostArray<float2> a({3, 4},
                            [](std::size_t i) { return valueAt<float2>(static_cast<std::uint32_t>(i)); });
  const HostArray<float> b({5},
                           [](std::size_t i) { return valueAt<float>(static_cast<std::uint32_t>(i + 100)); });
  std::vector<float2> x;
  for (std::uint32_t i = 0; i < 100; ++i) {
    x.push_back(
        {static_cast<float>(hashed(i) % 50) / 8 - 1, static_cast<float>(hashed(i + 500) % 50) / 8 - 1});
  }
  onSomeLayouts([&](sk::Device& device) {
    auto r = device.stream<float>({100}), s = device.stream<float>({100});
    samples::mixed(a.on(device), b.on(device), streamOf<float2>(device, x), r, s);
    const auto nearest = [](float v) { return static_cast<std::int64_t>(std::floor(v + 0.5f)); };
    const auto outside = [&](const float2& p) {
      const std::int64_t px = nearest(p.x), py = nearest(p.y);
      return px < 0 || px >= 4 || py < 0 || py >= 3 ? float2{100, 100} : a[{py, px}];
    };
    CHECK(difference(r.read(), [&](std::size_t i) {
            if (x[i].y <= 1) {
              return sampled(b, x[i].y, clampIndex) + b[{clampIndex(nearest(x[i].x), 5)}];
            }
            const Split u = splitAt(x[i].x), v = splitAt(x[i].y);
            const auto at = [&](std::int64_t px, std::int64_t py) {
              return outside({static_cast<float>(px), static_cast<float>(py)}).y;
            };
            return lerp(lerp(at(u.index, v.index), at(u.index + 1, v.index), u.weight),
                        lerp(at(u.index, v.index + 1), at(u.index + 1, v.index + 1), u.weight), v.weight);
          }) == "");
    CHECK(difference(s.read(), [&](std::size_t i) {
            return sampled(b, x[i].x, clampIndex) + (x[i].x + 1) + b[{1}] + outside(x[i]).x;
          }) == "");
  });
}

TEST_CASE("reduces fold what lies between elements") {
  const HostArray<float2> a({3, 4},
                            [](std::size_t i) { return valueAt<float2>(static_cast<std::uint32_t>(i)); });
  const HostArray<sk::half> b({9}, [](std::size_t i) { return sk::half(static_cast<float>(i * 5 % 9)); });
  const HostArray<float> bf({9}, [](std::size_t i) { return static_cast<float>(i * 5 % 9); });
  std::vector<float2> x;
  std::vector<float> line;
  for (std::uint32_t i = 0; i < 64; ++i) {  // exact: sums have 14 fraction bits and are below 2^9
    x.push_back(
        {static_cast<float>(hashed(i) % 50) / 8 - 1, static_cast<float>(hashed(i + 500) % 50) / 8 - 1});
    line.push_back(x.back().x);
  }
  onSomeLayouts([&](sk::Device& device) {
    float2 sum{0, 0};
    float most = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const float2 one = sampled(a, x[i], wrapIndex);
      sum = {sum.x + one.x, sum.y + one.y};
      most = std::max(most, sampled(bf, line[i], clampIndex));
    }
    CHECK(samples::along(a.on(device), streamOf<float2>(device, x)) == sum);
    CHECK(samples::highest(b.on(device), streamOf<float>(device, line)) == most);
    auto rows = device.stream<float>({8, 1});
    samples::highest(b.on(device), streamOf<float>(device, {8, 8}, line), rows);
    CHECK(difference(rows.read(), [&](std::size_t row) {
            float best = 0;
            for (std::size_t i = 0; i < 8; ++i)
              best = std::max(best, sampled(bf, line[8 * row + i], clampIndex));
            return best;
          }) == "");
  });
}

TEST_CASE("kernels of several passes interpolate in each of them") {
  const HostArray<float2> a({3, 4},
                            [](std::size_t i) { return valueAt<float2>(static_cast<std::uint32_t>(i)); });
  const HostArray<float> b({5},
                           [](std::size_t i) { return valueAt<float>(static_cast<std::uint32_t>(i + 100)); });
  std::vector<float2> x;
  for (std::uint32_t i = 0; i < 100; ++i) {
    x.push_back(
        {static_cast<float>(hashed(i) % 50) / 8 - 1, static_cast<float>(hashed(i + 500) % 50) / 8 - 1});
  }
  for (const std::string profile : {"glsl330", "essl300"}) {
    sk::Device device({.profile = profile, .limits = "guaranteed"});
    auto r0 = device.stream<float4>({100});
    auto r2 = device.stream<float2>({100});
    std::vector<sk::Stream<float>> r;
    for (int i = 0; i < 8; ++i) r.push_back(device.stream<float>({100}));
    samples::divided(a.on(device), b.on(device), streamOf<float2>(device, x), r0, r[0], r2, r[1], r[2], r[3],
                     r[4], r[5], r[6], r[7]);
    const auto here = [&](std::size_t i) { return sampled(a, x[i], mirrorIndex); };
    const auto line = [&](float at) { return sampled(b, at, clampIndex); };
    CHECK(difference(r0.read(),
                     [&](std::size_t i) { return float4{here(i).x, here(i).y, line(x[i].x), 1}; }) == "");
    CHECK(difference(r2.read(), [&](std::size_t i) { return float2{2 * here(i).y, 2 * here(i).x}; }) == "");
    const auto isOut = [&](std::size_t i) { return x[i].x < 1; };
    const auto turned = [&](std::size_t i) { return sampled(a, float2{x[i].y, x[i].x}, mirrorIndex).x; };
    CHECK(difference(r[0].read(), [&](std::size_t i) { return here(i).x; }) == "");
    CHECK(difference(r[1].read(), [&](std::size_t i) { return line(x[i].y); }) == "");
    CHECK(difference(r[2].read(), [&](std::size_t i) { return -here(i).y; }) == "");
    CHECK(difference(r[3].read(), [&](std::size_t i) { return line(x[i].y) + 1; }) == "");
    CHECK(difference(r[4].read(), [&](std::size_t i) { return isOut(i) ? 0 : line(1.5f); }) == "");
    CHECK(difference(r[5].read(), [&](std::size_t i) { return isOut(i) ? 0 : x[i].x; }) == "");
    CHECK(difference(r[6].read(), [&](std::size_t i) { return isOut(i) ? 0 : turned(i); }) == "");
    CHECK(difference(r[7].read(), [&](std::size_t i) { return isOut(i) ? 0 : turned(i) + here(i).x; }) == "");
  }
}
