// SPDX-License-Identifier: MIT
//
// Promises: elements of all kinds are strided; views of views, in-place updates, loops, uniforms and sorts see the elements
// that they name; and what is no view is an error that says why.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "support/view_model.hpp"
#include "views.sk.hpp"

namespace run_tests {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("sums of floats in views are those of dense streams") {
  onSomeLayouts([](sk::Device& device) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> numbers(-1, 1);
    std::vector<float> values(33 * 35);
    for (float& value : values) value = numbers(random);
    auto stream = device.stream<float>({33, 35});
    stream.write(values);
    auto view = sk::stride(stream, {2, 3}, {1, 1});
    auto dense = device.stream<float>(view.shape());
    view.copyTo(dense);
    CHECK(views::total(view) == views::total(dense));
    if (device.name() == "native") {  // the only one that adds exactly without limbs
      const auto exact = views::total.with({.accumulate = sk::Accumulate::Exact});
      CHECK(exact(view) == exact(dense));
    }
    auto weights = device.stream<float>({40});
    weights.write(std::vector<float>(values.begin(), values.begin() + 40));
    auto everySecond = sk::stride(weights, {2}, {0});
    auto row = device.stream<float>({20});
    row.fill(1);
    double expected = 0;
    for (std::size_t i = 0; i < 40; i += 2) expected += values[i];
    CHECK(views::weighted(row, everySecond) == Approx(expected).margin(1e-5));
    // to every second element of a column
    auto sums = device.stream<float>({34, 3});
    sums.fill(-1);
    auto column = sk::stride(sums, {2, 3}, {0, 1});
    auto rows = stream.domain({0, 0}, {17, 35});
    views::total(rows, column);
    const std::vector<float> all = sums.read();
    for (std::size_t y = 0; y < 34; ++y) {
      for (std::size_t x = 0; x < 3; ++x) {
        if (y % 2 == 0 && x == 1) {
          double sum = 0;
          for (std::size_t k = 0; k < 35; ++k) sum += values[y / 2 * 35 + k];
          CHECK(all[y * 3 + x] == Approx(sum).margin(1e-5));
        } else {
          CHECK(all[y * 3 + x] == -1);
        }
      }
    }
  });
}

TEST_CASE("elements of all kinds are strided") {
  onSomeLayouts([](sk::Device& device) {
    const auto isOdd = [](std::size_t i) { return i % 9 % 2 == 1; };
    auto bodies = device.stream<views::Body>({3, 9});
    std::vector<views::Body> before;
    for (int i = 0; i < 27; ++i) before.push_back({{0.5f * static_cast<float>(i), -1}, i});
    bodies.write(before);
    auto some = sk::stride(bodies, {1, 2}, {0, 1});
    views::moved(some, some);
    const std::vector<views::Body> after = bodies.read();
    for (std::size_t i = 0; i < 27; ++i) {
      CHECK(after[i].at.x == (isOdd(i) ? 2 : 1) * before[i].at.x);
      CHECK(after[i].id == before[i].id + (isOdd(i) ? 1 : 0));
    }
    auto halves = device.stream<sk::half>({3, 9});
    halves.fill(sk::half(3));
    auto someHalves = sk::stride(halves, {1, 2}, {0, 1});
    views::halved(someHalves, someHalves);
    auto bools = device.stream<bool>({3, 9});
    bools.fill(true);
    auto someBools = sk::stride(bools, {1, 2}, {0, 1});
    views::negated(someBools, someBools);
    auto bytes = device.stream<std::uint8_t>({3, 9});
    bytes.fill(std::uint8_t(255));
    auto someBytes = sk::stride(bytes, {1, 2}, {0, 1});
    views::narrowed(someBytes, someBytes);
    for (std::size_t i = 0; i < 27; ++i) {
      CHECK(float(halves.read()[i]) == (isOdd(i) ? 1.5f : 3));
      CHECK(bools.read()[i] == (isOdd(i) ? 0 : 1));
      CHECK(int(bytes.read()[i]) == (isOdd(i) ? 0 : 255));
    }
  });
}

