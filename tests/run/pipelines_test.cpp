// SPDX-License-Identifier: MIT
//
// Promises: a pipeline computes the bits that its calls compute one by one, on every target, in loops, and with every kind of parameter;
// what it cannot do is an error that names the streams. The drawn pipelines have any calls in any order.
#include "drawn_pipelines.hpp"
#include "error_of.hpp"
#include "pipelines.sk.hpp"
#include "support/devices.hpp"
#include "support/same_bits.hpp"
#include "support/values.hpp"

using namespace run_tests;
using Catch::Matchers::Contains;

namespace {

using Field = sk::Stream<float>;

std::vector<float> values(std::int64_t count, std::uint32_t seed = 0) {
  std::vector<float> list;
  for (std::int64_t i = 0; i < count; ++i)
    list.push_back(0.37f * valueAt<float>(static_cast<std::uint32_t>(i) + 1000 * seed));
  return list;
}

Field filled(sk::Device& device, const sk::Shape& shape, std::uint32_t seed = 0) {
  Field field = device.stream<float>(shape);
  field.write(values(shape.size(), seed));
  return field;
}

}  // namespace

TEST_CASE("a chain of element-wise kernels is one kernel with the bits of its calls") {
  onSomeLayouts([](sk::Device& device) {
    const sk::Shape shape{7, 13};
    Field x = filled(device, shape), r = device.stream<float>(shape), expected = device.stream<float>(shape);
    Field a = device.stream<float>(shape), b = device.stream<float>(shape);
    device.countPasses(true);
    chain(0.3f, x, r);
    const auto passes = device.passCount();
    CHECK(passes.passes == 1);
    device.countPasses(false);
    lift(x, a);
    scale(0.15f, a, b);
    mixed(b, a, expected);
    CHECK(haveSameBits(r, expected));
    chain(0.3f, x, x);  // in place
    CHECK(haveSameBits(x, expected));
  });
}

TEST_CASE("values, streams that are written twice and folds") {
  onSomeLayouts([](sk::Device& device) {
    const sk::Shape shape{9, 17};
    const float k = 0.7f;
    Field x = filled(device, shape), r = device.stream<float>(shape), expected = device.stream<float>(shape);
    Field a = device.stream<float>(shape), b = device.stream<float>(shape);
    Field sums = device.stream<float>({2}), most = device.stream<float>({2});
    auto s = sums.domain({0}, {1}), s2 = sums.domain({1}, {2});
    auto m = most.domain({0}, {1}), m2 = most.domain({1}, {2});
    soften(k, x, r, s, m);
    const float half = 0.5f * k, quarter = 0.5f * half;
    blur(x, a);
    scale(quarter + half, a, a);
    edge(a, x, b);
    split(b, a, expected);
    mixed(a, expected, expected);
    total(expected, s2);
    largest(a, m2);
    CHECK(haveSameBits(r, expected));
    CHECK(sums.read()[1] ==
          Approx(sums.read()[0]).epsilon(1e-6));  // a part of a kernel adds in another order
    CHECK(most.read()[0] == most.read()[1]);
  });
}

TEST_CASE("folds of what a pipeline was given have a domain of their own") {
  onEveryTarget([](sk::Device& device) {
    const sk::Shape shape{6, 10};
    Field weights = filled(device, {1, 10}, 3), x = filled(device, shape), r = device.stream<float>(shape);
    sk::Scalar<float> w = device.scalar<float>(), s = device.scalar<float>();
    folded(weights, x, r, w, s);
    CHECK(w.read() == total(weights));
    CHECK(s.read() == Approx(total(r)).epsilon(1e-6));
  });
}

TEST_CASE("scans, scatters and variable outputs are passes of their own") {
  onEveryTarget([](sk::Device& device) {
    Field x = filled(device, {61}), r = device.stream<float>({61}), expected = device.stream<float>({61});
    Field a = device.stream<float>({61});
    scanned(x, r);
    lift(x, a);
    running(a, expected);
    scale(0.5f, expected, expected);
    CHECK(haveSameBits(r, expected));
    Field large = device.stream<float>({0}), marks = device.stream<float>({200}),
          large2 = device.stream<float>({0});
    Field marks2 = device.stream<float>({200});
    marks.fill(-1);
    marks2.fill(-1);
    appended(x, large, marks);
    positive(a, large2);
    mark(a, marks2);
    CHECK(large.size() > 0);
    CHECK(haveSameBits(large, large2));
    CHECK(haveSameBits(marks, marks2));
  });
}

