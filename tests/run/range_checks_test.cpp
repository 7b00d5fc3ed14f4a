// SPDX-License-Identifier: MIT
//
// Promises: with SK_CHECK=ranges, which tests/run/CMakeLists.txt sets, a call with an argument or a result outside of its range
// throws an error of kind Misuse, which names the kernel, the parameter, the element and the value, and changes nothing; every other
// call computes what it computes without. Without the setting ([.off]), nothing is checked.
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "range_checks.sk.hpp"
#include "sk/placed.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

const std::string none = "no error";

std::string outside(const std::string& what, const std::string& range) {
  return what + ", outside of its range " + range + " (SK_CHECK=ranges)";
}

template <class T>
sk::Stream<T> streamOf(sk::Device& device, std::vector<T> values) {
  auto x = device.stream<T>({static_cast<std::int64_t>(values.size())});
  x.write(values);
  return x;
}

TEST_CASE("arguments and results outside of their ranges are named, and nothing changes") {
  onSomeLayouts([](sk::Device& device) {
    std::vector<float> values(200, 4);
    auto x = streamOf(device, values), r = streamOf<float>(device, std::vector<float>(200, 7));
    scaled(1, x, r);
    CHECK(r.read() == values);
    values[77] = -10;
    values[150] = 11;
    x.write(values);
    r.fill(7);
    const std::vector<float> before(200, 7);
    CHECK(errorOf([&] { scaled(1, x, r); }) == outside("scaled: 'x' is 11 at {150}", "[-10, 10]"));
    CHECK(errorOf([&] { scaled(1.5f, x, r); }) == outside("scaled: 'k' is 1.5", "[0, 1]"));
    CHECK(errorOf([&] { scaled(std::nanf(""), x, r); }) == outside("scaled: 'k' is nan", "[0, 1]"));
    values[150] = 10;
    x.write(values);
    CHECK(errorOf([&] { scaled(1, x, r); }) == outside("scaled: 'r' would be -10 at {77}", "[-5, 5]"));
    CHECK(r.read() == before);
    CHECK(errorOf([&] { scaled(0.75f, x, x); }) == outside("scaled: 'r' would be -7.5 at {77}", "[-5, 5]"));
    CHECK(x.read() == values);
    CHECK(errorOf([&] { scaled(0.5f, x, x); }) == none);
    CHECK(x.read()[77] == -5);
    try {
      scaled(2, x, r);
      FAIL("it did not throw");
    } catch (const sk::Error& error) {
      CHECK(error.kind() == sk::Error::Kind::Misuse);
    }
    // streams of one element stand for uniforms; an empty domain has no element
    auto k = streamOf<float>(device, {-1});
    CHECK(errorOf([&] { scaled(k, x, r); }) == outside("scaled: 'k' is -1 at {0}", "[0, 1]"));
    auto e = device.stream<float>({0}), n = device.stream<float>({0});
    CHECK(errorOf([&] { scaled(1, e, n); }) == none);
  });
}

TEST_CASE("gathers, boxes and views count with the elements that they are given") {
  onEveryTarget([](sk::Device& device) {
    auto u = device.stream<int>({5, 6}), v = device.stream<int>({5, 6});
    std::vector<int> values(30, 1);
    u.write(values);
    v.fill(-1);
    values[3 * 6 + 4] = 12;
    u.write(values);
    CHECK(errorOf([&] { around(u, v); }) == outside("around: 'u' is 12 at {3, 4}", "[0, 9]"));
    CHECK(errorOf([&] { around(u.domain({2, 2}, {5, 6}), v.domain({2, 2}, {5, 6})); }) ==
          outside("around: 'u' is 12 at {1, 2}", "[0, 9]"));
    CHECK(errorOf([&] { around(u.domain({0, 0}, {3, 6}), v.domain({0, 0}, {3, 6})); }) == none);
    values[3 * 6 + 4] = 9;
    values[3 * 6 + 3] = 9;
    u.write(values);
    CHECK(errorOf([&] { around(u, v); }) == outside("around: 'r' would be 19 at {3, 3}", "[0, 18]"));
    CHECK(v.read()[4 * 6] == -1);
    // only the elements in a box are written
    CHECK(errorOf([&] { around.with({.box = {{0, 0}, {3, 6}}})(u, v); }) == none);
    CHECK(errorOf([&] { around.with({.box = {{2, 3}, {5, 6}}})(u, v); }) ==
          outside("around: 'r' would be 19 at {3, 3}", "[0, 18]"));
    // strided views
    auto line = sk::stride(u, {1, 2});
    CHECK(errorOf([&] { around(line, v.domain({0, 0}, {5, 3})); }) == none);
  });
}