TEST_CASE("streams in other precisions are strided") {
  onEveryTarget([](sk::Device& device) {
    for (const sk::Storage storage : {sk::Storage::Half, sk::Storage::Double}) {
      auto wide = device.stream<float>({4, 6}, storage);
      wide.fill(0.1f);
      auto some = sk::stride(wide, {2, 2}, {0, 1});
      views::offset(1, some, some);
      const double kept = wide.readReals()[0];
      const std::vector<double> all = some.readReals();
      CHECK(all == std::vector<double>(6, all[0]));
      CHECK(all[0] == Approx(1.1).epsilon(1e-3));
      some.writeReals(std::vector<double>(6, 2));
      CHECK(wide.readReals() == std::vector<double>{kept, 2,    kept, 2,    kept, 2,    kept, kept,
                                                    kept, kept, kept, kept, kept, 2,    kept, 2,
                                                    kept, 2,    kept, kept, kept, kept, kept, kept});
    }
  });
}

TEST_CASE("views of views") {
  onSomeLayouts([](sk::Device& device) {
    std::mt19937 random(11);
    const auto below = [&](std::int64_t n) {
      return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(n));
    };
    for (int round = 0; round < 12; ++round) {
      const sk::Shape shape = round % 3 == 0   ? sk::Shape(below(400) + 1)
                              : round % 3 == 1 ? sk::Shape(below(30) + 1, below(40) + 1)
                                               : sk::Shape(below(6) + 1, below(7) + 1, below(9) + 1);
      auto stream = device.stream<int>(shape);
      stream.write(counted(shape.size()));
      sk::View<int> view = stream.reshape(shape);
      Model model(shape);
      std::string steps = sk::toString(shape);
      for (int step = 0; step < 4 && view.size() > 0; ++step) {
        const int rank = view.shape().rank();
        sk::Index begin = sk::Index::origin(rank), end = begin, by = begin;
        for (int d = 0; d < rank; ++d) {
          begin[d] = below(view.shape()[d] / 3 + 1);
          end[d] = view.shape()[d];
          by[d] = below(3) + 1;
        }
        if (step % 2 == 0) {
          view = sk::stride(view.domain(begin, end), by);
          model = model.strided(by, begin);
          steps += " by " + sk::toString(by) + " from " + sk::toString(begin);
        } else {
          const sk::Shape other = below(2) == 0 ? sk::Shape(view.size()) : sk::Shape(1, view.size(), 1);
          try {
            view = view.reshape(other);
          } catch (const sk::Error&) {
            continue;  // "reshape gives no view" tests when
          }
          model.shape = other;
          steps += " as " + sk::toString(other);
        }
      }
      INFO(steps);
      std::vector<int> all = counted(shape.size());
      REQUIRE(view.shape() == model.shape);
      CHECK(view.read() == model.of(all));
      views::plus(-1000, view, view);
      model.put(mapped(model.of(all), [](int x) { return x - 1000; }), all);
      CHECK(stream.read() == all);
    }
  });
}

TEST_CASE("what reads a stream sees it as it was before a strided part is written") {
  onSomeLayouts([](sk::Device& device) {
    auto u = device.stream<int>({6, 9});
    const std::vector<int> before = counted(54);
    u.write(before);
    auto odd = sk::stride(u, {1, 2}, {0, 1});
    auto even = sk::stride(u, {1, 2}, {0, 0}).domain({0, 0}, {6, 4});
    views::increment(100, odd, even, odd);  // both in one call
    std::vector<int> expected = before;
    for (std::size_t y = 0; y < 6; ++y) {
      for (std::size_t x = 1; x < 9; x += 2) {
        expected[9 * y + x - 1] = before[9 * y + x] + 100;
        expected[9 * y + x] = before[9 * y + x] - 100;
      }
    }
    CHECK(u.read() == expected);
    auto left = u.domain({0, 0}, {6, 4});
    views::around(left, odd);
    std::vector<int> inLeft;
    for (std::size_t i = 0; i < 54; ++i) {
      if (i % 9 < 4) inLeft.push_back(expected[i]);
    }
    for (std::size_t y = 0; y < 6; ++y) {
      for (std::size_t x = 0; x < 4; ++x) {
        expected[9 * y + 2 * x + 1] = 2 * at(inLeft, {6, 4}, std::int64_t(y), std::int64_t(x) + 1) +
                                      3 * at(inLeft, {6, 4}, std::int64_t(y) - 1, std::int64_t(x)) +
                                      at(inLeft, {6, 4}, 100, 0);
      }
    }
    CHECK(u.read() == expected);
  });
}

