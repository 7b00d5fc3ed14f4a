// SPDX-License-Identifier: MIT
//
// Reduces to a value against a plain loop, for every kind of operation, and many lengths and shapes. Values are chosen so
// that no order of operations rounds: all results are exact.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "reduces.sk.hpp"
#include "support/devices.hpp"
#include "support/folds.hpp"

using namespace run_tests;
using sk::float2, sk::float3, sk::float4, sk::int2, sk::uint2, sk::uint4;

namespace {

/// For tests of what a reduce computes: each shape needs its own programs, and compiling them takes most of the time.
const std::vector<sk::Shape> fewShapes = {{1}, {2}, {1021}, {13, 17}};

/// For tests of layouts and of order.
std::vector<sk::Shape> manyShapes(const sk::Device& device) {
  std::vector<sk::Shape> shapes = {{1},      {2},       {3},         {7},        {64},          {65},
                                   {1021},   {4093},    {1, 1},      {13, 17},   {1, 1021},     {1021, 1},
                                   {61, 67}, {1, 1, 1}, {7, 11, 13}, {3, 1, 67}, {3, 5, 7, 11}, {2, 2, 2, 2}};
  const bool isSmall = device.limits().textureSize <= smallLimits[0];
  if (!isSmall) shapes.insert(shapes.end(), {{65537}, {257, 263}, {16411, 2}});
  return shapes;
}

/// Checks that kernel(stream) is the fold of the elements make(i).
template <class T, class A, class Make, class Kernel, class Fold>
void check(sk::Device& device, const char* name, const Make& make, const Kernel& kernel, const A& identity,
           const Fold& fold) {
  for (const sk::Shape& shape : fewShapes) {
    INFO(name << " of shape " << sk::toString(shape));
    const HostArray<T> x(shape, make);
    const A expected = foldBox(x, {}, shape, identity, fold);
    const auto stream = x.on(device);
    const A actual = kernel(stream);
    CHECK(difference(std::vector<A>{actual}, std::vector<A>{expected}) == "");
  }
}

template <class T>
T bitsAt(std::size_t i) {
  return valueAt<T>(static_cast<std::uint32_t>(i));
}

}  // namespace

TEST_CASE("sums, products, minima and maxima of every type") {
  onEveryTarget([](sk::Device& device) {
    check<float>(device, "sum", smallAt, reduces::sum, 0.0f, [](float& r, float x) { r += x; });
    check<int>(device, "sumInt", bitsAt<int>, reduces::sumInt, 0, [](int& r, int x) {
      r = static_cast<int>(static_cast<unsigned>(r) + static_cast<unsigned>(x));
    });
    check<uint4>(device, "sumUint4", bitsAt<uint4>, reduces::sumUint4, uint4{},
                 [](uint4& r, const uint4& x) { r = {r.x + x.x, r.y + x.y, r.z + x.z, r.w + x.w}; });
    check<float3>(
        device, "sumFloat3", [](std::size_t i) { return float3{smallAt(i), smallAt(i + 7), smallAt(3 * i)}; },
        reduces::sumFloat3, float3{},
        [](float3& r, const float3& x) { r = {r.x + x.x, r.y + x.y, r.z + x.z}; });
    check<float>(
        device, "product",
        [](std::size_t i) {
          return i % 5 == 0 ? -2.0f : i % 5 == 2 ? 0.5f : i % 5 == 4 ? -1.0f : 1.0f;
        },
        reduces::product, 1.0f, [](float& r, float x) { r *= x; });
    check<std::uint32_t>(
        device, "productUint", [](std::size_t i) { return bitsAt<std::uint32_t>(i) | 1u; },
        reduces::productUint, 1u, [](std::uint32_t& r, std::uint32_t x) { r *= x; });
    check<float>(
        device, "least", [](std::size_t i) { return bitsAt<float>(i) + 20; }, reduces::least, INFINITY,
        [](float& r, float x) { r = std::min(r, x); });
    check<int2>(
        device, "greatestInt2",
        [](std::size_t i) { return int2{-bitsAt<int>(i) % 1000 - 2000, bitsAt<int>(i + 9)}; },
        reduces::greatestInt2, int2{INT32_MIN, INT32_MIN},
        [](int2& r, const int2& x) { r = {std::max(r.x, x.x), std::max(r.y, x.y)}; });
  });
}

// Where order does not matter, rows of texels are folded side by side, and a shorter last row with them.
TEST_CASE("sums of any length, and of a view") {
  onEveryLayout([](sk::Device& device) {
    const bool isSmall = device.limits().textureSize <= smallLimits[0];
    for (const std::int64_t count : {0, 1, 2, 31, 32, 33, 1021, 1024, 4095, isSmall ? 4097 : (1 << 20) + 7}) {
      INFO("length " << count);
      const HostArray<int> x({count}, [](std::size_t i) { return static_cast<int>(i % 1000) + 1; });
      const auto& elements = x.elements();
      CHECK(reduces::sumInt(x.on(device)) == std::accumulate(elements.begin(), elements.end(), 0));
    }
    auto x = HostArray<int>({12, 100}, bitsAt<int>).on(device);
    const auto part = x.domain({3, 5}, {10, 93}).read();
    const unsigned sum = std::accumulate(part.begin(), part.end(), 0u);
    CHECK(reduces::sumInt(x.domain({3, 5}, {10, 93})) == static_cast<int>(sum));
    CHECK(reduces::sumInt(x.domain({3, 5}, {3, 93})) == 0);
  });
}