TEST_CASE("every type is compared, component by component") {
  onEveryTarget([](sk::Device& device) {
    auto c = streamOf<sk::float3>(device, {{0, 1, 0}, {1, 1, 1}});
    auto h = streamOf<sk::half>(device, {sk::half(0.1f), sk::half(0.05f)});
    auto d = streamOf<double>(device, {0, 1e-301});
    auto n = streamOf<std::uint8_t>(device, {200, 0});
    auto unbounded = streamOf<float>(device, {0, std::numeric_limits<float>::infinity()});
    auto r = device.stream<float>({2});
    const auto error = [&] { return errorOf([&] { typed(c, h, d, n, unbounded, r); }); };
    CHECK(error() == none);
    c.write(std::vector<sk::float3>{{0, 1, 0}, {1, -1, 2}});
    CHECK(error() == outside("typed: 'c.y' is -1 at {1}", "[0, 1]"));
    c.fill({0, 0, 0});
    h.fill(sk::half(0.2f));
    CHECK(error() == outside("typed: 'h' is 0.19995117 at {0}", "[0, 0.1]"));
    h.fill(sk::half(0.0f));
    d.write(std::vector<double>{0, 2e-300});
    CHECK(error() == outside("typed: 'd' is 2e-300 at {1}", "[-1e-300, 1e-300]"));
    d.fill(0);
    n.fill(201);
    CHECK(error() == outside("typed: 'n' is 201 at {0}", "[0, 200]"));
    n.fill(0);
    unbounded.fill(-1);
    CHECK(error() == outside("typed: 'unbounded' is -1 at {0}", "[0, inf]"));
    unbounded.fill(std::nanf(""));
    CHECK(error() == outside("typed: 'unbounded' is nan at {0}", "[0, inf]"));
  });
}

TEST_CASE("streams of doubles are compared with all their bits") {
  onEveryTarget([](sk::Device& device) {
    auto x = device.stream<float>({2}, sk::Storage::Double);
    auto r = device.stream<float>({2});
    x.writeReals(std::vector<double>{1, 10});
    CHECK(errorOf([&] { scaled(0.5f, x, r); }) == none);
    x.writeReals(std::vector<double>{1, 10 + 1e-12});
    CHECK(errorOf([&] { scaled(0.5f, x, r); }) ==
          outside("scaled: 'x' is 10.000000000001 at {1}", "[-10, 10]"));
  });
}

