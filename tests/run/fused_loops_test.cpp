// SPDX-License-Identifier: MIT
//
// Promises: calls of a loop on a GL device that run together in one pass leave the bits that they leave one by one, in every stream;
// Loop::plan() says which calls these are, what they save, and why the others run by themselves.
#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "fused_loops.sk.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "support/same_bits.hpp"

namespace run_tests {
namespace {

using Catch::Matchers::Contains;
using Field = sk::Stream<float>;

constexpr Layout glLayouts[] = {{"glsl330", 0}, {"glsl430", 0}, {"essl300", 0}, {"glsl330", smallLimits[1]}};

struct Fields {
  std::array<Field, 4> of;
  Field row, sum;
  sk::Stream<fused::Pair> pairs;
  sk::Stream<int> counts;

  Fields(sk::Device& device, const sk::Shape& shape)
      : row(device.stream<float>({1, shape[1]})),
        sum(device.stream<float>({1})),
        pairs(device.stream<fused::Pair>(shape)),
        counts(device.stream<int>(shape)) {
    for (unsigned i = 0; i < 4; ++i) {
      of[i] = device.stream<float>(shape);
      of[i].write(drawn(shape.size(), i));
    }
    row.write(drawn(shape[1], 9));
    sum.fill(0.75f);
    pairs.fill({0.5f, 3});
    std::vector<int> numbers(static_cast<std::size_t>(shape.size()));
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<int>(i * 7 % 1000) - 400;
    counts.write(numbers);
  }