TEST_CASE("bits and bools fold") {
  onEveryTarget([](sk::Device& device) {
    check<std::uint32_t>(
        device, "allBits", [](std::size_t i) { return ~(i % 700 == 3 ? 1u << (i % 32) : 0u); },
        reduces::allBits, ~0u, [](std::uint32_t& r, std::uint32_t x) { r &= x; });
    check<int>(
        device, "anyBits", [](std::size_t i) { return i % 300 == 1 ? 1 << (i % 31) : 0; }, reduces::anyBits,
        0, [](int& r, int x) { r |= x; });
    check<uint2>(device, "parity", bitsAt<uint2>, reduces::parity, uint2{},
                 [](uint2& r, const uint2& x) { r = {r.x ^ x.x, r.y ^ x.y}; });
    for (const int odd : {-1, 0, 3, 1000}) {  // the element that differs, if there is one
      for (const sk::Shape& shape : {sk::Shape{1021}, sk::Shape{19, 53}, sk::Shape{1}}) {
        INFO("element " << odd << " of shape " << sk::toString(shape));
        const bool isThere = odd >= 0 && odd < shape.size();
        std::vector<std::uint8_t> ones(static_cast<std::size_t>(shape.size()), 1), zeros(ones.size(), 0);
        if (isThere) {
          ones[static_cast<std::size_t>(odd)] = 0;
          zeros[static_cast<std::size_t>(odd)] = 1;
        }
        CHECK(reduces::every(streamOf<bool>(device, shape, ones)) == !isThere);
        CHECK(reduces::some(streamOf<bool>(device, shape, zeros)) == isThere);
      }
    }
  });
}

TEST_CASE("how partial results combine follows from the body, or from an overload") {
  onSomeLayouts([](sk::Device& device) {
    check<float>(device, "squares", smallAt, reduces::squares, 0.0f, [](float& r, float x) { r += x * x; });
    check<float2>(
        device, "sumSwapped", [](std::size_t i) { return float2{smallAt(i), smallAt(i + 1)}; },
        reduces::sumSwapped, float2{}, [](float2& r, const float2& x) { r = {r.x + x.y, r.y + x.x}; });
    check<float>(device, "sumOneMore", smallAt, reduces::sumOneMore, 0.0f,
                 [](float& r, float x) { r += x + 2; });
    check<float>(device, "countPositive", smallAt, reduces::countPositive, 0,
                 [](int& r, float x) { r += x > 0; });
    check<float>(device, "range", bitsAt<float>, reduces::range, float2{INFINITY, -INFINITY},
                 [](float2& r, float x) { r = {std::min(r.x, x), std::max(r.y, x)}; });
    check<float2>(device, "widest", bitsAt<float2>, reduces::widest, -INFINITY,
                  [](float& r, const float2& x) { r = std::max(r, std::fabs(x.y - x.x)); });
    for (const sk::Shape& shape : fewShapes) {
      INFO("moments and average of shape " << sk::toString(shape));
      const HostArray<float> x(shape, smallAt);
      const auto stream = x.on(device);
      const reduces::Moments m = reduces::moments(stream);
      const float sum = foldBox(x, {}, shape, 0.0f, [](float& r, float v) { r += v; });
      CHECK(m.sum == sum);
      CHECK(m.squares == foldBox(x, {}, shape, 0.0f, [](float& r, float v) { r += v * v; }));
      CHECK(m.count == shape.size());
      const reduces::Mean a = reduces::average(stream);
      CHECK(a.n == shape.size());
      // A mean of values up to 8: each step rounds by up to 2^-22, and an element passes through about log(n) steps.
      CHECK(std::fabs(a.mean - double{sum} / double(shape.size())) < 1e-5);
    }
  });
}

TEST_CASE("a fold means the same whether a helper function, a kernel or the reduce itself writes it") {
  onGlAndNative([](sk::Device& device) {
    for (const std::int64_t n : {1, 4, 1021}) {
      const HostArray<float> a({n}, smallAt);
      const auto stream = a.on(device);
      float expected = 0, largest = 0;
      for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
        expected += smallAt(i) + 100;
        largest = std::max(largest, smallAt(i) * smallAt(i));
      }
      CHECK(helped::plain(stream, 100) == expected);
      CHECK(helped::byFunction(stream, 100) == expected);
      CHECK(helped::bySteps(stream, 100) == expected);
      CHECK(helped::byReference(stream, 100) == expected);
      CHECK(helped::byKernel(stream, 100) == expected);
      CHECK(helped::most(stream) == largest);
    }
  });
}