TEST_CASE("bundles, arrays, specialization constants and append outputs have ranges") {
  onEveryTarget([](sk::Device& device) {
    auto x = streamOf<float>(device, {1, 2, 3}), r = streamOf<float>(device, {0, 0, 0});
    auto height = streamOf<float>(device, {1, 2, -2.5f});
    CHECK(errorOf([&] { bundled({.level = 1, .height = x.domain({0}, {2})}, r.domain({0}, {2})); }) == none);
    CHECK(errorOf([&] { bundled({.level = 1, .height = height}, r); }) ==
          outside("bundled: 'field.height' is -2.5 at {2}", "[-2, 2]"));
    CHECK(errorOf([&] { bundled({.level = 2, .height = height}, r); }) ==
          outside("bundled: 'field.level' is 2", "[0, 1]"));

    CHECK(errorOf([&] { switched(2, sk::none, x, r); }) == none);
    CHECK(errorOf([&] { switched(2, height, x, r); }) == none);  // not read
    CHECK(errorOf([&] { switched(3, height, x, r); }) == outside("switched: 'w' is 2 at {1}", "[0, 1]"));
    CHECK(errorOf([&] { switched(4, height, x, r); }) == outside("switched: 'n' is 4", "[1, 3]"));
    CHECK(errorOf([&] { weighted(std::array{0.5f, 1.0f, 0.0f}, x, r); }) == none);
    CHECK(errorOf([&] { weighted(std::array{0.5f, 1.0f, 1.5f}, x, r); }) ==
          outside("weighted: 'w[2]' is 1.5", "[0, 1]"));

    auto n = streamOf<int>(device, {0, 3, 5}), list = device.stream<int>({0});
    picked(n, list);
    CHECK(list.read() == std::vector<int>{3, 5});
    n.write(std::vector<int>{0, 4, 6});
    CHECK(errorOf([&] { picked(n, list); }) == outside("picked: 'r' would be 6 at {1}", "[0, 5]"));
    CHECK(list.read() == std::vector<int>{3, 5});

    auto histogram = streamOf<int>(device, {0, 0, 0, -5});  // the last stays as it is
    n.write(std::vector<int>{0, 2, 2});
    CHECK(errorOf([&] { counted(n, histogram); }) == none);
    CHECK(histogram.read() == std::vector<int>{1, 0, 2, -5});
    CHECK(errorOf([&] { counted(n, histogram); }) ==
          outside("counted: 'histogram' would be 4 at {2}", "[0, 2]"));
    CHECK(histogram.read() == std::vector<int>{1, 0, 2, -5});
  });
}

TEST_CASE("reduces, scans and folded outputs have ranges") {
  onEveryTarget([](sk::Device& device) {
    auto x = streamOf<float>(device, {1, 2, 3, 4}), halves = streamOf<float>(device, {0, 0});
    CHECK(sum(x) == 10);
    sum(x, halves);
    CHECK(halves.read() == std::vector<float>{3, 7});
    x.write(std::vector<float>{1, 2, 3, -4});
    CHECK(errorOf([&] { static_cast<void>(sum(x)); }) == outside("sum: 'x' is -4 at {3}", "[0, 100]"));
    CHECK(sum.with({.box = {{0}, {3}}})(x.domain({0}, {3})) == 6);
    x.write(std::vector<float>{1, 2, 90, 80});
    float total = 3;
    CHECK(errorOf([&] { total = sum(x); }) == outside("sum: 'total' would be 173", "[0, 150]"));
    CHECK(total == 3);
    CHECK(errorOf([&] { sum(x, halves); }) == outside("sum: 'total' would be 170 at {1}", "[0, 150]"));
    CHECK(errorOf([&] { static_cast<void>(sum.with({.accumulate = sk::Accumulate::Exact})(x)); }) ==
          outside("sum: 'total' would be 173", "[0, 150]"));
    CHECK(halves.read() == std::vector<float>{3, 7});
    auto starts = streamOf<int>(device, {0, 1, 2});
    sum(sk::Rows(starts)(x), halves);
    CHECK(halves.read() == std::vector<float>{1, 2});

    auto n = streamOf<int>(device, {1, 2, 3, 4});
    prefix(n, n);
    CHECK(n.read() == std::vector<int>{1, 3, 6, 10});
    CHECK(errorOf([&] { prefix(n, n); }) == outside("prefix: 'x' is 10 at {3}", "[0, 9]"));
    n.write(std::vector<int>{9, 9, 3, 4});
    CHECK(errorOf([&] { prefix(n, n); }) == outside("prefix: 's' would be 21 at {2}", "[0, 20]"));
    CHECK(n.read() == std::vector<int>{9, 9, 3, 4});

    auto one = streamOf<float>(device, {7});
    x.write(std::vector<float>{1, 2, 3, 0});
    squares(x, x, one);
    CHECK(one.read() == std::vector<float>{14});
    CHECK(x.read() == std::vector<float>{1, 4, 9, 0});
    CHECK(errorOf([&] { squares(x, x, one); }) == outside("squares: 'x' is 9 at {2}", "[-4, 4]"));
    x.write(std::vector<float>{3, 0, -4, 0});
    CHECK(errorOf([&] { squares(x, x, one); }) == outside("squares: 'r' would be 16 at {2}", "[0, 9]"));
    x.write(std::vector<float>{3, 3, -3, 0});
    CHECK(errorOf([&] { squares(x, x, one); }) == outside("squares: 'total' would be 27 at {0}", "[0, 20]"));
    CHECK(one.read() == std::vector<float>{14});
    CHECK(x.read() == std::vector<float>{3, 3, -3, 0});
  });
}

