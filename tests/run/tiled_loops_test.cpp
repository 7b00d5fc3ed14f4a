// SPDX-License-Identifier: MIT
//
// Promises: a loop that runs in tiles computes the bits that its calls compute one by one, whatever calls it has, in whatever
// order, with whatever boundaries, shapes and number of iterations; Loop::plan() says what runs in tiles, and why the rest does
// not. The test program sets SK_LOOP_TILES to a small cache, so that small streams need tiles.
#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"
#include "support/same_bits.hpp"
#include "support/streams.hpp"
#include "tiled_loops.sk.hpp"

namespace run_tests {
namespace {

using Catch::Matchers::Contains;
using Field = sk::Stream<float>;

/// Four fields that calls use by number, so that a swap exchanges what the numbers mean.
struct Fields {
  std::array<Field, 4> of;
  sk::Stream<float> sum;

  Fields(sk::Device& device, const sk::Shape& shape) : sum(device.stream<float>({1})) {
    for (unsigned i = 0; i < 4; ++i) {
      of[i] = device.stream<float>(shape);
      of[i].write(drawn(shape.size(), i));
    }
    sum.fill(0.9f);
  }
};

/// A call of one of the kernels with drawn fields.
struct Drawn {
  int kernel, a, b, c, d;
};

void run(const Drawn& call, Fields& f) {
  Field &a = f.of[static_cast<std::size_t>(call.a)], &b = f.of[static_cast<std::size_t>(call.b)];
  Field &c = f.of[static_cast<std::size_t>(call.c)], &d = f.of[static_cast<std::size_t>(call.d)];
  const std::int64_t rows = a.shape()[0], columns = a.shape()[1];
  switch (call.kernel) {
    case 0: return tiled::heat(0.2f, a, b);
    case 1: return tiled::around(a, b);
    case 2: return tiled::mirrored(a, b);
    case 3: return tiled::bordered(a, c, b);
    case 4: return tiled::react(a, b, c, d);
    case 5: return tiled::react(a, b, a, b);
    case 6: return tiled::damp(0.1f, a, a);
    case 7: return tiled::damp(0.1f, a, b);
    case 8: return tiled::place(a, b);
    case 9: return std::swap(a, b);
    case 10: return tiled::heat(0.1f, a, a);
    case 11: return tiled::heat.with({.box = {{1, 1}, {rows - 1, columns - 1}}})(0.2f, a, b);
    case 12:
      return tiled::damp(0.1f, a.domain({1, 0}, {rows - 1, columns}), b.domain({0, 0}, {rows - 2, columns}));
    case 13: return tiled::sweep(a, b);
    case 14: return tiled::total(a, f.sum);
    default: return tiled::scaled(f.sum, a, b);
  }
}

TEST_CASE("loops of any calls compute the bits of their calls one by one") {
  std::mt19937 engine(7);
  const auto draw = [&](int most) { return static_cast<int>(engine() % static_cast<unsigned>(most)); };
  sk::Device device("native");
  for (int trial = 0; trial < 300; ++trial) {
    const sk::Shape shape{3 + draw(70), 3 + draw(150)};
    std::vector<Drawn> calls;
    const int kinds = draw(3) == 0 ? 16 : 12;
    for (int i = 1 + draw(4); i > 0; --i) {
      Drawn call{draw(kinds), draw(4), 0, 0, 0};
      call.b = (call.a + 1 + draw(3)) % 4;
      do call.c = draw(4);
      while (call.c == call.a || call.c == call.b);
      call.d = 6 - call.a - call.b - call.c;
      calls.push_back(call);
    }
    const int times = 1 + draw(40), again = draw(3) == 0 ? draw(5) : 0;
    std::string named;
    for (const Drawn& call : calls) named += std::to_string(call.kernel) + " ";
    INFO("trial " << trial << ": kernels " << named << "over " << shape[0] << " x " << shape[1] << ", "
                  << times << " iterations");
    Fields one(device, shape), loop(device, shape);
    for (int i = 0; i < times + again; ++i) {
      for (const Drawn& call : calls) run(call, one);
    }
    sk::Loop recorded = device.record([&] {
      for (const Drawn& call : calls) run(call, loop);
    });
    INFO(recorded.plan());
    recorded.repeat(times);
    recorded.repeat(again);
    for (std::size_t i = 0; i < 4; ++i) REQUIRE(haveSameBits(loop.of[i].read(), one.of[i].read()));
    REQUIRE(haveSameBits(loop.sum.read(), one.sum.read()));
  }
}

template <class Step>
void checkAlternating(sk::Device& device, const sk::Shape& shape, int times, Step&& step) {
  INFO(shape.rank() << " dimensions, " << shape.size() << " elements, " << times << " iterations");
  auto u = device.stream<float>(shape), v = device.stream<float>(shape);
  auto a = device.stream<float>(shape), b = device.stream<float>(shape);
  for (auto* stream : {&u, &a}) stream->write(drawn(shape.size(), 3));
  for (int i = 0; i < times; ++i) {
    step(u, v);
    std::swap(u, v);
  }
  sk::Loop loop = device.record([&] {
    step(a, b);
    std::swap(a, b);
  });
  loop.repeat(times);
  REQUIRE(haveSameBits(a.read(), u.read()));
  if (times > 1) REQUIRE(haveSameBits(b.read(), v.read()));
}

TEST_CASE("lines and solids run in tiles") {
  sk::Device device("native");
  for (const int times : {1, 2, 3, 17, 50}) {
    checkAlternating(device, {40009}, times, [](auto& from, auto& to) { tiled::line(from, to); });
    checkAlternating(device, {37, 41, 53}, times, [](auto& from, auto& to) { tiled::solid(from, to); });
    checkAlternating(device, {1025, 63}, times, [](auto& from, auto& to) { tiled::around(from, to); });
    checkAlternating(device, {40, 5000}, times, [](auto& from, auto& to) { tiled::heat(0.2f, from, to); });
  }
}

TEST_CASE("streams that calls outside of a loop have written are seen") {
  sk::Device device("native");
  const sk::Shape shape{200, 100};
  auto u = device.stream<float>(shape), v = device.stream<float>(shape);
  auto a = device.stream<float>(shape), b = device.stream<float>(shape);
  for (auto* stream : {&u, &a}) stream->write(drawn(shape.size(), 3));
  for (auto* stream : {&v, &b}) stream->write(drawn(shape.size(), 4));
  sk::Loop loop = device.record([&] {
    tiled::heat(0.2f, a, b);
    std::swap(a, b);
  });
  for (int i = 0; i < 30; ++i) {
    for (int k = 0; k < 5; ++k) {
      tiled::heat(0.2f, u, v);
      std::swap(u, v);
    }
    tiled::heat(0.1f, u, u);  // gives it other arrays
    loop.repeat(5);
    tiled::heat(0.1f, a, a);
    REQUIRE(haveSameBits(a.read(), u.read()));
  }
}

TEST_CASE(
    "streams that are written in tiles for the first time are swapped after the other calls of an "
    "iteration") {
  sk::Device device("native");
  const sk::Shape shape{300, 200};
  auto u = device.stream<float>(shape), v = device.stream<float>(shape), w = device.stream<float>(shape);
  auto a = device.stream<float>(shape), b = device.stream<float>(shape), c = device.stream<float>(shape);
  auto sum = device.stream<float>({1}), other = device.stream<float>({1});
  for (auto* stream : {&u, &a}) stream->write(drawn(shape.size(), 3));
  const auto step = [](auto& from, auto& between, auto& to, auto& total) {
    tiled::heat(0.2f, from, between);
    tiled::damp(0.1f, between, to);
    tiled::total(to, total);
    tiled::scaled(total, to, to);
    std::swap(from, to);
  };
  sk::Loop loop = device.record([&] { step(a, b, c, other); });
  for (int times = 1; times < 4; ++times) {
    step(u, v, w, sum);
    loop.repeat(1);
    REQUIRE(haveSameBits(a.read(), u.read()));
    REQUIRE(haveSameBits(b.read(), v.read()));
    REQUIRE(haveSameBits(c.read(), w.read()));
  }
}

TEST_CASE("a plan says what runs in tiles, and why the rest does not") {
  sk::Device device("native");
  const sk::Shape shape{300, 200};
  auto u = device.stream<float>(shape), v = device.stream<float>(shape);
  auto n = device.stream<int>({60000});
  auto sum = device.stream<float>({1});
  for (auto* stream : {&u, &v}) stream->fill(1);
  n.fill(1);
  const auto planOf = [&](auto&& calls) { return device.record(calls).plan(); };
  const auto step = [&] {
    tiled::heat(0.2f, u, v);
    std::swap(u, v);
  };
  CHECK_THAT(planOf(step), Contains("tiled::heat: in tiles of") && Contains("iterations at once"));
  CHECK_THAT(planOf([&] {
               step();
               tiled::total(u, sum);
             }),
             Contains("tiled::heat: in tiles of") && Contains("tiled::total: in the last iteration alone"));
  CHECK_THAT(planOf([&] {
               tiled::total(u, sum);
               tiled::scaled(sum, u, u);
             }),
             Contains("tiled::total: by itself"));
  CHECK_THAT(planOf([&] { tiled::hail(n, n); }),
             Contains("tiled::hail: by itself, since its elements take different times"));
  auto small = device.stream<float>({3, 3}), other = device.stream<float>({3, 3});
  small.fill(1);
  CHECK_THAT(planOf([&] {
               tiled::heat(0.2f, small, other);
               std::swap(small, other);
             }),
             Contains("tiled::heat: by itself, since"));
}

}  // namespace
}  // namespace run_tests