/// One iteration of red-black Gauss-Seidel on the inner elements.
void sweep(sk::Stream<float>& f, sk::Stream<float>& u) {
  const std::int64_t h = u.shape()[0], w = u.shape()[1];
  for (const std::int64_t colour : {0, 1}) {
    for (const std::int64_t row : {1, 2}) {
      const std::int64_t column = 1 + (row + colour) % 2;
      const sk::Index size{(h - row) / 2, (w - column) / 2};
      auto inner = sk::stride(u, {2, 2}, {row, column}).domain({0, 0}, size);
      auto source = sk::stride(f, {2, 2}, {row, column}).domain({0, 0}, size);
      views::relax({int(column), int(row)}, source, u, inner);
    }
  }
}

TEST_CASE("red-black relaxation is that of a loop in place") {
  onSomeLayouts([](sk::Device& device) {
    for (const auto& [h, w] : {std::pair<std::int64_t, std::int64_t>{9, 9}, {8, 12}, {70, 67}}) {
      std::vector<float> field(static_cast<std::size_t>(h * w)), source(field.size());
      for (std::size_t i = 0; i < field.size(); ++i) {
        field[i] = float(i % 17) - 5;
        source[i] = float(i % 7) / 8;
      }
      auto u = device.stream<float>({h, w}), f = device.stream<float>({h, w});
      u.write(field);
      f.write(source);
      for (int i = 0; i < 3; ++i) {
        sweep(f, u);
        for (const std::int64_t colour : {0, 1}) {
          for (std::int64_t y = 1; y < h - 1; ++y) {
            for (std::int64_t x = 1; x < w - 1; ++x) {
              if ((y + x + colour) % 2 != 1) continue;
              float* const p = &field[static_cast<std::size_t>(y * w + x)];
              *p = 0.25f * (p[-w] + p[w] + p[-1] + p[1] - source[static_cast<std::size_t>(y * w + x)]);
            }
          }
        }
      }
      CHECK(u.read() == field);
    }
  });
}

TEST_CASE("loops repeat calls with views") {
  onEveryTarget([](sk::Device& device) {
    auto u = device.stream<int>({5, 8}), v = device.stream<int>({5, 8});
    u.fill(1);
    v.fill(2);
    auto odd = sk::stride(u, {2, 2}, {0, 1});
    auto flat = u.reshape({40});
    sk::Loop loop = device.record([&] {
      views::plus(1, odd, odd);
      views::plus(2, flat, flat);
      odd.copyTo(sk::stride(v, {2, 2}, {0, 0}));
    });
    loop.repeat(20);  // often enough to be replayed
    std::vector<int> expected(40, 41), copied(40, 2);
    for (std::size_t i = 0; i < 40; ++i) {
      if (i / 8 % 2 != 0) continue;
      if (i % 2 == 1) {
        expected[i] = 61;
      } else {
        copied[i] = 61;
      }
    }
    CHECK(u.read() == expected);
    CHECK(v.read() == copied);
  });
}