TEST_CASE("records, halves, bundles, spec parameters, iterators and templates") {
  onEveryTarget([](sk::Device& device) {
    const sk::Shape shape{5, 8};
    Field x = filled(device, shape), r = device.stream<float>(shape), expected = device.stream<float>(shape);
    Field a = device.stream<float>(shape), b = device.stream<float>(shape);
    sk::Stream<Cell> before = device.stream<Cell>(shape), after = device.stream<Cell>(shape);
    sk::Stream<Cell> c = device.stream<Cell>(shape), after2 = device.stream<Cell>(shape);
    before.fill({0.25f, 3});
    records(x, before, after, r);
    lift(x, a);
    warmed(a, before, c);
    warmed(x, c, after2);
    heatOf(after2, expected);
    CHECK(haveSameBits(r, expected));
    CHECK(after.read()[7].steps == 5);
    CHECK(after.read()[7].heat == after2.read()[7].heat);

    auto h = device.stream<sk::half>(shape), h2 = device.stream<sk::half>(shape);
    halves(x, r);
    toHalf(x, h);
    coarse(h, h2);
    coarse(h2, h2);
    fromHalf(h2, expected);
    CHECK(haveSameBits(r, expected));

    const sk::Iter<float> t = sk::iter(0.0f, 4.0f, {5, 8});
    for (const bool isSmooth : {false, true}) {
      const Medium m{.wall = x, .loss = 0.75f};
      inMedium(m, isSmooth, x, t, r);
      walled(m, x, a);
      chosen(isSmooth, a, x, b);
      stepped(b, t, expected);
      CHECK(haveSameBits(r, expected));
    }
    doubled(x, r);
    twice(x, a);
    fused(a, expected);
    CHECK(haveSameBits(r, expected));
    fourfold(x, r);
    twice(a, expected);
    CHECK(haveSameBits(r, expected));
    auto i = device.stream<int>({3}), j = device.stream<int>({3});
    i.write(std::vector<int>{1, 2, 3});
    fourfold(i, j);
    CHECK(j.read() == std::vector<int>{4, 8, 12});
  });
}

TEST_CASE("a pipeline without outputs has the shape of its inputs") {
  onEveryTarget([](sk::Device& device) {
    Field x = filled(device, {11, 6}), a = device.stream<float>({11, 6}), b = device.stream<float>({11, 6});
    sk::Scalar<float> s = device.scalar<float>();
    measured(x, s);
    blur(x, a);
    blur(a, b);
    CHECK(s.read() == Approx(total(b)).epsilon(1e-6));
  });
}

TEST_CASE("views, empty streams and namespaces") {
  onSomeLayouts([](sk::Device& device) {
    Field x = filled(device, {20, 20}), r = device.stream<float>({20, 20}),
          expected = device.stream<float>({20, 20});
    Field a = device.stream<float>({6, 5});
    r.fill(1);
    expected.fill(1);
    auto from = x.domain({3, 4}, {9, 9}), to = r.domain({1, 2}, {7, 7}),
         to2 = expected.domain({1, 2}, {7, 7});
    within::chain(from, to);
    blur(from, a);
    blur(a, to2);
    CHECK(haveSameBits(r, expected));
    Field nothing = device.stream<float>({0, 3}), empty = device.stream<float>({0, 3});
    within::chain(nothing, empty);
    CHECK(empty.read().empty());
  });
}

TEST_CASE("loops record pipelines, and tiles go through their kernels") {
  onEveryTarget([](sk::Device& device) {
    const sk::Shape shape{40, 50};
    Field x = filled(device, shape), y = filled(device, shape), r = device.stream<float>(shape);
    sk::Scalar<float> s = device.scalar<float>(), m = device.scalar<float>();
    sk::Loop loop = device.record([&] {
      soften(0.4f, x, r, s, m);
      within::chain(r, x);
    });
    loop.repeat(5);
    for (int i = 0; i < 5; ++i) {
      soften(0.4f, y, r, s, m);
      within::chain(r, y);
    }
    CHECK(haveSameBits(x, y));
  });
}