TEST_CASE("structs fold: the nearest, the first of the greatest") {
  onSomeLayouts([](sk::Device& device) {
    for (const sk::Shape& shape : fewShapes) {
      INFO("shape " << sk::toString(shape));
      std::vector<reduces::Hit> hits;
      std::vector<float> x;
      for (std::size_t i = 0; i < static_cast<std::size_t>(shape.size()); ++i) {
        hits.push_back({std::fabs(smallAt(i)), static_cast<int>(i)});
        x.push_back(smallAt(2 * i));
      }
      const auto first =
          std::min_element(hits.begin(), hits.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
      const reduces::Hit best = reduces::nearest(streamOf<reduces::Hit>(device, shape, hits));
      CHECK(best.t == first->t);
      CHECK(best.id == first->id);

      auto located = device.stream<reduces::Most>(shape);
      reduces::located(streamOf<float>(device, shape, x), located);
      const reduces::Most most = reduces::argmax(located);
      const auto greatest = std::max_element(x.begin(), x.end());
      const Position p = positionOf(shape, static_cast<std::size_t>(greatest - x.begin()));
      const auto rank = static_cast<std::size_t>(shape.rank());
      CHECK(most.value == *greatest);
      CHECK(most.at == p[rank - 1] + (rank > 1 ? 1000 * p[rank - 2] : 0));
      CHECK(most.seen == shape.size());
    }
  });
}

TEST_CASE("order is kept where it matters") {
  const auto compose = [](reduces::Affine& r, const reduces::Affine& f) { r = {f.a * r.a, f.a * r.b + f.b}; };
  const auto isEqual = [](const reduces::Affine& a, const reduces::Affine& b) {
    return a.a == b.a && a.b == b.b;
  };
  onEveryLayout([&](sk::Device& device) {
    for (const sk::Shape& shape : manyShapes(device)) {
      INFO("shape " << sk::toString(shape));
      const HostArray<reduces::Affine> f(shape, [](std::size_t i) {
        return reduces::Affine{bitsAt<unsigned>(i) | 1u, bitsAt<unsigned>(i + 5)};
      });
      const auto expected = foldBox(f, {}, shape, reduces::Affine{1, 0}, compose);
      CHECK(isEqual(reduces::compose(f.on(device)), expected));
      if (shape.rank() > 1) continue;  // the rest tests other programs, not other layouts
      CHECK(isEqual(reduces::composeSeeded(f.on(device)), expected));

      const HostArray<int> n(shape, [](std::size_t i) { return static_cast<int>(i) + 3; });
      CHECK(reduces::last(n.on(device)) == shape.size() + 2);
      CHECK(reduces::first(n.on(device)) == 3);
      const HostArray<float4> m(shape, [](std::size_t i) {
        return float4{smallAt(i) + 8, smallAt(i + 1) + 8, smallAt(i + 2) + 8, smallAt(i + 3) + 8};
      });
      const float4 product = foldBox(m, {}, shape, float4{1, 0, 0, 1}, [](float4& r, const float4& b) {
        const auto mod = [](float v) { return std::fmod(v, 251.0f); };
        r = {mod(r.x * b.x + r.y * b.z), mod(r.x * b.y + r.y * b.w), mod(r.z * b.x + r.w * b.z),
             mod(r.z * b.y + r.w * b.w)};
      });
      const float4 actual = reduces::matrices(m.on(device));
      CHECK(difference(std::vector<float4>{actual}, std::vector<float4>{product}) == "");
    }
  });
}

TEST_CASE("an empty stream gives the identity, or an error where there is none") {
  onEveryTarget([](sk::Device& device) {
    for (const sk::Shape& shape : {sk::Shape{0}, sk::Shape{0, 5}, sk::Shape{3, 0, 4}}) {
      INFO("shape " << sk::toString(shape));
      CHECK(reduces::sum(device.stream<float>(shape)) == 0);
      CHECK(reduces::product(device.stream<float>(shape)) == 1);
      CHECK(reduces::productUint(device.stream<std::uint32_t>(shape)) == 1u);
      CHECK(reduces::least(device.stream<float>(shape)) == INFINITY);
      CHECK(reduces::greatestInt2(device.stream<int2>(shape)) == int2{INT32_MIN, INT32_MIN});
      CHECK(reduces::allBits(device.stream<std::uint32_t>(shape)) == ~0u);
      CHECK(reduces::every(device.stream<bool>(shape)) == true);
      CHECK(reduces::some(device.stream<bool>(shape)) == false);
      CHECK(reduces::moments(device.stream<float>(shape)).count == 0);
      CHECK(reduces::range(device.stream<float>(shape)) == float2{INFINITY, -INFINITY});
      CHECK(reduces::matrices(device.stream<float4>(shape)) == float4{1, 0, 0, 1});
      CHECK(reduces::compose(device.stream<reduces::Affine>(shape)).a == 1u);
      CHECK_THROWS_AS(reduces::nearest(device.stream<reduces::Hit>(shape)), sk::Error);
      CHECK_THROWS_AS(reduces::last(device.stream<int>(shape)), sk::Error);
    }
  });
}
