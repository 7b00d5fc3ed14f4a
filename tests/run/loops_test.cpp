// SPDX-License-Identifier: MIT
//
// Promises: a loop does what its calls would do one after the other, with the same bits; streams that are swapped in it
// are swapped in each iteration; it ends where its condition says; and what cannot be repeated is refused.
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "loops.sk.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "support/streams.hpp"

namespace run_tests {
namespace {

using Catch::Matchers::Contains;

std::vector<float> wave(int count) {
  std::vector<float> x;
  for (int i = 0; i < count; ++i) x.push_back(static_cast<float>((i * 37) % 11));
  return x;
}

TEST_CASE("a loop swaps the streams that its calls swap") {
  onEveryTarget([](sk::Device& device) {
    for (const int times : {0, 1, 2, 7}) {
      INFO(times << " iterations");
      auto u = streamOf(device, wave(101)), v = streamOf(device, wave(101));
      for (int i = 0; i < times; ++i) {
        loops::smooth(u, v);
        std::swap(u, v);
      }
      auto a = streamOf(device, wave(101)), b = streamOf(device, wave(101));
      sk::Loop loop = device.record([&] {
        loops::smooth(a, b);
        std::swap(a, b);
      });
      CHECK(a.read() == wave(101));
      loop.repeat(times);
      CHECK(a.read() == u.read());
      CHECK(b.read() == v.read());
    }
  });
}

TEST_CASE("calls before and after a swap, and on views, use the streams that they name then") {
  onEveryTarget([](sk::Device& device) {
    auto u = streamOf(device, wave(16)), v = streamOf(device, wave(16));
    auto a = streamOf(device, wave(16)), b = streamOf(device, wave(16));
    const auto calls = [](auto& from, auto& to) {
      loops::smooth(from, to);
      std::swap(from, to);
      loops::add(2, from, to);
      loops::add(3, to.domain({4}, {9}), from.domain({5}, {10}));
      to.domain({0}, {2}).fill(7);
    };
    for (int i = 0; i < 5; ++i) calls(u, v);
    sk::Loop loop = device.record([&] { calls(a, b); });
    loop.repeat(5);
    CHECK(a.read() == u.read());
    CHECK(b.read() == v.read());
  });
}

TEST_CASE("a loop rotates three streams") {
  onEveryTarget([](sk::Device& device) {
    const auto rotate = [](auto& a, auto& b, auto& c) {
      std::swap(a, b);
      std::swap(b, c);
    };
    std::vector<sk::Stream<float>> one, other;
    for (int i = 0; i < 3; ++i) {
      one.push_back(streamOf(device, wave(10)));
      other.push_back(streamOf(device, wave(10)));
    }
    for (int i = 0; i < 5; ++i) {
      loops::add(1, one[0], one[1]);
      loops::add(10, one[1], one[2]);
      rotate(one[0], one[1], one[2]);
    }
    sk::Loop loop = device.record([&] {
      loops::add(1, other[0], other[1]);
      loops::add(10, other[1], other[2]);
      rotate(other[0], other[1], other[2]);
    });
    loop.repeat(2);
    loop.repeat(3);
    for (std::size_t i = 0; i < 3; ++i) CHECK(other[i].read() == one[i].read());
  });
}

TEST_CASE("a loop repeats every kind of call") {
  onEveryTarget([](sk::Device& device) {
    auto x = streamOf<float>(device, {1, 2, 3, 4}), kept = streamOf<float>(device, {0, 0, 0, 0});
    auto sum = device.stream<float>({1});
    auto n = streamOf<int>(device, {1, 1, 2, 3});
    auto bins = streamOf<int>(device, {0, 0, 0, 0});
    auto ones = device.stream<int>({3});
    float c = 1;
    sk::Loop loop = device.record([&] {
      loops::add(c, x, x);
      loops::total(x, sum);
      x.copyTo(kept);
      ones.fill(1);
      loops::running(ones, ones);
      loops::count(n, bins);
    });
    c = 100;  // is read when the call is recorded
    CHECK(x.read() == std::vector<float>{1, 2, 3, 4});
    loop.repeat(3);
    CHECK(x.read() == std::vector<float>{4, 5, 6, 7});
    CHECK(kept.read() == x.read());
    CHECK(sum.read() == std::vector<float>{22});
    CHECK(ones.read() == std::vector<int>{1, 2, 3});
    CHECK(bins.read() == std::vector<int>{0, 6, 3, 3});
    x.write(std::vector<float>{0, 0, 0, 0});  // between two runs of a loop, everything is allowed
    loop.repeat(1);
    CHECK(sum.read() == std::vector<float>{4});
  });
}

TEST_CASE("a loop ends after the iteration that makes its condition true") {
  onEveryTarget([](sk::Device& device) {
    auto x = streamOf<float>(device, {0, 0});
    auto sum = device.stream<float>({1});
    auto done = device.stream<bool>({1});
    sk::Loop loop = device.record([&] {
      loops::add(1, x, x);
      loops::total(x, sum);
      loops::reached(sum, 20, done);
    });
    const std::int64_t ran = loop.until(done, {.every = 4});
    CHECK((ran == 10 || (ran == 12 && device.profile() == "essl300")));  // the host may have to ask
    CHECK(x.read().front() == static_cast<float>(ran));
    CHECK(loop.until(done, {.every = 1}) == 1);
    x.fill(0);
    CHECK(loop.until(done, {.every = 1}) == 10);
    x.fill(0);
    CHECK(loop.until(done, {.every = 4, .most = 7}) == 7);
    CHECK(x.read().front() == 7);
    CHECK(loop.until(done, {.most = 0}) == 0);
  });
}

TEST_CASE("a loop keeps the streams of its calls") {
  onEveryTarget([](sk::Device& device) {
    auto result = streamOf<float>(device, {0, 0, 0});
    std::optional<sk::Loop> loop, second;
    {
      auto input = streamOf<float>(device, {1, 2, 3});
      loop = device.record([&] {
        auto between = device.stream<float>({3});
        loops::add(1, input, between);
        loops::add(1, between, result);
      });
      second = device.record([&] { loops::add(5, input, result); });
    }
    loop->repeat(2);
    CHECK(result.read() == std::vector<float>{3, 4, 5});
    loop.reset();
    second->repeat(1);
    CHECK(result.read() == std::vector<float>{6, 7, 8});
  });
}

TEST_CASE("what a loop cannot repeat is refused, and the device goes on") {
  onEveryTarget([](sk::Device& device) {
    auto x = streamOf<float>(device, {1, 2, 3}), longer = device.stream<float>({4});
    auto n = streamOf<int>(device, {1, 2, 3}), pushed = device.stream<int>({3});
    const auto refusal = [&](auto&& calls) { return errorOf([&] { device.record(calls); }); };
    CHECK_THAT(refusal([&] { x.read(); }), Contains("read: the device is recording calls"));
    CHECK_THAT(refusal([&] { x.write(std::vector<float>{1, 2, 3}); }), Contains("write: the device is"));
    CHECK_THAT(refusal([&] { x.readReals(); }), Contains("readReals: the device is"));
    CHECK_THAT(refusal([&] { static_cast<void>(loops::total(x)); }), Contains("a stream of one element"));
    CHECK_THAT(refusal([&] { loops::evens(n, pushed); }), Contains("'y' is a variable output"));
    CHECK_THAT(refusal([&] { std::swap(x, longer); }), Contains("were swapped"));
    CHECK(x.shape() == sk::Shape{3});
    CHECK_THAT(refusal([&] { x = device.stream<float>({3}); }), Contains("std::swap(u, v)"));
    x = streamOf<float>(device, {1, 2, 3});
    CHECK_THAT(refusal([&] { loops::add(1, x, longer); }), Contains("add"));
    CHECK_THAT(refusal([&] { device.record([] {}); }), Contains("record: the device is recording"));
    sk::Loop loop = device.record([&] { loops::add(1, x, x); });
    CHECK_THAT(refusal([&] { loop.repeat(1); }), Contains("a loop: the device is recording"));
    CHECK_THAT(errorOf([&] { loop.repeat(-1); }), Contains("times is -1"));
    auto done = device.stream<bool>({2});
    CHECK_THAT(errorOf([&] { loop.until(done); }), Contains("has shape {2}"));
    auto never = device.scalar<bool>(false);
    CHECK_THAT(errorOf([&] { loop.until(never); }), Contains("no call of the loop writes the condition"));
    sk::Loop nothing;
    CHECK_THAT(errorOf([&] { nothing.repeat(1); }), Contains("device.record"));
    loop.repeat(2);
    CHECK(x.read() == std::vector<float>{3, 4, 5});
  });
}

TEST_CASE("a recording that is given up leaves nothing behind") {
  onEveryTarget([](sk::Device& device) {
    auto total = device.scalar<float>(3);
    auto made = device.scalar<float>(1);
    const auto giveUp = [&] {
      device.record([&] {
        total = total + 1;
        made = sk::Scalar<float>(total * 2);
        throw std::runtime_error("the application gives up");
      });
    };
    CHECK_THROWS_AS(giveUp(), std::runtime_error);
    total = total * 10;
    CHECK(total.read() == 30);
  });
}

TEST_CASE("a stream that ends while calls are recorded returns where the recording is refused") {
  onEveryTarget([](sk::Device& device) {
    auto u = streamOf(device, wave(101)), v = streamOf(device, wave(101)), w = streamOf(device, wave(101));
    const auto assign = [&] {
      device.record([&] {
        loops::smooth(v, w);
        u = std::move(v);  // ends the stream of u, which no call uses
        v = std::move(w);
      });
    };
    CHECK_THAT(errorOf(assign), Contains("another stream was assigned to a stream"));
    CHECK(u.read() == wave(101));
    loops::smooth(u, v);
    CHECK(v.read().size() == 101);
  });
}

TEST_CASE("a loop refuses a stream that has another shape, and a device that has ended") {
  std::optional<sk::Device> device(sk::Device::native());
  auto n = streamOf<int>(*device, {1, 2, 3}), even = device->stream<int>({3}),
       halves = device->stream<int>({3});
  sk::Loop loop = device->record([&] { loops::halve(even, halves); });
  loops::evens(n, even);
  CHECK_THAT(errorOf([&] { loop.repeat(1); }), Contains("a stream of shape {3} has shape {1} now"));
  sk::Device another = sk::Device::native();
  CHECK_THAT(errorOf([&] { another.record([&] { another = sk::Device::native(); }); }),
             Contains("its device has been destroyed"));
  device.reset();
  CHECK_THAT(errorOf([&] { loop.repeat(1); }), Contains("its device has been destroyed"));
}

TEST_CASE("a recording that is given up has swapped no streams") {
  sk::Device device;
  auto a = device.stream<float>({2}), b = device.stream<float>({2}), c = device.stream<float>({3});
  a.fill(1);
  b.fill(2);
  c.fill(3);
  CHECK_THROWS_AS(device.record([&] {
    std::swap(a, b);
    throw std::runtime_error("no more");
  }),
                  std::runtime_error);
  CHECK_THROWS_WITH(device.record([&] { std::swap(a, c); }), Contains("were swapped"));
  CHECK(a.read() == std::vector<float>{1, 1});
  CHECK(b.read() == std::vector<float>{2, 2});
  CHECK(c.read() == std::vector<float>{3, 3, 3});
}

/// Records calls that end with an exception.
template <class Calls>
void giveUp(sk::Device& device, Calls&& calls) {
  const auto record = [&] {
    device.record([&] {
      calls();
      throw std::runtime_error("no more");
    });
  };
  CHECK_THROWS_AS(record(), std::runtime_error);
}

TEST_CASE("a recording that is given up has moved and destroyed no streams") {
  onEveryTarget([](sk::Device& device) {
    auto a = streamOf<float>(device, {1}), b = streamOf<float>(device, {2});
    sk::Stream<float> other;
    const auto areAsBefore = [&] {
      CHECK(a.read() == std::vector<float>{1});
      CHECK(b.read() == std::vector<float>{2});
      CHECK(!other);
    };
    giveUp(device, [&] { other = std::move(a); });
    areAsBefore();
    giveUp(device, [&] {
      loops::add(1, a, b);
      other = std::move(a);
      a = std::move(b);
    });
    areAsBefore();
    giveUp(device, [&] { a = std::move(b); });
    areAsBefore();
    giveUp(device, [&] {
      loops::add(1, a, b);
      a = device.stream<float>({7});
      loops::add(1, b, b);
      std::swap(a, b);
    });
    areAsBefore();
    giveUp(device, [&] { const auto consumed = std::move(a); });
    areAsBefore();
    std::optional<sk::Stream<float>> ended = std::move(a);
    giveUp(device, [&] {
      a = std::move(*ended);
      ended.reset();
    });
    areAsBefore();
  });
}

TEST_CASE("a stream that is moved to a handle without one is refused, and returns") {
  onEveryTarget([](sk::Device& device) {
    auto a = streamOf<float>(device, {1}), b = streamOf<float>(device, {2});
    sk::Stream<float> other;
    const auto move = [&] {
      device.record([&] {
        loops::add(1, a, b);
        other = std::move(a);
      });
    };
    CHECK_THAT(errorOf(move), Contains("record: a stream was moved to another handle"));
    CHECK(a.read() == std::vector<float>{1});
    CHECK(!other);
    std::vector<sk::Stream<float>> grown;
    grown.push_back(std::move(a));
    sk::Loop loop = device.record([&] {  // other handles than before, and those do not exist any more
      for (int i = 0; i < 10; ++i) grown.push_back(device.stream<float>({1}));
      loops::add(1, grown[0], b);
      loops::add(1, b, grown[0]);
    });
    loop.repeat(3);
    CHECK(grown[0].read() == std::vector<float>{7});
    loop = device.record([&] {
      loops::add(1, b, b);
      const auto consumed = std::move(grown[0]);
    });
    loop.repeat(2);
    CHECK(!grown[0]);
    CHECK(b.read() == std::vector<float>{8});
  });
}

}  // namespace
}  // namespace run_tests