TEST_CASE("drawn pipelines have the bits of their calls") {
  onEveryTarget([](sk::Device& device) {
    const sk::Shape shape{9, 14};
    const auto made = [&] {
      return drawn::Fields{0.3f,
                           filled(device, shape, 1),
                           filled(device, shape, 2),
                           device.stream<float>(shape),
                           device.stream<float>(shape),
                           filled(device, {1}),
                           filled(device, {1})};
    };
    for (std::size_t i = 0; i < drawn::pairs.size(); ++i) {
      INFO("pipeline " << i);
      drawn::Fields as = made(), by = made();
      drawn::pairs[i].asPipeline(device, as);
      drawn::pairs[i].asCalls(device, by);
      CHECK(haveSameBits(as.r, by.r));
      CHECK(haveSameBits(as.s, by.s));
      CHECK(as.totalOf.read()[0] == Approx(by.totalOf.read()[0]).margin(1e-4));
      CHECK(haveSameBits(as.largestOf, by.largestOf));
    }
  });
}

// The test program sets SK_LOOP_TILES, so that streams of this size need tiles.
TEST_CASE("tiles of stencils have the bits of whole calls, and hold no local stream whole") {
  sk::Device& one = device("native");
  // The first two have tiles of rows, the next one also of columns, the others of elements.
  for (const sk::Shape& shape : {sk::Shape{1200, 64}, sk::Shape{300, 257}, sk::Shape{40, 3000},
                                 sk::Shape{70000, 1}, sk::Shape{1, 70000}}) {
    INFO(toString(shape));
    Field x = filled(one, shape, 1), w = filled(one, shape, 2), r = one.stream<float>(shape),
          s = one.stream<float>(shape);
    Field a = one.stream<float>(shape), b = one.stream<float>(shape), c = one.stream<float>(shape);
    Field d = one.stream<float>(shape), r2 = one.stream<float>(shape), s2 = one.stream<float>(shape);
    one.countPasses(true);
    blurred(x, r);
    CHECK(one.passCount().passes == 1);
    one.countPasses(false);
    across(x, a);
    down(a, r2);
    CHECK(haveSameBits(r, r2));
    one.countPasses(true);
    deep(x, w, r, s);
    if (shape[0] != 40 && shape[0] != 300)
      CHECK(one.passCount().passes == 1);  // else they would compute too much twice
    one.countPasses(false);
    down(x, a);
    across(a, b);
    far(b, w, a, c, d);
    down(c, b);
    mixed(b, d, r2);
    down(d, s2);
    CHECK(haveSameBits(r, r2));
    CHECK(haveSameBits(s, s2));
    around(x, r);  // periodic: call by call
    blur(x, a);
    blur(a, r2);
    CHECK(haveSameBits(r, r2));
    x.copyTo(r2);
    blurred(x, x);  // in place
    across(r2, a);
    down(a, r2);
    CHECK(haveSameBits(x, r2));
  }
}

TEST_CASE("mistakes in calls of pipelines name the pipeline and its parameters") {
  sk::Device& one = device("native");
  Field x = filled(one, {4, 4}), r = one.stream<float>({4, 4}), wide = one.stream<float>({4, 5});
  sk::Scalar<float> s = one.scalar<float>(), m = one.scalar<float>();
  CHECK_THAT(errorOf([&] { soften(0.1f, wide, r, s, m); }), Contains("'x'") && Contains("{4, 5}"));
  CHECK_THAT(errorOf([&] { within::chain.with({.box = {{0, 0}, {1, 1}}})(x, r); }),
             Contains("within::chain: a pipeline computes its whole domain, not a box"));
  auto after = one.stream<Cell>({4, 4}), before = one.stream<Cell>({4, 4});
  CHECK_THAT(errorOf([&] { records(x, before, after, wide); }), Contains("records") && Contains("{4, 5}"));
  CHECK_THAT(errorOf([&] { soften(0.1f, x, r, r, m); }), Contains("soften"));
  CHECK_THAT(errorOf([&] { folded(x, r, r, s, x.domain({0, 0}, {1, 1})); }), !Contains("none"));
}

TEST_CASE("assertions of kernels are checked in pipelines, too") {
  sk::Device& one = device("native");
  Field x = filled(one, {4, 4}), r = one.stream<float>({4, 4});
  checked(x, r);
  CHECK(r.read()[3] == 0.5f * x.read()[3] + 0.25f + 1);
}
