// SPDX-License-Identifier: MIT
//
// Promises: a loop takes all of its iterations, or reading what the call has written throws an error that names the kernel, and
// the stream is lost until it is written again. Up to 65,000 iterations for each element, and for those computed with it, all
// devices run.
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "long_loops.sk.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "support/streams.hpp"

namespace run_tests {
namespace {

using Catch::Matchers::Contains;
using Values = std::vector<std::uint32_t>;

std::uint32_t next(std::uint32_t h, int i) { return h * 1664525U + static_cast<std::uint32_t>(i); }

std::uint32_t after(int n, std::uint32_t h, int factor = 1) {
  for (int i = 0; i < n; ++i) h = next(h, factor * i);
  return h;
}

Values starts(int count = 37) {
  Values x;
  for (int i = 0; i < count; ++i) x.push_back(static_cast<std::uint32_t>(i * 7 + 1));
  return x;
}

template <class Each>
Values mapped(const Values& x, Each&& each) {
  Values y;
  for (const std::uint32_t one : x) y.push_back(each(one));
  return y;
}

/// The three profiles, and native code.
template <class Test>
void onEveryProfile(const Test& test) {
  constexpr Layout all[] = {{"glsl330", 0}, {"essl300", 0}, {"glsl430", 0}};
  detail::onLayouts(all, test);
}

/// `work` returns what a call has written. Returns whether it was refused.
template <class Work, class Expected>
bool isRightOrRefused(const std::string& kernel, const Work& work, const Expected& expected) {
  try {
    const auto written = work();
    CHECK(written == expected);
    return false;
  } catch (const sk::Error& error) {
    CHECK_THAT(error.what(), Contains("long_loops::" + kernel + ":") && Contains("65,000 iterations"));
    CHECK(error.kind() == sk::Error::Kind::Device);
    return true;
  }
}

TEST_CASE("every device runs 65,000 iterations for an element") {
  onEveryProfile([](sk::Device& device) {
    auto x = streamOf(device, starts()), r = device.stream<std::uint32_t>({37}),
         s = device.stream<std::uint32_t>({37});
    long_loops::constant(x, r);
    CHECK(r.read() == mapped(starts(), [](std::uint32_t h) { return after(40000, h); }));
    auto four = streamOf(device, starts(40)), to = device.stream<std::uint32_t>({40});
    long_loops::packed(four, to);
    CHECK(to.read() == mapped(starts(40), [](std::uint32_t h) { return after(14990, h); }));
    long_loops::uniformBound(65000, x, r);
    CHECK(r.read() == mapped(starts(), [](std::uint32_t h) { return after(65000, h); }));
    long_loops::twoLoops(x, r, s);
    CHECK(r.read() == mapped(starts(), [](std::uint32_t h) { return after(20000, h); }));
    CHECK(s.read() == mapped(starts(), [](std::uint32_t h) { return after(20000, h, 2); }));
    long_loops::diverging(32000, x, r);
    CHECK(r.read()[0] == after(32000, 1, 3));
    CHECK(r.read()[1] == after(32000, 8));
  });
}

TEST_CASE("loops that take more iterations than a device runs are refused") {
  onEveryProfile([](sk::Device& device) {
    auto x = streamOf(device, starts()), r = device.stream<std::uint32_t>({37});
    const bool isCut = isRightOrRefused(
        "longer", [&] { return long_loops::longer(x, r), r.read(); },
        mapped(starts(), [](std::uint32_t h) { return after(100000, h); }));
    const auto check = [&](const std::string& kernel, const std::function<void()>& call, const auto& each) {
      INFO(kernel);
      CHECK(isRightOrRefused(kernel, [&] { return call(), r.read(); }, mapped(starts(), each)) == isCut);
    };
    const auto plain = [](std::uint32_t h) { return after(100000, h); };
    check("uniformBound", [&] { long_loops::uniformBound(100000, x, r); }, plain);
    check("left", [&] { long_loops::left(100000, x, r); }, plain);
    check(
        "inFunction", [&] { long_loops::inFunction(50000, x, r); },
        [](std::uint32_t h) { return after(50000, after(50000, h)); });
    check(
        "nested", [&] { long_loops::nested(300, x, r); },
        [](std::uint32_t h) {
          for (int i = 0; i < 300; ++i) {
            for (int j = 0; j < 300; ++j) h = next(h, i ^ j);
          }
          return h;
        });
    check(
        "diverging", [&] { long_loops::diverging(50000, x, r); },
        [](std::uint32_t h) { return after(50000, h, (h & 1U) == 0 ? 1 : 3); });
    std::vector<int> counts(37, 10);
    counts[20] = 70000;
    auto n = streamOf(device, counts);
    int at = 0;
    check(
        "varying", [&] { long_loops::varying(n, x, r); },
        [&](std::uint32_t h) { return after(counts[static_cast<std::size_t>(at++)], h); });
    at = 0;
    check(
        "atLeastOnce", [&] { long_loops::atLeastOnce(n, x, r); },
        [&](std::uint32_t h) {
          const int most = counts[static_cast<std::size_t>(at++)];
          for (int i = 0; i < most;) {
            h = next(h, i++);
            if (i % 3 != 0) h ^= 1U;
          }
          return h;
        });
  });
}

TEST_CASE("what was refused is lost until it is written again") {
  onEveryProfile([](sk::Device& device) {
    auto x = streamOf(device, starts()), r = device.stream<std::uint32_t>({37});
    long_loops::longer(x, r);
    if (errorOf([&] { r.read(); }) == "no error") return;
    CHECK_THAT(errorOf([&] { r.read(); }), Contains("lost"));
    CHECK(x.read() == starts());
    long_loops::uniformBound(3, x, r);
    CHECK(r.read() == mapped(starts(), [](std::uint32_t h) { return after(3, h); }));
  });
}

TEST_CASE("folds, scans, pushes and scatters with long loops are right or refused") {
  onEveryProfile([](sk::Device& device) {
    auto x = streamOf(device, starts(300)), r = device.stream<std::uint32_t>({300});
    auto count = device.stream<std::uint32_t>({0});
    const int n = 3000;
    const Values each = mapped(starts(300), [&](std::uint32_t h) { return after(n, h); });
    std::uint32_t sum = 0;
    const Values sums = mapped(each, [&](std::uint32_t h) { return sum += h; });
    isRightOrRefused("folded", [&] { return long_loops::folded(n, x); }, sum);
    isRightOrRefused(
        "folded",
        [&] {
          auto total = device.stream<std::uint32_t>({1});
          return long_loops::folded(n, x, total), total.read()[0];
        },
        sum);
    isRightOrRefused("scanned", [&] { return long_loops::scanned(n, x, r), r.read(); }, sums);
    auto folded = device.stream<std::uint32_t>({1});
    isRightOrRefused("beside", [&] { return long_loops::beside(n, x, r, folded), folded.read()[0]; }, sum);
    long_loops::beside(n, x, r, folded);
    isRightOrRefused("beside", [&] { return r.read(); }, each);
    const int far = 70000;
    auto few = streamOf(device, starts());
    const Values farther = mapped(starts(), [&](std::uint32_t h) { return after(far, h); });
    isRightOrRefused("pushed", [&] { return long_loops::pushed(far, few, count), count.read(); }, farther);
    auto to = streamOf(device, Values(37, 0));
    isRightOrRefused("scattered", [&] { return long_loops::scattered(far, few, to), to.read(); }, farther);
  });
}

TEST_CASE("rows with long loops are right or refused") {
  onEveryProfile([](sk::Device& device) {
    auto x = streamOf(device, starts(300)), r = device.stream<std::uint32_t>({2});
    sk::Rows rows(streamOf<int>(device, {0, 100, 300}));
    const Values each = mapped(starts(300), [&](std::uint32_t h) { return after(3000, h); });
    Values sums{0, 0};
    for (std::size_t i = 0; i < each.size(); ++i) sums[i < 100 ? 0 : 1] += each[i];
    isRightOrRefused("folded", [&] { return long_loops::folded(3000, rows(x), r), r.read(); }, sums);
  });
}

TEST_CASE("repeated calls with long loops are right or refused") {
  onEveryProfile([](sk::Device& device) {
    const auto check = [&](int times, const auto& run) {
      auto r = streamOf(device, starts());
      auto done = device.scalar<bool>();
      sk::Loop loop = device.record([&] {
        long_loops::uniformBound(70000, r, r);
        long_loops::isDone(r.domain({0}, {1}), done);
      });
      const Values expected = mapped(starts(), [&](std::uint32_t h) {
        for (int i = 0; i < times; ++i) h = after(70000, h);
        return h;
      });
      isRightOrRefused("uniformBound", [&] { return run(loop, done), r.read(); }, expected);
    };
    check(1, [](sk::Loop& loop, auto&) { loop.repeat(1); });
    check(9, [](sk::Loop& loop, auto&) { loop.repeat(9); });
    check(4, [](sk::Loop& loop, auto& done) { loop.until(done, {.every = 2, .most = 4}); });
  });
}

}  // namespace
}  // namespace run_tests
