// SPDX-License-Identifier: MIT
//
// Promises: with SK_CHECK=asserts, which tests/run/CMakeLists.txt sets, a call for which a condition is false throws an error of
// kind Misuse, which names the assertion and the first element that fails, and writes nothing; every other call computes what
// it computes without. Without the setting ([.off]), no assertion is evaluated.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "assert_checks.sk.hpp"
#include "error_of.hpp"
#include "sk/placed.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

std::string failure(int line, const char* condition, const char* kernel, const char* element) {
  return "assert_checks.sk:" + std::to_string(line) + ": assertion '" + condition + "' failed in '" + kernel +
         "' at element " + element + " (SK_CHECK=asserts)";
}

sk::Stream<float> streamOf(sk::Device& device, std::vector<float> values) {
  auto x = device.stream<float>({static_cast<std::int64_t>(values.size())});
  x.write(values);
  return x;
}

TEST_CASE("the first assertion that fails, in the first element, is named, and nothing is written") {
  onSomeLayouts([](sk::Device& device) {
    std::vector<float> values(200, 1);
    auto x = streamOf(device, values), r = streamOf(device, values);
    roots(x, r);
    values[150] = -1;
    values[77] = -4;
    x.write(values);
    r.fill(5);
    CHECK(errorOf([&] { roots(x, r); }) == failure(12, "x >= 0", "roots", "[77]"));
    CHECK(r.read() == std::vector<float>(200, 5));
    try {
      roots(x, r);
      FAIL("it did not throw");
    } catch (const sk::Error& error) {
      CHECK(error.kind() == sk::Error::Kind::Misuse);
    }
    CHECK(errorOf([&] { called(x, r); }) == failure(12, "x >= 0", "called", "[77]"));
    CHECK(errorOf([&] { roots(x, x); }) == failure(12, "x >= 0", "roots", "[77]"));
    CHECK(errorOf([&] { physics::step(x, r); }) == "no error");
  });
}

TEST_CASE("conditions keep the text and the order of the program") {
  onEveryTarget([](sk::Device& device) {
    auto r = device.stream<float>({4});
    const auto errorWith = [&](float value) {
      auto x = streamOf(device, {1, 2, value, 0});
      return errorOf([&] { both(x, r); });
    };
    CHECK(errorWith(50) == "no error");
    CHECK(errorWith(100) == failure(27, "x < LARGEST", "both", "[2]"));
    CHECK(errorWith(1.5f) == failure(17, "x != 3", "both", "[2]"));
    CHECK(errorWith(7) == failure(31, "r != 7", "both", "[2]"));
    CHECK(errorWith(std::nanf("")) == failure(27, "x < LARGEST", "both", "[2]"));
    auto e = device.stream<float>({0}), none = device.stream<float>({0});
    CHECK(errorOf([&] { both(e, none); }) == "no error");
  });
}

TEST_CASE("assertions read what kernels read") {
  onEveryTarget([](sk::Device& device) {
    auto u = device.stream<float>({5, 6}), v = device.stream<float>({5, 6});
    std::vector<float> values(30, 1);
    u.write(values);
    const auto run = [&](float least) {
      return errorOf([&] { diffuse(0.25f, least, u, sk::iter(sk::float2{0, 0}, sk::float2{6, 5}), v); });
    };
    const char* const condition = "v >= least && p.x >= 0";
    CHECK(run(0) == "no error");
    CHECK(v.read() == values);
    values[3 * 6 + 4] = -1;
    u.write(values);
    CHECK(run(0) == failure(45, condition, "diffuse", "[3][4]"));
    CHECK(run(0.75f) == failure(45, condition, "diffuse", "[3][3]"));
    // in a box, only its elements count, and the index is that of the whole domain
    const auto boxed = [&](sk::Index begin, sk::Index end) {
      return errorOf([&] {
        diffuse.with({.box = {begin, end}})(0.25f, 0.75f, u, sk::iter(sk::float2{0, 0}, sk::float2{6, 5}), v);
      });
    };
    CHECK(boxed({0, 0}, {3, 6}) == "no error");
    CHECK(boxed({2, 4}, {5, 6}) == failure(45, condition, "diffuse", "[3][4]"));
    // views, and elements of another shape
    CHECK(errorOf([&] {
            diffuse(0.25f, 0, u.domain({2, 2}, {5, 6}), sk::iter(sk::float2{0, 0}, sk::float2{4, 3}),
                    v.domain({2, 2}, {5, 6}));
          }) == failure(45, condition, "diffuse", "[1][2]"));
  });
}