TEST_CASE("views stand for uniforms, and are stretched") {
  onSomeLayouts([](sk::Device& device) {
    auto u = device.stream<int>({4, 6});
    u.write(counted(24));
    auto one = sk::stride(u, {4, 6}, {2, 3});
    auto result = device.stream<int>({2, 2});
    views::plus(one.reshape({1}), sk::stretch(sk::stride(u, {4, 6}, {1, 1})), result);
    CHECK(result.read() == std::vector<int>(4, 16 + 8));
    auto wide = device.stream<int>({4, 6});
    views::plus(0, sk::stretch(sk::stride(u, {2, 3})), wide);
    CHECK(wide.read() == std::vector<int>{1,  1,  1,  4,  4,  4,  1,  1,  1,  4,  4,  4,
                                          13, 13, 13, 16, 16, 16, 13, 13, 13, 16, 16, 16});
    views::plus(0, sk::stride(sk::stride(u, {1, 1}, {0, 2})), result);
    CHECK(result.read() == std::vector<int>{3, 5, 15, 17});
  });
}

TEST_CASE("kernels in several passes take views") {
  for (const char* profile : {"glsl330", "essl300"}) {
    sk::Device limited({.profile = profile, .limits = "guaranteed"});
    auto u = limited.stream<int>({6, 8}), v = limited.stream<int>({6, 8}), w = limited.stream<int>({3, 4});
    u.write(counted(48));
    v.fill(0);
    auto x = sk::stride(u, {2, 2}, {0, 1}), g = sk::stride(u, {2, 2}, {1, 0});
    auto r0 = sk::stride(v, {2, 2}, {0, 0}), r9 = sk::stride(v, {2, 2}, {1, 1});
    auto r1 = limited.stream<int>({3, 4}), r2 = limited.stream<int>({3, 4}), r3 = limited.stream<int>({3, 4});
    auto r4 = limited.stream<int>({3, 4}), r5 = limited.stream<int>({3, 4}), r6 = limited.stream<int>({3, 4});
    auto r7 = limited.stream<int>({3, 4}), r8 = limited.stream<int>({3, 4});
    views::many(x, g, r0, r1, r2, r3, r4, r5, r6, r7, r8, r9);
    std::vector<int> expected(48, 0);
    for (std::int64_t y = 0; y < 3; ++y) {
      for (std::int64_t c = 0; c < 4; ++c) {
        const int near = static_cast<int>(8 * (2 * y + 1) + 2 * std::min<std::int64_t>(c + 1, 3) + 1);
        const int own = static_cast<int>(16 * y + 2 * c + 2);
        expected[static_cast<std::size_t>(16 * y + 2 * c)] = near;
        expected[static_cast<std::size_t>(16 * y + 8 + 2 * c + 1)] = 9 * own + near;
      }
    }
    CHECK(v.read() == expected);
    views::wide(x, x, x, x, x, x, x, x, x, x, g, g, g, g, g, g, g, g, g, x, w);
    const std::vector<int> own = x.read(), near = g.read();
    std::vector<int> sums;
    for (std::size_t i = 0; i < 12; ++i) sums.push_back((55 + 20) * own[i] + (210 - 75) * near[i]);
    CHECK(w.read() == sums);
  }
}

TEST_CASE("views are sorted") {
  onSomeLayouts([](sk::Device& device) {
    auto u = device.stream<int>({4, 10});
    std::vector<int> all(40);
    for (std::size_t i = 0; i < 40; ++i) all[i] = static_cast<int>(i * 17 % 40);
    u.write(all);
    auto some = sk::stride(u, {2, 3}, {1, 0});
    sk::sort(some);
    const Model model = Model({4, 10}).strided({2, 3}, {1, 0});
    std::vector<int> sorted = model.of(all);
    std::ranges::sort(sorted);
    model.put(sorted, all);
    CHECK(u.read() == all);
    sk::sort(u.reshape({40}));
    std::ranges::sort(all);
    CHECK(u.read() == all);
  });
}

