// SPDX-License-Identifier: MIT
//
// Promises: folds over ranks may ask where an element is and read its neighbors. Exact sums, comparisons and folds of integers
// have the bits of one device, compensated sums its bound; a fold exchanges halos once, and only if they are not valid.
#include <cmath>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "folds.sk.hpp"
#include "sk/sk.hpp"
#include "split_grids.hpp"

namespace {

const sk::Shape shape{12, 14};

/// Numbers of very different sizes.
float wild(const sk::Index& i) {
  const std::int64_t number = i[0] * 14 + i[1];
  const float magnitude =
      std::ldexp(1.0F + static_cast<float>(number % 7) / 8, static_cast<int>(number % 41) - 20);
  return number % 3 == 0 ? -magnitude : magnitude;
}
float small(const sk::Index& i) { return static_cast<float>((i[0] * 5 + i[1] * 3) % 11); }

TEST_CASE("a product over ranks and its dot product are those of one device") {
  const sk::CallOptions exact{.accumulate = sk::Accumulate::Exact};
  sk::Device device("native");
  auto x = device.stream<float>(shape), r = device.stream<float>(shape);
  auto t = device.scalar<float>();
  x.write(valuesOf<float>(shape, wild));
  product.with(exact)(x, x, r, t);
  const float dot = t.read();
  const std::vector<float> results = r.read();
  product(x, x, r, t);
  const float compensated = t.read();
  double magnitudes = 0;
  for (std::size_t k = 0; k < results.size(); ++k)
    magnitudes +=
        std::abs(static_cast<double>(results[k]) * static_cast<double>(valuesOf<float>(shape, wild)[k]));
  // Both have the bound of one device: u times the result, and a term of second order (docs/accuracy.md).
  const double u = std::ldexp(1.0, -24),
               bound = 2 * u * std::abs(static_cast<double>(dot)) + 128 * u * u * magnitudes;
  CHECK(std::abs(static_cast<double>(compensated) - static_cast<double>(dot)) <= bound);
  forEachSplit({.shape = shape, .periodic = {true, true}}, [&](sk::Domain& domain) {
    auto v = domain.stream<float>(), w = domain.stream<float>();
    auto value = domain.device().scalar<float>();
    v.fill(wild);
    domain.resetStatistics();
    product.with(exact)(v, v, w, value);
    CHECK(isSame(value.read(), dot));
    CHECK(everywhere(w.gather()) == results);
    CHECK(domain.statistics().exchanges == (domain.ranks() == 1 ? 0 : 1));
    product(v, v, w, value);
    CHECK(domain.statistics().exchanges == (domain.ranks() == 1 ? 0 : 1));  // the halo is still valid
    CHECK(std::abs(static_cast<double>(value.read()) - static_cast<double>(dot)) <= bound);
    const sk::CallOptions boxed{.accumulate = sk::Accumulate::Exact, .box = {{2, 3}, {5, 9}}};
    const float part = slope.with(boxed)(v, v);
    CHECK(isSame(part, slope.with(boxed)(x, x)));
    CHECK(isSame(slope.with(exact)(v, v), slope.with(exact)(x, x)));
    auto later = domain.later(slope.with(exact), v, v);
    product(v, v, v, value);  // in place
    CHECK(everywhere(v.gather()) == results);
    CHECK(isSame(later.get().front(), slope.with(exact)(x, x)));
  });
}

TEST_CASE("indices, extents and ramps of folds are those of the whole") {
  sk::Device device("native");
  auto x = device.stream<float>(shape);
  x.write(valuesOf<float>(shape, small));
  const auto ramp = sk::iter(sk::float2{0, 0}, sk::float2{14, 12});
  const Least best = least(x);
  const Polynomial inOrder = places(x);
  const float sum = moment(x, ramp);
  forEachSplit({.shape = shape, .periodic = {true, true}}, [&](sk::Domain& domain) {
    auto v = domain.stream<float>();
    v.fill(small);
    const Least got = least(v);
    CHECK((got.value == best.value && got.at.x == best.at.x && got.at.y == best.at.y));
    CHECK(places(v).value == inOrder.value);
    CHECK(moment(v, ramp) == sum);
    const sk::CallOptions boxed{.box = {{1, 2}, {4, 13}}};
    CHECK(places.with(boxed)(v).value == places.with(boxed)(x).value);
    CHECK(moment.with(boxed)(v, ramp) == moment.with(boxed)(x, ramp));
  });
}

TEST_CASE("a reduce without elements folds the domain of the ranks, which its call gives") {
  const sk::CallOptions exact{.accumulate = sk::Accumulate::Exact};
  sk::Device device("native");
  auto x = device.stream<float>(shape);
  x.write(valuesOf<float>(shape, small));
  const float whole = curl.over(shape).with(exact)(x);
  const sk::CallOptions boxed{.accumulate = sk::Accumulate::Exact, .box = {{2, 3}, {5, 9}}};
  const float part = curl.over(shape).with(boxed)(x);
  forEachSplit({.shape = shape, .periodic = {true, true}}, [&](sk::Domain& domain) {
    auto v = domain.stream<float>();
    v.fill(small);
    auto value = domain.device().scalar<float>();
    CHECK(isSame(curl.over(shape).with(exact)(v), whole));
    curl.over(domain.device(), shape).with(exact)(v, value);
    CHECK(isSame(value.read(), whole));
    CHECK(isSame(curl.over(shape).with(boxed)(v), part));
    CHECK_THAT(errorOf([&] { curl.over({3, 3})(v); }), Catch::Contains("its domain has the shape {3, 3}"));
    CHECK_THAT(errorOf([&] { curl(v); }), Catch::Contains("curl.over({...})(...)"));
  });
}

TEST_CASE("a fold whose halo is thicker than a part is refused") {
  if (ranksOfWorld() == 1) return;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {ranksOfWorld(), 5}, .split = {ranksOfWorld(), 1}});
  auto x = domain.stream<float>();
  x.fill(1.0F);
  CHECK_THAT(errorOf([&] { (void)slope(x, x); }),
             Catch::Contains("'u' needs a halo of 2 element(s) along y"));
}

}  // namespace