TEST_CASE("a loop stops at the call that leaves a range") {
  onEveryTarget([](sk::Device& device) {
    auto u = streamOf<float>(device, {1, 2, 3}), v = streamOf<float>(device, {0, 0, 0});
    sk::Loop loop = device.record([&] {
      stepped(u, v);
      scaled(0.5f, v, u);
    });
    loop.repeat(1);
    CHECK(u.read() == std::vector<float>{1, 1.5f, 2});
    u.write(std::vector<float>{8, 0, 0});
    CHECK(errorOf([&] { loop.repeat(1); }) == outside("stepped: 'r' would be 9 at {0}", "[0, 8]"));
    CHECK(v.read() == std::vector<float>{2, 3, 4});
    auto n = streamOf<int>(device, {1, 2});
    auto done = device.scalar<bool>();
    done = false;
    auto total = device.scalar<float>();
    sk::Loop until = device.record([&] {
      stepped(n, n);
      sum(v, total);
      done = total > 100.0f;
    });
    CHECK(errorOf([&] { until.until(done, {.every = 4, .most = 30}); }) ==
          outside("stepped: 'r' would be 9 at {1}", "[0, 8]"));
    CHECK(n.read() == std::vector<int>{7, 8});
  });
}

TEST_CASE("placed streams give the index in the whole, and given domains have ranges, too") {
  onEveryTarget([](sk::Device& device) {
    auto u = device.stream<int>({4, 6}), v = device.stream<int>({3, 6});
    const sk::Shape whole{10, 6};
    const auto error = [&](int value) {
      std::vector<int> values(24, 1);
      values[2 * 6 + 2] = values[2 * 6 + 3] = value;
      u.write(values);
      return errorOf([&] {
        around.with({.box = {{5, 0}, {7, 6}}})(sk::placed(u, {{4, 0}, whole}),
                                               sk::placed(v, {{5, 0}, whole}));
      });
    };
    CHECK(error(8) == none);
    CHECK(error(10) == outside("around: 'u' is 10 at {6, 2}", "[0, 9]"));
    CHECK(error(9) == outside("around: 'r' would be 19 at {6, 2}", "[0, 18]"));
    auto bins = streamOf<int>(device, {1}), histogram = streamOf<int>(device, {0, 0, 0});
    CHECK(errorOf([&] { counted.over({3})(bins, histogram); }) ==
          outside("counted: 'histogram' would be 3 at {1}", "[0, 2]"));
  });
}

TEST_CASE("without SK_CHECK nothing is checked", "[.off]") {
  onEveryTarget([](sk::Device& device) {
    auto x = streamOf<float>(device, {1, -20, 3}), r = streamOf<float>(device, {0, 0, 0});
    CHECK(errorOf([&] { scaled(2, x, r); }) == none);
    CHECK(r.read() == std::vector<float>{2, -40, 6});
    CHECK(sum(x) == -16);
  });
}

}  // namespace
}  // namespace run_tests