TEST_CASE("loops in kernels end, whatever lies between a view's elements") {
  onSomeLayouts([](sk::Device& device) {
    auto u = device.stream<float>({5, 7});
    u.fill(-1e9f);
    auto some = sk::stride(u, {2, 2}, {1, 1});
    some.fill(20);
    views::long_way(some, some);
    CHECK(some.read() == std::vector<float>(6, 110));
    CHECK(u.read()[0] == -1e9f);
  });
}

TEST_CASE("empty views") {
  onEveryTarget([](sk::Device& device) {
    auto u = device.stream<int>({3, 4}), none = device.stream<int>({0, 4});
    u.write(counted(12));
    auto empty = sk::stride(u, {2, 2}, {3, 0});
    CHECK(empty.shape() == sk::Shape(0, 2));
    CHECK(empty.read().empty());
    views::plus(1, empty, empty);
    empty.fill(7);
    CHECK(views::sum(empty) == 0);
    CHECK(none.reshape({7, 0, 2}).read().empty());
    CHECK(sk::stride(none, {3, 3}, {0, 1}).shape() == sk::Shape(0, 1));
    CHECK(u.read() == counted(12));
  });
}

TEST_CASE("reshape gives no view of other elements") {
  onEveryTarget([](sk::Device& device) {
    auto u = device.stream<int>({4, 6});
    CHECK_THAT(errorOf([&] { u.reshape({5, 5}); }),
               Contains("reshape: {4, 6} has 24 element(s), but shape {5, 5} has 25"));
    CHECK_THAT(errorOf([&] { u.domain({0, 0}, {4, 5}).reshape({20}); }),
               Contains("reshape: the elements of this view of shape {4, 5} do not lie at regular distances "
                        "in shape {20}; "
                        "copy them"));
    CHECK_THAT(errorOf([&] { sk::stride(u, {3, 2}, {0, 0}).reshape({3, 2}); }),
               Contains("regular distances"));
    CHECK_THAT(errorOf([&] { sk::Stream<int>().reshape({1}); }), Contains("reshape: there is no stream"));
    CHECK(sk::stride(u, {3, 2}, {0, 0}).reshape({1, 2, 1, 3}).shape() == sk::Shape(1, 2, 1, 3));
    CHECK(std::as_const(u).reshape({24}).size() == 24);
    static_assert(!sk::isWritable<decltype(std::as_const(u).reshape({24}))>);
    static_assert(!sk::isWritable<decltype(sk::stride(std::as_const(u), {1, 1}, {0, 0}))>);
  });
}

TEST_CASE("strides that do not go through a stream") {
  onEveryTarget([](sk::Device& device) {
    auto u = device.stream<int>({4, 6});
    for (const auto& [steps, offsets] : {std::pair<sk::Index, sk::Index>{{0, 1}, {0, 0}},
                                         {{1, -1}, {0, 0}},
                                         {{1, 1}, {-1, 0}},
                                         {{1, 1}, {0, 7}},
                                         {{1}, {0}},
                                         {{1, 1, 1}, {0, 0, 0}},
                                         {{2, 2}, {0}}}) {
      CHECK_THAT(errorOf([&] { sk::stride(u, steps, offsets); }), Contains("do not go through shape {4, 6}"));
    }
    auto one = sk::stride(u, {1, 2}, {0, 0}), apart = sk::stride(u, {1, 2}, {0, 1});
    auto x = device.stream<int>({4, 3});
    CHECK_THAT(errorOf([&] { views::increment(1, x, one, u.domain({0, 0}, {4, 3})); }), Contains("overlap"));
    views::increment(1, x, one, apart);
    auto pushed = device.stream<int>({9});
    pushed.write(counted(9));
    auto late = sk::stride(pushed, {4}, {0});
    auto six = device.stream<int>({6});
    six.write(counted(6));
    views::odd(six, pushed);
    CHECK_THAT(errorOf([&] { late.read(); }), Contains("a view of shape {3} is no longer inside its stream"));
  });
}

}  // namespace
}  // namespace run_tests
