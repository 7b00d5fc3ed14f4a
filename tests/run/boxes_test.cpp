// SPDX-License-Identifier: MIT
//
// Promises: a call with a box computes the elements of the box as a call without one does, with the indices, extents and
// borders of the whole streams, and keeps the bits of all others; a fold with a box folds its elements alone; a box that
// is none of the domain is refused.
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "boxes.sk.hpp"
#include "error_of.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

constexpr float untouched = -12345;

struct Case {
  sk::Shape shape;
  sk::Box box;
};

/// Boxes of whole texels of packed elements and of parts of them, of one element, of whole rows, and of everything.
const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {{37}, {{5}, {29}}},
      {{64}, {{8}, {32}}},
      {{1200}, {{3}, {1101}}},
      {{7, 9}, {{2, 3}, {6, 7}}},
      {{5, 16}, {{1, 4}, {4, 12}}},
      {{5, 16}, {{4, 15}, {5, 16}}},
      {{6, 90}, {{2, 0}, {5, 90}}},
      {{6, 90}, {{0, 0}, {6, 90}}},
      {{4, 5, 6}, {{1, 2, 1}, {3, 5, 6}}},
      {{3, 4, 5, 4}, {{0, 1, 2, 1}, {3, 3, 4, 3}}},
  };
  return all;
}

sk::Index indexAt(const sk::Shape& shape, std::int64_t number) {
  sk::Index index = sk::Index::origin(shape.rank());
  for (int d = shape.rank() - 1; d >= 0; --d) {
    index[d] = number % shape[d];
    number /= shape[d];
  }
  return index;
}

bool isInside(const sk::Box& box, const sk::Index& index) {
  for (int d = 0; d < index.rank(); ++d) {
    if (index[d] < box.begin[d] || index[d] >= box.end[d]) return false;
  }
  return true;
}

/// `computed` in the box, and what was there before outside.
template <class T>
std::vector<T> inBox(const Case& one, const std::vector<T>& computed, const std::vector<T>& before) {
  std::vector<T> expected = before;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (isInside(one.box, indexAt(one.shape, static_cast<std::int64_t>(i)))) expected[i] = computed[i];
  }
  return expected;
}

std::vector<float> numbers(const sk::Shape& shape) {
  std::vector<float> values(static_cast<std::size_t>(shape.size()));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>((i * 37 + 11) % 101);
  return values;
}

TEST_CASE("a kernel over a box sees the whole domain, and leaves all other elements as they are") {
  onEveryLayout([](sk::Device& device) {
    for (const Case& one : cases()) {
      INFO(sk::toString(one.shape) << ", box from " << sk::toString(one.box.begin));
      auto whole = device.stream<float>(one.shape), part = device.stream<float>(one.shape);
      part.fill(untouched);
      const std::vector<float> before = part.read();
      label(3.0F, whole);
      label.with({.box = one.box})(3.0F, part);
      CHECK(part.read() == inBox(one, whole.read(), before));
    }
  });
}

TEST_CASE("a kernel over a box reads beyond it, also from the stream that it writes") {
  onEveryLayout([](sk::Device& device) {
    for (const Case& one : cases()) {
      if (one.shape.rank() != 2) continue;
      INFO(sk::toString(one.shape) << ", box from " << sk::toString(one.box.begin));
      auto u = device.stream<float>(one.shape), whole = device.stream<float>(one.shape);
      const std::vector<float> before = numbers(one.shape);
      u.write(before);
      around(u, whole);
      around.with({.box = one.box})(u, u);
      CHECK(u.read() == inBox(one, whole.read(), before));
    }
  });
}

TEST_CASE("several outputs, element inputs, iterators and views keep to the box") {
  onSomeLayouts([](sk::Device& device) {
    const Case one{{6, 20}, {{1, 4}, {5, 17}}};
    auto x = device.stream<float>(one.shape), r = device.stream<float>(one.shape);
    auto row = device.stream<float>({1, 20});
    auto s = device.stream<sk::int2>(one.shape), all = device.stream<sk::int2>(one.shape);
    auto frame = device.stream<float>({9, 31});
    x.write(numbers(one.shape));
    row.write(numbers({1, 20}));
    frame.fill(untouched);
    s.fill({-1, -1});
    auto inner = frame.domain({2, 3}, {8, 23});
    const auto ramp = sk::iter(0.0F, 120.0F);
    several(x, ramp, row, r, all);
    several.with({.box = one.box})(x, ramp, row, inner, s);
    CHECK(inner.read() == inBox(one, r.read(), std::vector<float>(120, untouched)));
    const std::vector<sk::int2> got = s.read(),
                                expected = inBox(one, all.read(), std::vector<sk::int2>(120, {-1, -1}));
    for (std::size_t i = 0; i < got.size(); ++i)
      CHECK((got[i].x == expected[i].x && got[i].y == expected[i].y));
    CHECK(frame.domain({0, 0}, {2, 31}).read() == std::vector<float>(62, untouched));
    CHECK(frame.domain({2, 23}, {8, 31}).read() == std::vector<float>(48, untouched));
  });
}

TEST_CASE("kernels in several passes keep to the box") {
  for (const int textureLimit : {0, 8}) {
    INFO("texture limit " << textureLimit);
    sk::Device device({.profile = "essl300", .textureLimit = textureLimit, .limits = "guaranteed"});
    const Case one{{11, 14}, {{2, 3}, {9, 13}}};
    auto u = device.stream<float>(one.shape);
    u.write(numbers(one.shape));
    std::vector<sk::Stream<float>> whole, part;
    for (int k = 0; k < 5; ++k) {
      whole.push_back(device.stream<float>(one.shape));
      part.push_back(device.stream<float>(one.shape));
      part.back().fill(untouched);
    }
    many(u, whole[0], whole[1], whole[2], whole[3], whole[4]);
    many.with({.box = one.box})(u, part[0], part[1], part[2], part[3], part[4]);
    for (std::size_t k = 0; k < 5; ++k)
      CHECK(part[k].read() == inBox(one, whole[k].read(), std::vector<float>(154, untouched)));
  }
}

