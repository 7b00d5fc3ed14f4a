// SPDX-License-Identifier: MIT
//
// Promises: what asks for nothing but the place of its elements runs over the domain that a call is given, on every target and
// for every shape, and computes what a loop computes; a given domain that does not agree with the streams is refused.
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "over.sk.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "support/streams.hpp"

namespace run_tests {
namespace {

using Catch::Matchers::Contains;

const sk::Shape shapes[] = {{1}, {7}, {5000}, {70, 90}, {3, 1}, {1, 300}, {5, 6, 7}, {2, 3, 4, 5}};

/// The extents of a shape, x first.
std::vector<int> extentsOf(const sk::Shape& shape) {
  std::vector<int> extents(4, 1);
  for (int d = 0; d < shape.rank(); ++d)
    extents[static_cast<std::size_t>(d)] = static_cast<int>(shape[shape.rank() - 1 - d]);
  return extents;
}

/// Calls visit(x, y, z, w) for each place, in order.
template <class Visit>
void forEachPlace(const sk::Shape& shape, const Visit& visit) {
  const std::vector<int> n = extentsOf(shape);
  for (int w = 0; w < n[3]; ++w)
    for (int z = 0; z < n[2]; ++z)
      for (int y = 0; y < n[1]; ++y)
        for (int x = 0; x < n[0]; ++x) visit(x, y, z, w);
}

TEST_CASE("a reduce of places alone folds the domain that it is given to a value") {
  onEveryTarget([](sk::Device& device) {
    const auto pi = over::pi.over(device, {100000});
    // the midpoint rule is off by 1 / (12 n^2), and sums are compensated; each term is rounded a few times
    CHECK(pi(100000) == Approx(std::numbers::pi).epsilon(3e-7));
    CHECK(over::pi.over(device, {1})(1) == Approx(3.2).epsilon(1e-6));
    for (const sk::Shape& shape : shapes) {
      INFO(sk::toString(shape));
      int sum = 0;
      forEachPlace(shape, [&](int x, int y, int z, int w) { sum += x + 10 * y + 100 * z + 1000 * w; });
      const std::vector<int> n = extentsOf(shape);
      const auto [total, most] = over::places.over(device, shape)();
      CHECK(total == sum);
      CHECK((most == sk::int4{101 * n[0] - 1, 101 * n[1] - 1, 101 * n[2] - 1, 101 * n[3] - 1}));
    }
    CHECK(over::firstWith.over(device, {10, 10})(3) == 3);
    CHECK(over::firstWith.over(device, {2, 2})(6) == 2147483647);
    int a = 1, b = 0;
    for (int i = 0; i < 12345; ++i) {
      a = -a;
      b = i % 5 - 2 - b;
    }
    const over::Affine all = over::follow.over(device, {12345})();
    CHECK(all.a == a);
    CHECK(all.b == b);
  });
}

TEST_CASE("results go to streams and scalars, whose device is the call's") {
  onEveryTarget([](sk::Device& device) {
    auto sum = device.stream<int>({20, 1});
    auto most = device.stream<sk::int4>({20, 1});
    over::places.over({20, 300})(sum, most);
    const std::vector<int> sums = sum.read();
    for (int y = 0; y < 20; ++y) CHECK(sums[static_cast<std::size_t>(y)] == 300 * 299 / 2 + 300 * 10 * y);
    auto columns = device.stream<int>({300});
    auto mostOfColumns = device.stream<sk::int4>({300});
    over::places.over({20, 300})(columns, mostOfColumns);
    CHECK(columns.read()[7] == 20 * 7 + 10 * 190);

    auto area = device.scalar<float>();
    over::pi.over({4096})(4096, area);
    CHECK(area.read() == Approx(std::numbers::pi).epsilon(3e-7));
    const auto n = device.scalar<int>(4096);
    CHECK(over::pi.over({4096})(n) == area.read());

    auto s = device.stream<int>({3, 400});
    over::triangles.over({3, 400})(s);
    CHECK(s.read()[399] == 400 * 401 / 2);
    CHECK(s.read()[400] == 400 * 401 / 2 + 1);
    over::triangles.with({.scan = sk::Scan::Exclusive, .along = 1}).over({3, 400})(s);
    CHECK(s.read()[400] == 0);
    CHECK(s.read()[1199] == 399 * 400 / 2);
  });
}

TEST_CASE("options of a reduce hold beside a domain, in either order") {
  onEveryTarget([](sk::Device& device) {
    using sk::Accumulate, sk::Precision;
    const auto area = over::pi.over(device, {30000});
    // the terms are floats, each within 2 ulp of 4; a tree adds 15 levels of rounding
    CHECK(area.with({.accumulate = Accumulate::Tree})(30000) == Approx(std::numbers::pi).epsilon(1e-6));
    const float exact = area.with({.accumulate = Accumulate::Exact})(30000);
    CHECK(exact == Approx(std::numbers::pi).epsilon(3e-7));
    CHECK(over::pi.with({.accumulate = Accumulate::Exact}).over(device, {30000})(30000) == exact);
    CHECK(area.with({.accumulate = Accumulate::Extended})(30000) == Approx(std::numbers::pi).epsilon(3e-7));
    CHECK(area.with({.precision = Precision::Extended})(30000) == Approx(std::numbers::pi).epsilon(1.2e-7));
    CHECK(over::pi.over({1}).over(device, {30000})(30000) == area(30000));  // the last one holds
    auto held = device.scalar<float>();
    area.with({.accumulate = Accumulate::Exact})(30000, held);
    CHECK(held.read() == exact);

    // a box of the domain
    const auto whole = over::places.over(device, {50, 40});
    const auto [sum, most] = whole.with({.box = {{10, 5}, {12, 8}}})();
    CHECK(sum == 2 * (5 + 6 + 7) + 3 * 10 * (10 + 11));
    CHECK((most == sk::int4{7 + 4000, 11 + 5000, 100, 100}));
  });
}

TEST_CASE("iterators, gathers, repeated inputs, bundles and ranks take their domain from a call") {
  onEveryTarget([](sk::Device& device) {
    CHECK(over::ramp.over(device, {1000})(sk::iter(0.0f, 1000)) == 499500);
    CHECK(over::ramp.over(device, {10, 10})(sk::iter(0.0f, 100)) == 4950);
    CHECK(over::ramp.over(device, {10, 10})(sk::iter(0.0f, 100, {10, 10})) == 4950);
    const auto a = streamOf(device, std::vector<float>{1, 2, 3, 4});
    CHECK(over::around.over({4})(a) == 4 * 2 + 1 * 3 + 2 * 4 + 3 * 1);
    CHECK(over::around.over({2})(a) == 4 * 2 + 1 * 3);
    const auto one = streamOf(device, std::vector<float>{2});
    CHECK(over::repeated.over({100})(one) == 9900);
    CHECK(over::repeated.over({4})(a) == 2 + 6 + 12);
    CHECK(over::moment.over({3})(a) == 1 * 3 + 2 * 4 + 3 * 5);
    auto grid = device.stream<float>({2, 3});
    grid.fill(2);
    CHECK(over::moment.over({2, 3})(grid) == 2 * 2 * (2 + 3 + 4));
    CHECK(over::weighted.over({4})({.scale = 3, .values = a, .isScaled = true}) == 30);
    CHECK(over::weighted.over({3})({.scale = 3, .values = a, .isScaled = false}) == 6);
  });
}

TEST_CASE("kernels that only push or scatter run over the domain that they are given") {
  onDrawnLayouts([](sk::Device& device) {
    auto prime = device.stream<int>({0});
    over::primes.over({29})(100, prime);
    CHECK(prime.read() == std::vector<int>{2, 3, 5, 7, 11, 13, 17, 19, 23, 29});
    auto p = device.stream<sk::int2>({0});
    over::triple.over({2, 3})(p);
    CHECK((p.read() == std::vector<sk::int2>{{1, 0}, {2, 0}, {2, 0}, {1, 1}, {2, 1}, {2, 1}}));

    auto turned = device.stream<sk::int2>({3, 2});
    over::turn.over({2, 3})(turned);
    CHECK((turned.read() == std::vector<sk::int2>{{0, 1}, {0, 0}, {1, 1}, {1, 0}, {2, 1}, {2, 0}}));
    auto bins = device.stream<int>({10});
    bins.fill(0);
    over::count.over({20, 30})(bins);
    CHECK(bins.read() == std::vector<int>(10, 60));
    auto r = device.stream<float>({10});
    r.fill(0);
    const auto one = streamOf(device, std::vector<float>{0.5f});
    over::spread.over({3})(one, r);
    CHECK(r.read() == std::vector<float>{0.5f, 0, 1.5f, 0, 2.5f, 0, 0, 0, 0, 0});

    auto some = device.stream<int>({0});
    auto all = device.stream<int>({4});
    over::both.over({4})(3, some, all);
    CHECK(some.read() == std::vector<int>{0, 3});
    CHECK(all.read() == std::vector<int>(4, 4));
  });
}

TEST_CASE("an element output has the domain that a call is given") {
  onGlAndNative([](sk::Device& device) {
    auto r = device.stream<int>({2, 3});
    over::numbers.over({2, 3})(r);
    CHECK(r.read() == std::vector<int>{300, 301, 302, 310, 311, 312});
    auto x = device.stream<float>({5});
    auto sum = device.scalar<float>();
    over::filled.over({5})(2, x, sum);
    CHECK(x.read() == std::vector<float>{0, 2, 4, 6, 8});
    CHECK(sum.read() == 20);
    std::vector<sk::Stream<sk::float4>> outputs;
    for (int k = 0; k < 9; ++k) outputs.push_back(device.stream<sk::float4>({3, 2}));
    over::many.over({3, 2})(outputs[0], outputs[1], outputs[2], outputs[3], outputs[4], outputs[5],
                            outputs[6], outputs[7], outputs[8]);
    CHECK((outputs[8].read()[5] == sk::float4{9, 18, 0, 0}));

    CHECK_THAT(
        errorOf([&] { over::numbers.over({3, 2})(r); }),
        Contains("over::numbers: over() gives the domain the shape {3, 2}, but the output 'r' has {2, 3}"));
    CHECK_THAT(errorOf([&] { over::filled.over({6})(2, x, sum); }),
               Contains("over() gives the domain the shape {6}, but the output 'r' has {5}"));
  });
}

TEST_CASE("an empty domain is that of an empty stream") {
  onEveryTarget([](sk::Device& device) {
    CHECK(over::pi.over(device, {0})(1) == 0);
    CHECK(std::get<0>(over::places.over(device, {4, 0})()) == 0);
    auto sum = device.scalar<float>(5);
    over::pi.over({0})(1, sum);
    CHECK(sum.read() == 0);
    auto prime = streamOf(device, std::vector<int>{1, 2, 3});
    over::primes.over({0})(1, prime);
    CHECK(prime.size() == 0);
    auto bins = streamOf(device, std::vector<int>{1, 2});
    over::count.over({0, 3})(bins);
    CHECK(bins.read() == std::vector<int>{1, 2});
    auto s = device.stream<int>({0});
    over::triangles.over({0})(s);
    CHECK(s.read().empty());
  });
}

TEST_CASE("a domain may be larger than a texture") {
  CHECK(over::firstWith.over(device("glsl330", smallLimits[1]), {300, 400})(5) == 5);
}

TEST_CASE("recorded calls repeat over their domain") {
  onEveryTarget([](sk::Device& device) {
    auto bins = device.stream<int>({10});
    bins.fill(0);
    auto area = device.scalar<float>();
    sk::Loop loop = device.record([&] {
      over::count.over({20, 30})(bins);
      over::pi.over({4096})(4096, area);
    });
    loop.repeat(3);
    CHECK(bins.read() == std::vector<int>(10, 180));
    CHECK(area.read() == Approx(std::numbers::pi).epsilon(3e-7));
  });
}

TEST_CASE("a domain that nothing gives, or that does not fit, is refused") {
  onGlAndNative([](sk::Device& device) {
    auto bins = device.stream<int>({10});
    auto sum = device.scalar<float>();
    const auto a = streamOf(device, std::vector<float>{1, 2, 3, 4});
    CHECK_THAT(errorOf([&] { over::count(bins); }),
               Contains("says how many elements there are") && Contains("over::count.over({...})(...)"));
    CHECK_THAT(errorOf([&] { over::pi(4, sum); }), Contains("over::pi.over({...})(...)"));
    CHECK_THAT(errorOf([&] { over::ramp(sk::iter(0.0f, 4)); }), Contains("over::ramp.over({...})(...)"));
    CHECK_THAT(errorOf([&] { over::pi.with({.box = {{0}, {1}}})(4, sum); }),
               Contains("over::pi.over({...})(...)"));
    CHECK_THAT(errorOf([&] { over::pi.over({4})(4); }),
               Contains("what device to fold on") && Contains("over::pi.over(device, {...})(...)"));
    CHECK_THAT(errorOf([&] { over::pi.over(sk::Shape{})(4, sum); }),
               Contains("over() is given a shape without dimensions"));
    CHECK_THAT(errorOf([&] { over::count.over(sk::Shape{})(bins); }),
               Contains("over() is given a shape without dimensions"));
    CHECK_THAT(errorOf([&] { over::count.over({-1})(bins); }), Contains("an extent is negative"));
    CHECK_THAT(errorOf([&] { over::count.over({1LL << 40, 1LL << 40})(bins); }), Contains("63 bits"));
    CHECK_THAT(errorOf([&] { over::count.over({1LL << 31})(bins); }),
               Contains("the domain of shape {2147483648} has an extent above"));
    CHECK_THAT(errorOf([&] { over::pi.over({1LL << 40, 1})(4, sum); }), Contains("has an extent above"));
    if (device.profile() != "native")  // which numbers them all
      CHECK_THAT(errorOf([&] { over::pi.over({1 << 20, 1 << 20})(4, sum); }), Contains("divide it"));
    CHECK_THAT(errorOf([&] { over::repeated.over({5})(a); }),
               Contains("'x' has shape {4}, but over() gives the domain the shape {5}"));
    CHECK_THAT(errorOf([&] { over::spread.over({5})(a, sum); }),
               Contains("'x' has shape {4}, but over() gives the domain the shape {5}"));
    CHECK_THAT(errorOf([&] { over::ramp.over(device, {5})(sk::iter(0.0f, 4, {4})); }),
               Contains("the iterator 'x' has shape {4}, but the domain is {5}"));
    auto three = device.stream<int>({3});
    auto most = device.stream<sk::int4>({3});
    CHECK_THAT(errorOf([&] { over::places.over({4})(three, most); }),
               Contains("over() gives the domain the shape {4}, and the output 'sum' has {3}"));
    CHECK_THAT(errorOf([&] { over::triangles.over({4})(three); }),
               Contains("over() gives the domain the shape {4}, and the output 's' has {3}"));
    sk::Device other = sk::Device::native();
    CHECK_THAT(errorOf([&] { over::pi.over(other, {4})(4, sum); }), Contains("give both one device"));
    CHECK_THAT(errorOf([&] { over::count.over(other, {4})(bins); }), Contains("give both one device"));
    sk::Device moved = std::move(other);
    CHECK_THAT(errorOf([&] { over::pi.over(other, {4}); }), Contains("the device was moved from"));
  });
}

}  // namespace
}  // namespace run_tests