  void check(const Fields& other) const {
    for (std::size_t i = 0; i < 4; ++i) {
      INFO("field " << i);
      REQUIRE(haveSameBits(of[i].read(), other.of[i].read()));
    }
    REQUIRE(haveSameBits(sum.read(), other.sum.read()));
    REQUIRE(haveSameBits(pairs.read(), other.pairs.read()));
    REQUIRE(counts.read() == other.counts.read());
  }
};

constexpr int kinds = 22;

void run(int kind, int x, int y, int z, Fields& f) {
  Field &a = f.of[static_cast<std::size_t>(x)], &b = f.of[static_cast<std::size_t>(y)];
  Field& c = f.of[static_cast<std::size_t>(z)];
  const std::int64_t rows = a.shape()[0], columns = a.shape()[1];
  switch (kind) {
    case 0: return fused::ease(a, b);
    case 1: return fused::ease(a, a);
    case 2: return fused::mix(0.3f, a, b, c);
    case 3: return fused::mix(0.7f, a, b, b);
    case 4: return fused::split(a, b, c);
    case 5: return fused::where(a, b);
    case 6: return fused::there(a, b);
    case 7: return fused::ramped(sk::iter(-1.0f, 1.0f), a, b);
    case 8: return fused::spread(a, b, c);
    case 9: return fused::spread(a, b, a);
    case 10: return fused::scaled(f.sum, a, b);
    case 11: return fused::scaled(0.9f, a, b);
    case 12: return fused::chosen(true, 0.25f, a, b);
    case 13: return fused::chosen(false, 0.5f, a, a);
    case 14: return fused::others::ease(a, b);
    case 15: return fused::remainder(f.counts, f.counts);
    case 16: return fused::halved(f.counts, f.counts);
    case 17: return fused::paired(a, f.pairs);
    case 18: return fused::unpaired(f.pairs, b);
    case 19: return std::swap(a, b);
    case 20: return fused::mix(0.4f, a, f.row, b);
    case 21: return fused::ease(a.domain({1, 0}, {rows, columns}), b.domain({0, 0}, {rows - 1, columns}));
    default: return fused::total(a, f.sum);
  }
}

struct Drawn {
  int kind, x, y, z;
};

TEST_CASE("calls in one pass leave the bits of their calls one by one") {
  for (const Layout& layout : glLayouts) {
    sk::Device& device = run_tests::device(layout.profile, layout.textureLimit);
    std::mt19937 engine(11);
    const auto draw = [&](int most) { return static_cast<int>(engine() % static_cast<unsigned>(most)); };
    const int trials = layout.textureLimit == 0 ? 40 : 12;
    for (int trial = 0; trial < trials; ++trial) {
      const sk::Shape shape = trial % 2 == 0 ? sk::Shape{9, 16} : sk::Shape{7, 11};
      std::vector<Drawn> calls;
      const int most = trial % 4 == 0 ? kinds + 1 : kinds - 1;
      for (int i = 2 + draw(6); i > 0; --i) {
        Drawn call{draw(most), draw(4), 0, 0};
        call.y = (call.x + 1 + draw(3)) % 4;
        do call.z = draw(4);
        while (call.z == call.x || call.z == call.y);
        calls.push_back(call);
      }
      std::string named;
      for (const Drawn& call : calls) {
        named += std::to_string(call.kind) + "(" + std::to_string(call.x) + std::to_string(call.y) +
                 std::to_string(call.z) + ") ";
      }
      INFO(layout.profile << " limit " << layout.textureLimit << ", trial " << trial << ": " << named);
      Fields one(device, shape), loop(device, shape);
      const int times = 1 + draw(8);
      for (int i = 0; i < times; ++i) {
        for (const Drawn& call : calls) run(call.kind, call.x, call.y, call.z, one);
      }
      sk::Loop recorded = device.record([&] {
        for (const Drawn& call : calls) run(call.kind, call.x, call.y, call.z, loop);
      });
      INFO(recorded.plan());
      recorded.repeat(times);
      loop.check(one);
    }
  }
}

TEST_CASE("a plan says which calls run in one pass, and why others do not") {
  for (const char* const profile : {"glsl330", "glsl430"}) {
    sk::Device& device = run_tests::device(profile);
    const sk::Shape shape{64, 64};
    auto u = device.stream<float>(shape), v = device.stream<float>(shape), w = device.stream<float>(shape);
    auto bytes = device.stream<sk::unorm8>(shape);
    for (auto* stream : {&u, &v, &w}) stream->fill(0.5f);
    bytes.fill(sk::unorm8(0.5f));
    const auto planOf = [&](auto&& calls) { return device.record(calls).plan(); };
    CHECK_THAT(
        planOf([&] {
          fused::ease(u, u);
          fused::others::ease(u, u);
          fused::where(u, u);
          fused::scaled(0.5f, u, u);
        }),
        Contains("fused::ease + fused::others::ease + fused::where + fused::scaled: in one pass, 32768 "
                 "bytes instead of 131072"));
    CHECK_THAT(planOf([&] {
                 fused::ease(u, v);
                 fused::spread(v, u, w);
               }),
               Contains("fused::spread: by itself, since 'u' reads more than its own element"));
    CHECK_THAT(planOf([&] {
                 fused::faded(bytes, bytes);
                 fused::faded(bytes, bytes);
               }),
               Contains("fused::faded: by itself, since 'x' reads what its stream has rounded"));
    CHECK_THAT(planOf([&] {
                 fused::ease(u, v);
                 fused::ease.with({.contraction = sk::Contraction::Fast})(v, w);
               }),
               Contains("by itself, since it has other options"));
    CHECK_THAT(planOf([&] {
                 fused::ease(u, v);
                 fused::ease.with({.box = {{1, 1}, {9, 9}}})(v, w);
               }),
               Contains("by itself, since it computes a box of its domain"));
  }
}

TEST_CASE("a pass reads and writes each stream once") {
  for (const char* const profile : {"glsl330", "glsl430"}) {
    sk::Device& device = run_tests::device(profile);
    const sk::Shape shape{64, 64};
    auto u = device.stream<float>(shape), v = device.stream<float>(shape);
    u.fill(0.5f);
    sk::Loop loop = device.record([&] {
      fused::ease(u, v);
      fused::mix(0.5f, u, v, v);
      fused::others::ease(v, u);
    });
    loop.repeat(4);
    device.countPasses(true);
    loop.repeat(3);
    const sk::PassCount count = device.passCount();
    device.countPasses(false);
    CHECK(count.passes == 3);
    CHECK(count.bytesRead == 3 * 64 * 64 * 4);
    CHECK(count.bytesWritten == 3 * 2 * 64 * 64 * 4);
  }
}

/// Without SK_LOOP_TILES, which this program does not get.
TEST_CASE(
    "the first iterations of a loop find out whether tiles are faster, and leave the bits of its calls") {
  sk::Device& device = run_tests::device("glsl430");
  const sk::Shape shape{256, 256};
  auto u = device.stream<float>(shape), v = device.stream<float>(shape);
  auto a = device.stream<float>(shape), b = device.stream<float>(shape);
  for (auto* stream : {&u, &a}) stream->write(drawn(shape.size(), 3));
  const auto record = [&] {
    return device.record([&] {
      fused::smooth(a, b);
      std::swap(a, b);
    });
  };
  sk::Loop loop = record();
  const auto isDecided = [](const std::string& plan) {
    return plan.find("iterations at once") != std::string::npos ||
           plan.find("no tiles of several iterations: they take") != std::string::npos;
  };
  if (!isDecided(loop.plan())) {  // no earlier process has tried
    CHECK_THAT(loop.plan(),
               Contains("fused::smooth: the first iterations find out whether tiles of several are faster"));
  }
  for (const int times : {5, 99, 12, 13, 150, 99}) {
    for (int i = 0; i < times; ++i) {
      fused::smooth(u, v);
      std::swap(u, v);
    }
    loop.repeat(times);
    REQUIRE(haveSameBits(a.read(), u.read()));
    REQUIRE(haveSameBits(b.read(), v.read()));
  }
  CHECK(isDecided(loop.plan()));
  CHECK(isDecided(record().plan()));  // without another trial
}

}  // namespace
}  // namespace run_tests
