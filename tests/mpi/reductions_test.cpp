// SPDX-License-Identifier: MIT
//
// Promises: reductions over ranks have the bits of one device where these do not depend on the order (exact sums, integers,
// extrema), keep the order of the elements where it matters, and are otherwise as accurate as on one device; every rank gets
// the result.
#include <cmath>
#include <numeric>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "reductions.sk.hpp"
#include "sk/sk.hpp"
#include "split_grids.hpp"

namespace {

const sk::Shape shape{12, 14};

/// Numbers of very different sizes that cancel.
float wild(const sk::Index& i) {
  const std::int64_t number = i[0] * 14 + i[1];
  const std::int64_t pair = number / 2;
  const float magnitude =
      std::ldexp(1.0F + static_cast<float>(pair % 7) / 8, static_cast<int>(pair % 61) - 30);
  return (number % 2 == 0 ? magnitude : -magnitude) + static_cast<float>(number % 5) / 16;
}

TEST_CASE("exact sums have the same bits for any number of ranks") {
  const sk::CallOptions exact{.accumulate = sk::Accumulate::Exact};
  sk::Device device("native");
  auto x = device.stream<float>(shape);
  x.write(valuesOf<float>(shape, wild));
  const float total = sum.with(exact)(x), squares = dot.with(exact)(x, x);
  const auto [one, two] = both.with(exact)(x);
  const Moments all = moments.with(exact)(x);
  forEachSplit({.shape = shape}, [&](sk::Domain& domain) {
    auto u = domain.stream<float>();
    u.fill(wild);
    CHECK(isSame(sum.with(exact)(u), total));
    CHECK(isSame(dot.with(exact)(u, u), squares));
    const auto [first, second] = both.with(exact)(u);
    CHECK(isSame(first, one));
    CHECK(isSame(second, two));
    const Moments got = moments.with(exact)(u);
    CHECK(isSame(got.sum, all.sum));
    CHECK(got.most == all.most);
    CHECK(got.n == all.n);
    const sk::CallOptions boxed{.accumulate = sk::Accumulate::Exact, .box = {{2, 3}, {5, 9}}};
    CHECK(isSame(sum.with(boxed)(u), sum.with(boxed)(x)));
  });
}

TEST_CASE("exact sums of infinities, NaN and zeros are those of one device") {
  const sk::CallOptions exact{.accumulate = sk::Accumulate::Exact};
  forEachSplit({.shape = shape}, [&](sk::Domain& domain) {
    auto u = domain.stream<float>();
    u.fill([](const sk::Index& i) { return i[0] == 11 ? INFINITY : 1.0F; });
    CHECK(sum.with(exact)(u) == INFINITY);
    u.fill([](const sk::Index& i) { return i[0] == 11 ? INFINITY : i[0] == 0 ? -INFINITY : 1.0F; });
    CHECK(std::isnan(sum.with(exact)(u)));
    u.fill(-0.0F);
    sk::Device device("native");
    auto x = device.stream<float>(shape);
    x.fill(-0.0F);
    CHECK(isSame(sum.with(exact)(u), sum.with(exact)(x)));
  });
}

TEST_CASE("compensated and extended sums keep their bounds over ranks") {
  const std::vector<float> values = valuesOf<float>(shape, wild);
  long double total = 0, magnitudes = 0;
  for (const float value : values) {
    total += value;
    magnitudes += std::abs(value);
  }
  // u times the result, and a term of second order in u times the magnitudes (docs/accuracy.md)
  const double u = std::ldexp(1.0, -24), squared = 64 * u * u * static_cast<double>(magnitudes);
  const double bound = u * std::abs(static_cast<double>(total)) + squared;
  forEachSplit({.shape = shape}, [&](sk::Domain& domain) {
    auto x = domain.stream<float>();
    x.fill(wild);
    for (const sk::Accumulate kind :
         {sk::Accumulate::Default, sk::Accumulate::Compensated, sk::Accumulate::Extended}) {
      const float got = sum.with({.accumulate = kind})(x);
      CHECK(std::abs(static_cast<double>(got - total)) <= bound);
    }
    const Moments got = moments(x);
    CHECK(std::abs(static_cast<double>(got.sum - total)) <= bound);
    CHECK(got.n == shape.size());
    const float plain = sum.with({.accumulate = sk::Accumulate::Tree})(x);
    CHECK(std::abs(static_cast<double>(plain - total)) <= 200 * u * static_cast<double>(magnitudes));
  });
}

TEST_CASE("streams of doubles keep what is folded in doubles") {
  double total = 0;
  for (std::int64_t k = 0; k < shape.size(); ++k) total += static_cast<double>(k % 7) / 3;
  forEachSplit({.shape = shape}, [&](sk::Domain& domain) {
    auto x = domain.stream<float>(sk::Storage::Double), r = domain.stream<float>(sk::Storage::Double);
    auto thirds = domain.stream<float>();
    thirds.fill([](const sk::Index& i) { return static_cast<float>((i[0] * 14 + i[1]) % 7); });
    const sk::CallOptions inDoubles{.precision = sk::Precision::Extended};
    third.with(inDoubles)(thirds, x);
    auto folded = domain.device().stream<float>({1}, sk::Storage::Double);
    auto other = domain.device().stream<float>({1, 1}, sk::Storage::Double);
    sum.with(inDoubles)(x, folded);
    CHECK(std::abs(folded.readReals()[0] - total) <= std::ldexp(total, -40));
    both.with(inDoubles)(x, other, folded);
    CHECK(std::abs(other.readReals()[0] - total) <= std::ldexp(total, -40));
    twice.with(inDoubles)(x, r, folded);
    CHECK(std::abs(folded.readReals()[0] - total) <= std::ldexp(total, -40));
  });
}

TEST_CASE("integers, extrema and the first of equals are those of one device") {
  const auto hit = [](const sk::Index& i) {
    return Hit{static_cast<float>((i[0] * 5 + i[1] * 3) % 11), static_cast<int>(i[0] * 14 + i[1])};
  };
  sk::Device device("native");
  auto h = device.stream<Hit>(shape);
  h.write(valuesOf<Hit>(shape, hit));
  const Hit best = nearest(h);
  forEachSplit({.shape = shape}, [&](sk::Domain& domain) {
    auto x = domain.stream<float>();
    x.fill(wild);
    const std::vector<float> values = valuesOf<float>(shape, wild);
    CHECK(largest(x) == *std::ranges::max_element(values));
    CHECK(count(x, 0.5F) == std::ranges::count_if(values, [](float v) { return v > 0.5F; }));
    auto hits = domain.stream<Hit>();
    hits.fill(hit);
    CHECK(nearest(hits).id == best.id);
    CHECK(nearest(hits).t == best.t);
  });
}

TEST_CASE("the order of elements is that of the whole, however it is divided") {
  const auto number = [](const sk::Index& i) {
    return static_cast<std::uint32_t>(i[0] * 1000 + i[1] * 7 + 3);
  };
  std::uint32_t expected = 0;
  for (const std::uint32_t value : valuesOf<std::uint32_t>(shape, number)) expected = expected * 31 + value;
  forEachSplit({.shape = shape}, [&](sk::Domain& domain) {
    auto x = domain.stream<std::uint32_t>();
    x.fill(number);
    CHECK(hash(x).value == expected);
    std::uint32_t inBox = 0;
    for (std::int64_t row = 1; row < 4; ++row) {
      for (std::int64_t column = 2; column < 13; ++column) inBox = inBox * 31 + number({row, column});
    }
    CHECK(hash.with({.box = {{1, 2}, {4, 13}}})(x).value == inBox);
  });
}

TEST_CASE("folded outputs, streams of one element and messages") {
  forEachSplit({.shape = shape}, [&](sk::Domain& domain) {
    auto x = domain.stream<float>(), r = domain.stream<float>();
    const auto small = [](const sk::Index& i) { return static_cast<float>(i[0] + i[1]); };
    x.fill(small);
    const std::vector<float> values = valuesOf<float>(shape, small);
    const float total = std::accumulate(values.begin(), values.end(), 0.0F);
    auto folded = domain.device().stream<float>({1});
    twice(x, r, folded);
    CHECK(folded.read().front() == total);
    CHECK(sum(r) == 2 * total);
    twice(x, x, folded);
    CHECK(folded.read().front() == total);
    CHECK(sum(x) == 2 * total);
    sum(x, folded);
    CHECK(folded.read().front() == 2 * total);
    if (domain.ranks() == 1) return;
    domain.resetStatistics();
    (void)both(x);
    CHECK(domain.statistics() == sk::DomainStatistics{.reductions = 1});
    (void)both.with({.accumulate = sk::Accumulate::Exact})(x);
    CHECK(domain.statistics().reductions == 2);
  });
}

TEST_CASE("a reduction of one value takes two messages, of one length for all reductions") {
  if (ranksOfWorld() == 1) return;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = shape});
  auto x = domain.stream<float>();
  x.fill(1.0F);
  const auto sentBy = [](auto&& call) {
    const Reduced before = reducedSoFar();
    call();
    const Reduced after = reducedSoFar();
    return Reduced{after.messages - before.messages, after.bytes - before.bytes};
  };
  const auto exactly = sum.with({.accumulate = sk::Accumulate::Exact});
  (void)sum(x);
  const Reduced sent = sentBy([&] { (void)sum(x); });
  CHECK(sent.messages == 2);
  CHECK(sentBy([&] { (void)largest(x); }) == sent);
  CHECK(sentBy([&] { (void)exactly(x); }) == sent);
  CHECK(sentBy([&] { (void)both(x); }) == sent);
}

