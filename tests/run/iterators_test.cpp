// SPDX-License-Identifier: MIT
//
// Iterators over any domain: integers are exact, floats have the error of one multiplication and one addition.
#include "iterators.sk.hpp"

#include <array>
#include <bit>
#include <cmath>

#include "support/devices.hpp"
#include "support/host_array.hpp"
#include "support/values.hpp"

using namespace run_tests;

namespace {

const std::vector<sk::Shape> shapes = {{1},     {7},     {1021},    {1, 1},     {13, 17},     {5, 1},
                                       {67, 3}, {3, 67}, {2, 3, 5}, {67, 2, 3}, {2, 3, 2, 5}, {3, 1, 5, 7}};

/// The extents, x first, as in kernels.
std::array<std::int64_t, 4> xFirst(const sk::Shape& shape) {
  std::array<std::int64_t, 4> e = {1, 1, 1, 1};
  for (int d = 0; d < shape.rank(); ++d) e[static_cast<std::size_t>(d)] = shape[shape.rank() - 1 - d];
  return e;
}

/// The number of steps from the begin at element n, for component c of `width` components.
std::int64_t stepsAt(const sk::Shape& shape, int width, std::size_t c, std::int64_t n) {
  if (width == 1 || shape.rank() == 1) return n;
  const auto e = xFirst(shape);
  for (std::size_t d = 0; d < c; ++d) n /= e[d];
  return n % e[c];
}

std::int64_t stepCount(const sk::Shape& shape, int width, std::size_t c) {
  return width == 1 || shape.rank() == 1 ? shape.size() : xFirst(shape)[c];
}

template <class T, std::size_t Width>
using Components = std::array<T, Width>;

/// Each component's begin, and its end: begin plus `step` times the number of steps.
template <class T, int Width>
struct Ramp {
  Components<T, Width> begin, end;
};

template <class T, int Width>
Ramp<T, Width> integerRamp(const sk::Shape& shape) {
  Ramp<T, Width> ramp;
  for (std::size_t c = 0; c < Width; ++c) {
    const std::int64_t begin =
        std::is_signed_v<T> ? -1000 - static_cast<int>(c) : 4000000000 - static_cast<int>(c);
    const std::int64_t step = (std::is_signed_v<T> ? 3 : -5) + static_cast<int>(c);
    ramp.begin[c] = static_cast<T>(begin);
    ramp.end[c] = static_cast<T>(begin + step * stepCount(shape, Width, c));
  }
  return ramp;
}

/// sk's vectors have the same memory layout as Components.
template <class V, class T, int Width>
sk::Iter<V> iterOf(const Ramp<T, Width>& ramp) {
  static_assert(sizeof(V) == sizeof(ramp.begin));
  return sk::iter(std::bit_cast<V>(ramp.begin), std::bit_cast<V>(ramp.end));
}

template <class F, class I, class U, int Width, class Kernel>
void check(sk::Device& device, const Kernel& kernel) {
  for (const sk::Shape& shape : shapes) {
    if (Width > 1 && shape.rank() > 1 && shape.rank() != Width) continue;
    INFO("shape " << sk::toString(shape) << ", " << Width << " components");
    const auto ints = integerRamp<int, Width>(shape);
    const auto uints = integerRamp<unsigned, Width>(shape);
    Ramp<float, Width> floats;
    for (std::size_t c = 0; c < Width; ++c) {
      floats.begin[c] = 0.1F * static_cast<float>(c + 1);
      floats.end[c] = -7.3F + static_cast<float>(c);
    }
    auto rf = device.stream<F>(shape);
    auto ri = device.stream<I>(shape);
    auto ru = device.stream<U>(shape);
    kernel(iterOf<F>(floats), iterOf<I>(ints), iterOf<U>(uints), rf, ri, ru);
    const auto integers = [&](const auto& ramp, auto zero) {
      using T = decltype(zero);
      return [&](std::size_t i) {
        Components<T, Width> value;
        for (std::size_t c = 0; c < Width; ++c) {
          const std::int64_t steps = stepCount(shape, Width, c);
          const std::int64_t step = (std::int64_t{ramp.end[c]} - std::int64_t{ramp.begin[c]}) / steps;
          value[c] =
              static_cast<T>(ramp.begin[c] + step * stepsAt(shape, Width, c, static_cast<std::int64_t>(i)));
        }
        return value;
      };
    };
    const auto readInts = ri.read();
    const auto readUints = ru.read();
    const auto readFloats = rf.read();
    for (std::size_t i = 0; i < readInts.size(); ++i) {
      INFO("element " << i);
      REQUIRE(std::bit_cast<Components<int, Width>>(readInts[i]) == integers(ints, 0)(i));
      REQUIRE(std::bit_cast<Components<unsigned, Width>>(readUints[i]) == integers(uints, 0U)(i));
      const auto got = std::bit_cast<Components<float, Width>>(readFloats[i]);
      for (std::size_t c = 0; c < Width; ++c) {
        const double length = double{floats.end[c]} - double{floats.begin[c]};
        const double wanted =
            floats.begin[c] +
            length * static_cast<double>(stepsAt(shape, Width, c, static_cast<std::int64_t>(i))) /
                static_cast<double>(stepCount(shape, Width, c));
        const auto steps = static_cast<double>(stepCount(shape, Width, c));
        const float step = steps == 1 ? 0.0F : static_cast<float>(length / steps);
        const auto k = static_cast<float>(stepsAt(shape, Width, c, static_cast<std::int64_t>(i)));
        const float distance = k * step;
        REQUIRE(got[c] == floats.begin[c] + distance);
        // The step and the product are rounded once each, relative to the length, and then the sum is rounded.
        const double ulp = std::ldexp(1.0, -24);
        REQUIRE(std::abs(got[c] - wanted) <= 2 * ulp * std::abs(length) + ulp * std::abs(wanted));
      }
    }
  }
}

}  // namespace