TEST_CASE("loops, specialization constants, append outputs, templates and bundles assert") {
  onEveryTarget([](sk::Device& device) {
    auto n = device.stream<int>({3}), m = device.stream<int>({3});
    n.write(std::vector<int>{3, 4, 3});
    CHECK(errorOf([&] { looped(n, m); }) == "no error");
    n.write(std::vector<int>{3, 6, 7});
    CHECK(errorOf([&] { looped(n, m); }) == failure(51, "i < 5", "looped", "[1]"));
    n.write(std::vector<int>{3, 4, 2});
    CHECK(errorOf([&] { looped(n, m); }) == failure(12, "x >= 0", "looped", "[2]"));

    auto x = streamOf(device, {1, 2, 3}), r = streamOf(device, {0, 0, 0});
    auto limit = streamOf(device, {2.5f});
    CHECK(errorOf([&] { switched(false, x, sk::none, r); }) == "no error");
    CHECK(errorOf([&] { switched(true, x, limit, r); }) == failure(61, "x < limit[0]", "switched", "[2]"));

    auto points = device.stream<Point>({4});
    auto list = device.stream<float>({0});
    points.write(std::vector<Point>{{{0, 0}, 1}, {{0, 0}, 3}, {{1, 1}, 0}, {{0, 0}, 5}});
    CHECK(errorOf([&] { picked(points, 2, list); }) == "no error");
    CHECK(list.read() == std::vector<float>{3, 5});
    points.write(std::vector<Point>{{{0, 0}, 1}, {{0, 0}, 9}, {{1, 1}, -1}, {{0, 0}, 5}});
    CHECK(errorOf([&] { picked(points, 2, list); }) == failure(6, "weight >= 0", "picked", "[2]"));
    CHECK(list.read() == std::vector<float>{3, 5});

    auto bins = device.stream<int>({4}), histogram = device.stream<int>({3});
    histogram.fill(0);
    bins.write(std::vector<int>{0, 2, 2, 1});
    CHECK(errorOf([&] { counted(bins, histogram); }) == "no error");
    bins.write(std::vector<int>{0, 2, 3, -1});
    CHECK(errorOf([&] { counted(bins, histogram); }) ==
          failure(69, "bin >= 0 && bin < extentof(histogram).x", "counted", "[2]"));
    CHECK(histogram.read() == std::vector<int>{1, 1, 2});

    CHECK(errorOf([&] { positive(x, r); }) == "no error");
    m.write(std::vector<int>{1, 0, 2});
    CHECK(errorOf([&] { positive(m, n); }) == failure(86, "x > T(0)", "positive", "[1]"));

    auto height = device.stream<float>({2, 2}), grid = device.stream<float>({2, 2});
    height.fill(1);
    CHECK(errorOf([&] { heights({.height = height, .level = 1}, grid); }) ==
          failure(96, "all(p >= int2(0, 0))", "heights", "[0][0]"));
  });
}

TEST_CASE("reduces, scans and folded outputs assert about elements") {
  onEveryTarget([](sk::Device& device) {
    auto x = streamOf(device, {1, 2, 3, 4}), r = streamOf(device, {0, 0, 0, 0}),
         weight = streamOf(device, {1, 1, 0, 1});
    CHECK(sum(x) == 10);
    auto bad = streamOf(device, {1, 2, -3, -4}), halves = streamOf(device, {0, 0}),
         one = streamOf(device, {7});
    const std::string failed = failure(103, "x >= 0", "sum", "[2]");
    CHECK(errorOf([&] { static_cast<void>(sum(bad)); }) == failed);
    CHECK(errorOf([&] { sum(bad, halves); }) == failed);
    CHECK(halves.read() == std::vector<float>{0, 0});
    CHECK(errorOf([&] { static_cast<void>(sum.with({.accumulate = sk::Accumulate::Exact})(bad)); }) ==
          failed);
    CHECK(errorOf([&] { static_cast<void>(sum.with({.box = {{3}, {4}}})(bad)); }) ==
          failure(103, "x >= 0", "sum", "[3]"));
    CHECK(sum.with({.box = {{0}, {2}}})(bad) == 3);
    CHECK(errorOf([&] { static_cast<void>(sumAt(x, weight)); }) ==
          failure(108, "weight[indexof(x).x] != 0", "sumAt", "[2]"));
    auto starts = device.stream<int>({3});
    starts.write(std::vector<int>{0, 1, 2});
    sum(sk::Rows(starts)(bad), halves);  // no row has the others
    CHECK(halves.read() == std::vector<float>{1, 2});

    auto n = device.stream<int>({4}), s = device.stream<int>({4});
    n.write(std::vector<int>{1, 2, 3, 4});
    prefix(n, s);
    CHECK(s.read() == std::vector<int>{1, 3, 6, 10});
    n.write(std::vector<int>{1, 2, 3, -1});
    CHECK(errorOf([&] { prefix(n, s); }) == failure(113, "x != -1", "prefix", "[3]"));
    CHECK(errorOf([&] { prefix.with({.scan = sk::Scan::Exclusive, .along = 0})(n, s); }) ==
          failure(113, "x != -1", "prefix", "[3]"));

    squares(x, r, one);
    CHECK(one.read() == std::vector<float>{30});
    auto large = streamOf(device, {1, 12, 3, 4});
    CHECK(errorOf([&] { squares(large, large, one); }) == failure(118, "x < 10", "squares", "[1]"));
    CHECK(large.read()[1] == 12);
    CHECK(one.read() == std::vector<float>{30});
  });
}