TEST_CASE("a reduction that is asked later gives the value of its call") {
  const sk::CallOptions exact{.accumulate = sk::Accumulate::Exact};
  forEachSplit({.shape = shape}, [&](sk::Domain& domain) {
    auto x = domain.stream<float>(), y = domain.stream<float>();
    x.fill(wild);
    y.fill(2.0F);
    const float total = sum.with(exact)(x), plain = sum(x);
    sk::Future<float> one = domain.later(sum.with(exact), x), two = domain.later(sum, x),
                      other = domain.later(sum, y);
    sk::Future<float> dropped = domain.later(largest, x);
    x.fill(0.0F);
    CHECK(other.get().front() == 2 * 12 * 14);
    CHECK(isSame(one.get().front(), total));
    CHECK(isSame(two.get().front(), plain));
    CHECK_THAT(errorOf([&] { (void)domain.later(both, x); }), Catch::Contains("one result"));
  });
}

TEST_CASE("reductions that ranks cannot share are refused") {
  using Catch::Contains;
  if (ranksOfWorld() == 1) return;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = shape});
  auto x = domain.stream<float>();
  x.fill(1.0F);
  auto rows = domain.device().stream<float>({12, 1});
  CHECK_THAT(errorOf([&] { sum(x, rows); }),
             Contains("'total' has shape {12, 1}") && Contains("one element"));
  CHECK_THAT(errorOf([&] { (void)largest.with({.accumulate = sk::Accumulate::Exact})(x); }),
             Contains("no sum of floats"));
  CHECK_THAT(errorOf([&] { (void)sum.with({.box = {{0, 0}, {13, 1}}})(x); }), Contains("not inside"));
}

}  // namespace