TEST_CASE("iterators of every type over domains of every rank") {
  onEveryLayout([](sk::Device& device) {
    check<float, int, unsigned, 1>(device, iterators::scalars);
    check<sk::float2, sk::int2, sk::uint2, 2>(device, iterators::pairs);
    check<sk::float3, sk::int3, sk::uint3, 3>(device, iterators::triples);
    check<sk::float4, sk::int4, sk::uint4, 4>(device, iterators::quadruples);
  });
}

TEST_CASE("a float2 iterator runs x along the rows and y along the columns") {
  onSomeLayouts([](sk::Device& device) {
    const sk::Shape shape = {57, 70};
    auto r = device.stream<sk::float2>(shape);
    auto i = device.stream<sk::int2>(shape);
    auto u = device.stream<sk::uint2>(shape);
    iterators::pairs(sk::iter(sk::float2{0, 10}, sk::float2{70, 67}, shape),
                     sk::iter(sk::int2{0, 0}, sk::int2{70, 57}), sk::iter(sk::uint2{0, 0}, sk::uint2{0, 0}),
                     r, i, u);
    CHECK(difference(r.read(), [](std::size_t n) {
            return sk::float2{static_cast<float>(n % 70), static_cast<float>(10 + n / 70)};
          }) == "");
    CHECK(difference(i.read(), [](std::size_t n) {
            return sk::int2{static_cast<int>(n % 70), static_cast<int>(n / 70)};
          }) == "");
  });
}

TEST_CASE("a ramp between the largest floats") {
  onSomeLayouts([](sk::Device& device) {
    for (const std::int64_t n : {1, 2, 3, 7, 100, 4097}) {
      for (const auto& [begin, end] :
           {std::pair{3e38F, -3e38F}, std::pair{-3.4e38F, 3.4e38F}, std::pair{-1e38F, 3e38F}}) {
        auto r = device.stream<float>({n});
        auto i = device.stream<int>({n});
        auto u = device.stream<unsigned>({n});
        iterators::scalars(sk::iter(begin, end), sk::iter(0, 0), sk::iter(0U, 0U), r, i, u);
        const std::vector<float> got = r.read();
        const double length = double{end} - double{begin};
        for (std::int64_t k = 0; k < n; ++k) {
          const double wanted = double{begin} + length * static_cast<double>(k) / static_cast<double>(n);
          INFO(n << " steps from " << begin << ": " << k);
          CHECK(std::fabs(got[static_cast<std::size_t>(k)] - wanted) <=
                0x1p-23 * std::fabs(length) + 0x1p-24 * std::fabs(wanted));
        }
      }
    }
  });
}

TEST_CASE("iterators in views, in place, and in kernels that call kernels") {
  onSomeLayouts([](sk::Device& device) {
    const sk::Shape shape = {61, 67};
    auto x = streamOf<float>(device, shape, std::vector<float>(static_cast<std::size_t>(shape.size()), 1.0F));
    auto at = device.stream<sk::int4>(shape);
    auto part = x.domain({3, 5}, {13, 25});
    iterators::used(part, sk::iter(0.0F, 200.0F), part, at.domain({3, 5}, {13, 25}));
    CHECK(difference(part.read(), [](std::size_t n) { return 1.0F + 2.0F * static_cast<float>(n); }) == "");
    CHECK(difference(at.domain({3, 5}, {13, 25}).read(), [](std::size_t n) {
            return sk::int4{static_cast<int>(n % 20) + 20, static_cast<int>(n / 20) + 10, 1, 1};
          }) == "");
    CHECK(x.domain({0, 0}, {1, 1}).read()[0] == 1.0F);
    auto none = device.stream<float>({0});
    auto nowhere = device.stream<sk::int4>({0});
    iterators::used(none, sk::iter(0.0F, 1.0F), none, nowhere);
  });
}

TEST_CASE("iterators that do not fit are refused") {
  onEveryTarget([](sk::Device& device) {
    auto f = device.stream<float>({4, 5});
    auto i = device.stream<int>({4, 5});
    auto u = device.stream<unsigned>({4, 5});
    CHECK_THROWS_WITH(
        iterators::scalars(sk::iter(0.0F, 1.0F), sk::iter(0, 30), sk::iter(0U, 20U), f, i, u),
        Catch::Contains("scalars") && Catch::Contains("'i'") && Catch::Contains("from 0 to 30 in 20 steps"));
    CHECK_THROWS_WITH(
        iterators::scalars(sk::iter(0.0F, 1.0F, {5, 4}), sk::iter(0, 20), sk::iter(0U, 20U), f, i, u),
        Catch::Contains("'f' has shape {5, 4}, but the domain is {4, 5}"));
    auto f3 = device.stream<sk::float3>({4, 5});
    auto i3 = device.stream<sk::int3>({4, 5});
    auto u3 = device.stream<sk::uint3>({4, 5});
    CHECK_THROWS_WITH(
        iterators::triples(sk::iter(sk::float3{}, sk::float3{}), sk::iter(sk::int3{}, sk::int3{}),
                           sk::iter(sk::uint3{}, sk::uint3{}), f3, i3, u3),
        Catch::Contains("'f' has 3 components, but the domain {4, 5} has 2 dimensions"));
  });
}