TEST_CASE("a check has the precision of its call") {
  onEveryTarget([](sk::Device& device) {
    auto x = streamOf(device, {1, 2, 3000.5f}), r = streamOf(device, {0, 0, 0});
    CHECK(errorOf([&] { both.with({.precision = sk::Precision::Extended})(x, r); }) ==
          failure(27, "x < LARGEST", "both", "[2]"));
    CHECK(errorOf([&] { both.with({.precision = sk::Precision::Half})(x, r); }) ==
          failure(27, "x < LARGEST", "both", "[2]"));
    auto d = device.stream<double>({3}), result = device.stream<double>({3});
    auto h = device.stream<sk::half>({3});
    h.fill(sk::half(1.0f));
    d.write(std::vector<double>{1, 2, 3});
    CHECK(errorOf([&] { inSteps(x, d, h, result); }) == "no error");
    d.write(std::vector<double>{1, 2e10, 3});
    CHECK(errorOf([&] { inSteps(x, d, h, result); }) == failure(80, "d < 1e10", "inSteps", "[1]"));
  });
}

TEST_CASE("a loop stops at the call whose assertion fails") {
  onEveryTarget([](sk::Device& device) {
    auto u = streamOf(device, {1, 2, 3}), v = streamOf(device, {0, 0, 0});
    auto total = device.scalar<float>();
    sk::Loop loop = device.record([&] {
      squares(u, v, total);
      positive(v, u);
    });
    loop.repeat(2);
    CHECK(u.read() == std::vector<float>{1, 16, 81});
    CHECK(errorOf([&] { loop.repeat(40); }) == failure(118, "x < 10", "squares", "[1]"));
    CHECK(u.read() == std::vector<float>{1, 16, 81});
    u.write(std::vector<float>{1, 1, 1});
    CHECK(errorOf([&] { loop.repeat(40); }) == "no error");
    u.write(std::vector<float>{1, 1, 0});
    CHECK(errorOf([&] { loop.repeat(1); }) == failure(86, "x > T(0)", "positive", "[2]"));
    CHECK(v.read() == std::vector<float>{1, 1, 0});
    auto done = device.scalar<bool>();
    done = false;
    sk::Loop until = device.record([&] {
      roots(u, v);
      done = total > 100.0f;
    });
    CHECK(until.until(done, {.every = 4, .most = 30}) == 30);
    u.write(std::vector<float>{1, -1, 0});
    CHECK(errorOf([&] { until.until(done, {.every = 4, .most = 30}); }) ==
          failure(12, "x >= 0", "roots", "[1]"));
  });
}

TEST_CASE("placed streams give the index in the whole") {
  onEveryTarget([](sk::Device& device) {
    auto u = device.stream<float>({4, 6}), v = device.stream<float>({3, 6});
    std::vector<float> values(24, 1);
    values[2 * 6 + 2] = -9;
    u.write(values);
    const sk::Shape whole{10, 6};
    CHECK(errorOf([&] {
            diffuse.with({.box = {{5, 0}, {8, 6}}})(0.0f, 0.0f, sk::placed(u, {{4, 0}, whole}),
                                                    sk::iter(sk::float2{0, 0}, sk::float2{6, 10}),
                                                    sk::placed(v, {{5, 0}, whole}));
          }) == failure(45, "v >= least && p.x >= 0", "diffuse", "[6][2]"));
  });
}

TEST_CASE("without SK_CHECK nothing is evaluated", "[.off]") {
  onEveryTarget([](sk::Device& device) {
    auto x = streamOf(device, {1, -2, 3}), r = streamOf(device, {0, 0, 0});
    CHECK(errorOf([&] { both(x, r); }) == "no error");
    CHECK(r.read() == std::vector<float>{1, -2, 3});
    CHECK(sum(x) == 2);
  });
}

}  // namespace
}  // namespace run_tests