TEST_CASE("other precisions keep to the box") {
  onEveryTarget([](sk::Device& device) {
    const Case one{{9, 10}, {{1, 2}, {8, 7}}};
    for (const sk::Precision precision : {sk::Precision::Half, sk::Precision::Extended}) {
      auto u = device.stream<float>(one.shape), whole = device.stream<float>(one.shape);
      const std::vector<float> before = numbers(one.shape);
      u.write(before);
      around.with({.precision = precision})(u, whole);
      around.with({.precision = precision, .box = one.box})(u, u);
      CHECK(u.read() == inBox(one, whole.read(), before));
    }
  });
}

TEST_CASE("recorded calls over boxes repeat") {
  onEveryTarget([](sk::Device& device) {
    const Case one{{40, 48}, {{4, 8}, {30, 40}}};
    auto u = device.stream<float>(one.shape), v = device.stream<float>(one.shape);
    u.write(numbers(one.shape));
    v.fill(untouched);
    const auto boxed = around.with({.box = one.box});
    sk::Loop loop = device.record([&] { boxed(u, v); });
    loop.repeat(3);
    auto whole = device.stream<float>(one.shape);
    around(u, whole);
    CHECK(v.read() == inBox(one, whole.read(), std::vector<float>(40 * 48, untouched)));
  });
}

TEST_CASE("a fold over a box folds its elements alone") {
  onSomeLayouts([](sk::Device& device) {
    for (const Case& one : cases()) {
      INFO(sk::toString(one.shape) << ", box from " << sk::toString(one.box.begin));
      auto x = device.stream<float>(one.shape);
      const std::vector<float> values = numbers(one.shape);
      x.write(values);
      float expected = 0;
      for (const float value : inBox(one, values, std::vector<float>(values.size()))) expected += value;
      CHECK(total.with({.box = one.box})(x) == expected);
    }
  });
  onEveryTarget([](sk::Device& device) {
    const Case one{{6, 20}, {{1, 4}, {5, 16}}};
    auto x = device.stream<float>(one.shape), r = device.stream<float>(one.shape),
         rows = device.stream<float>({4, 1});
    auto table = device.stream<float>({2});
    auto t = device.scalar<float>();
    const std::vector<float> values = numbers(one.shape);
    x.write(values);
    table.write(std::vector<float>{1, 5});
    r.fill(untouched);
    twice.with({.box = one.box})(x, table, r, t);
    std::vector<float> doubled;
    for (const float value : values) doubled.push_back(2 * value + 5);
    CHECK(r.read() == inBox(one, doubled, std::vector<float>(values.size(), untouched)));
    CHECK(t.read() == total(x.domain(one.box.begin, one.box.end)));
    const float first = weighed(x.domain(one.box.begin, one.box.end));  // counts from the view's first column
    CHECK(weighed.with({.box = one.box})(x) == first + 4 * total(x.domain(one.box.begin, one.box.end)));
    total.with({.box = one.box})(x, rows);
    for (int k = 0; k < 4; ++k) CHECK(rows.read()[k] == total(x.domain({1 + k, 4}, {2 + k, 16})));
  });
}

TEST_CASE("a box that is not in the domain is refused, and so are calls that have no parts") {
  sk::Device& device = run_tests::device("native");
  auto r = device.stream<float>({6, 8});
  auto line = device.stream<float>({48});
  using Catch::Matchers::Contains;
  const auto of = [&](const sk::Box& box) { return errorOf([&] { label.with({.box = box})(0.0F, r); }); };
  CHECK_THAT(of({{0, 0}, {6, 9}}),
             Contains("label: the box {0, 0} to {6, 9} is not inside the domain, which has shape {6, 8}"));
  CHECK_THAT(of({{-1, 0}, {6, 8}}), Contains("is not inside"));
  CHECK_THAT(of({{2, 3}, {2, 8}}), Contains("is empty in dimension 0"));
  CHECK_THAT(of({{2, 3}, {4, 1}}), Contains("is empty in dimension 1"));
  CHECK_THAT(of({{2}, {4}}), Contains("1 and 1 dimension(s), but the domain has shape {6, 8}"));
  CHECK_THAT(of({{2, 2}, {4}}), Contains("2 and 1 dimension(s)"));
  const sk::Box box{{1, 1}, {2, 2}}, part{{1}, {5}};
  CHECK_THAT(errorOf([&] { total.with({.box = {{0, 0}, {7, 8}}})(r); }), Contains("total: the box"));
  CHECK_THAT(errorOf([&] { prefix.with({.box = part})(line, line); }),
             Contains("prefix: a scan takes no box"));
  CHECK_THAT(errorOf([&] { keep.with({.box = part})(line, line); }),
             Contains("keep: it pushes or scatters to 'r'"));
  CHECK_THAT(errorOf([&] { deposit.with({.box = part})(line, line); }),
             Contains("deposit: it pushes or scatters"));
  CHECK_THAT(errorOf([&] { label.with({.box = box})(0.0F, sk::stride(r, {1, 2})); }),
             Contains("strided or reshaped view"));
}

}  // namespace
}  // namespace run_tests
