// SPDX-License-Identifier: MIT
//
// Promises: scalars compute what the same numbers in C++ give, of the values that they had when the operation was asked
// for; they go wherever a result or a uniform does; and a loop repeats what is done with them.
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "scalars.sk.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "support/streams.hpp"

namespace run_tests {
namespace {

using Catch::Matchers::Contains;

constexpr float infinity = std::numeric_limits<float>::infinity();
const float nan = std::nanf("");

bool isSame(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// GPUs round roots to some 2 units in the last place.
bool isClose(float a, float b) { return isSame(a, b) || std::abs(a - b) <= 4e-7f * std::abs(b); }

TEST_CASE("operations with floats") {
  onEveryTarget([](sk::Device& device) {
    for (const auto& [x, y] :
         {std::pair{6.0f, 1.5f}, {-2.0f, 8.0f}, {0.0f, 0.0f}, {1.0f, infinity}, {3.0f, nan}}) {
      INFO(x << " and " << y);
      const auto a = device.scalar<float>(x), b = device.scalar<float>(y);
      CHECK(isSame((a + b).read(), x + y));
      CHECK(isSame((a - b).read(), x - y));
      CHECK(isSame((a * b).read(), x * y));
      CHECK(isSame((a / b).read(), x / y));
      CHECK(isSame(min(a, b).read(), std::fmin(x, y)));
      CHECK(isSame(sk::max(a, b).read(), std::fmax(x, y)));
      CHECK((a < b).read() == (x < y));
      CHECK((a <= b).read() == (x <= y));
      CHECK((a > b).read() == (x > y));
      CHECK((a >= b).read() == (x >= y));
      CHECK((a == b).read() == (x == y));
      CHECK((a != b).read() == (x != y));
      CHECK(isClose(sqrt(a).read(), std::sqrt(x)));
      CHECK(isSame(abs(a).read(), std::abs(x)));
      CHECK(isSame((-a).read(), -x));
      CHECK(isSame(sk::select(a < b, b, a).read() + 1, (x < y ? y : x) + 1));
      CHECK(isSame(sk::select(a < b, 1, b).read(), x < y ? 1 : y));
      CHECK(sk::select(a < b || a == b, 1.0f, 2.0f).read() == (x < y || x == y ? 1 : 2));
      CHECK((!(a < b) && a == a).read() == (!(x < y) && x == x));
      CHECK(isSame((2 - a / 4).read(), 2 - x / 4));
      CHECK(isSame(max(2, a).read(), std::fmax(2.0f, x)));
    }
  });
}

TEST_CASE("operations with floats are carried out as they are written") {
  onEveryTarget([](sk::Device& device) {
    const float x = 4097.1F, y = -7.3F;
    const auto a = device.scalar<float>(x), b = device.scalar<float>(y), c = device.scalar<float>(infinity);
    CHECK(((a + b) - a).read() == (x + y) - x);
    CHECK((a * 0.1F * 10.0F - a).read() == x * 0.1F * 10.0F - x);
    CHECK((1.0F / (a - a)).read() == infinity);
    CHECK(std::isnan((c - c).read()));
    CHECK(std::isnan((c / c).read()));
    if (device.isSoftware() || device.name() == "native") {  // GPUs round quotients and roots otherwise
      CHECK((1.0F / (1.0F / b)).read() == 1.0F / (1.0F / y));
      CHECK((sqrt(a) * sqrt(a)).read() == std::sqrt(x) * std::sqrt(x));
    }
  });
}

TEST_CASE("comparisons and roots at the extremes") {
  onEveryTarget([](sk::Device& device) {
    const auto one = device.scalar<float>(1), none = device.scalar<float>(nan);
    const auto zero = device.scalar<float>(0), minus = device.scalar<float>(-0.0f);
    CHECK((!(none < one) && !(none >= one) && !(none == none) && none != none).read());
    CHECK((!(one < none) && !(one > none)).read());
    CHECK((zero == minus && !(minus < zero) && minus <= zero).read());
    CHECK((-infinity < minus && -one < zero && -one < one && zero < infinity).read());
    CHECK(isSame(sk::select(none == none, one, none).read(), nan));
    CHECK(isSame((one / zero).read(), infinity));
    CHECK(isSame((one / minus).read(), -infinity));
    CHECK(isSame(sqrt(-one).read(), nan));
    CHECK(isSame(sk::min(none, none).read(), nan));
    const auto whole = device.scalar<double>(1), lost = device.scalar<double>(std::nan(""));
    CHECK((!(lost < whole) && !(lost >= whole) && lost != lost && !(whole < lost)).read());
    CHECK((whole / (whole - 1) > 1e30).read());  // doubles of pairs have the range of floats
  });
}

TEST_CASE("scalars that are assigned to themselves, moved, and computed from themselves") {
  onEveryTarget([](sk::Device& device) {
    auto a = device.scalar<float>(3);
    a.assign(a);
    a += a;
    a -= 1;
    a *= a;
    a /= 5;
    CHECK(a.read() == 5);
    a = 7;  // a number keeps the place, too
    sk::Loop loop = device.record([&] {
      a = a + 1;
      a = a * 2.0;
    });
    loop.repeat(2);
    CHECK(a.read() == 34);
    a = 5;
    sk::Scalar<float> b = a + 1, c = std::move(b);
    CHECK_THAT(errorOf([&] { static_cast<void>(b + 1); }), Contains("holds no value"));
    b = c * 2;
    std::swap(a, b);
    CHECK(a.read() == 12);
    CHECK(b.read() == 5);
    sk::Scalar<float> doubled = a + 0;
    {
      const auto gone = device.scalar<float>(2);
      doubled = gone * 1;
      for (int i = 0; i < 50; ++i) doubled = doubled + doubled;  // in no more time than 50 additions take
    }
    CHECK(doubled.read() == std::ldexp(2.0f, 50));
    auto older = device.scalar<int>(0), newer = device.scalar<int>(1), count = device.scalar<int>(0);
    auto done = device.scalar<bool>();
    sk::Loop fibonacci = device.record([&] {
      older += newer;
      std::swap(older, newer);
      count += 1;
      done = count >= 12;
    });
    CHECK(fibonacci.until(done, {.every = 3}) == 12);
    CHECK(newer.read() == 233);
    fibonacci.repeat(3);
    CHECK(newer.read() == 987);
  });
}

TEST_CASE("operations with doubles and integers") {
  onEveryTarget([](sk::Device& device) {
    const auto third = device.scalar<double>(1.0 / 3);
    CHECK((third * 3 - 1e-9).read() == Approx(1 - 1e-9).epsilon(1e-13));
    CHECK(sqrt(third * third).read() == Approx(1.0 / 3).epsilon(1e-13));
    CHECK(max(min(third, 0.25), -third).read() == 0.25);
    CHECK((third < 0.34 && third > 0.33).read());
    constexpr int least = std::numeric_limits<int>::min();
    const auto seven = device.scalar<int>(-7), zero = device.scalar<int>(0);
    CHECK((seven / 2).read() == -3);
    CHECK((seven / zero).read() == -7);
    CHECK((device.scalar<int>(least) / -1).read() == least);
    CHECK((abs(seven) * 3 - 1).read() == 20);
    CHECK((device.scalar<int>(least) - 1).read() == std::numeric_limits<int>::max());
    const auto big = device.scalar<unsigned>(4000000000u);
    CHECK((big / 3u).read() == 1333333333u);
    CHECK((big + big).read() == 3705032704u);
    CHECK((big > 5u).read());
    CHECK(min(big, 5u).read() == 5u);
  });
  sk::Device reference = sk::Device::reference();
  auto tenth = reference.scalar<float>();
  scalars::weighted(1.0f, streamOf<float>(reference, {1, 3}), tenth);
  const sk::Scalar<float> third = 1 / (tenth - 1);
  CHECK(sk::View<float>(third.region()).readReals()[0] == 1.0 / 3);
}

TEST_CASE(
    "doubles as pairs of floats are refused in operations, too, where the compiler simplifies their errors") {
  sk::Device device({.device = "software", .profile = "glsl330", .doubles = "pairs", .barrier = "none"});
  auto third = device.scalar<double>(1.0 / 3);
  const auto half = device.scalar<float>(0.5F);
  CHECK((half + 1.0F).read() == 1.5F);
  CHECK_THAT(errorOf([&] { static_cast<void>((third * 3).read()); }),
             Contains("scalars: it computes with pairs of floats, and the compiler of"));
  CHECK((half + 1.0F).read() == 1.5F);
  CHECK(third.read() == Approx(1.0 / 3));
}

TEST_CASE("an operation uses the values of its time") {
  onEveryTarget([](sk::Device& device) {
    auto a = device.scalar<float>(3), b = device.scalar<float>(4);
    sk::Scalar<float> sum = a + b, product = a * b;
    a.assign(b);
    b.assign(100);
    CHECK(sum.read() == 7);
    CHECK(product.read() == 12);
    CHECK(a.read() == 4);
    CHECK(b.read() == 100);
    sk::Scalar<float> quotient = b / a;
    scalars::weighted(1.0f, streamOf<float>(device, {1, 2, 3}), a);
    CHECK(a.read() == 6);
    CHECK(quotient.read() == 25);
    {
      const auto gone = device.scalar<float>(9);
      quotient = gone + a;
    }
    CHECK(quotient.read() == 15);
    a = a * a;  // keeps its place
    a = a - 1;
    std::swap(a, b);
    CHECK(a.read() == 100);
    CHECK(b.read() == 35);
    std::vector<sk::Scalar<float>> many;
    for (int i = 0; i < 30; ++i) many.push_back(i == 0 ? b + 1 : many.back() + b);
    for (int i = 0; i < 30; ++i)
      CHECK(many[static_cast<std::size_t>(i)].read() == static_cast<float>(35 * (i + 1) + 1));
    sk::Scalar<float> power = b + 0;
    for (int i = 0; i < 1000; ++i) power = power + 1;
    CHECK(power.read() == 1035);
    std::vector<sk::Scalar<float>> ring;
    for (int i = 0; i < 7; ++i) ring.push_back(device.scalar<float>(static_cast<float>(i)));
    const sk::Scalar<float> first = ring[0] + 0;
    for (std::size_t i = 0; i < 6; ++i) ring[i].assign(ring[i + 1]);
    ring[6].assign(first);
    for (std::size_t i = 0; i < 7; ++i) CHECK(ring[i].read() == static_cast<float>((i + 1) % 7));
  });
}

TEST_CASE("scalars are results and uniforms") {
  onEveryTarget([](sk::Device& device) {
    const auto x = streamOf<float>(device, {1, 2, 3, 4});
    auto y = device.stream<float>({4});
    auto total = device.scalar<float>();
    scalars::weighted(1.0f, x, total);
    scalars::scale(1 / total, x, y);
    CHECK(y.read()[3] == 0.4f);
    scalars::weighted(total, x, total);
    CHECK(total.read() == 100);
    auto line = device.scalar<scalars::Line>(scalars::Line{2, {1, 0}, 0.5});
    auto other = device.scalar<scalars::Line>();
    other.assign(line);
    CHECK(other.read().bias == 0.5);
    auto doubles = device.stream<double>({4});
    scalars::line(other, x, doubles);
    CHECK(doubles.read()[1] == 5.5);
  });
}

TEST_CASE("a loop repeats operations with scalars") {
  onEveryTarget([](sk::Device& device) {
    auto x = streamOf<float>(device, {1, 2, 3, 2});
    auto old = device.scalar<float>(1), now = device.scalar<float>(), ratio = device.scalar<float>();
    auto done = device.scalar<bool>();
    sk::Loop loop = device.record([&] {
      scalars::weighted(1.0f, x, now);
      const sk::Scalar<float> factor = 2 * old / now;
      scalars::scale(factor, x, x);
      ratio.assign(now / old);
      std::swap(old, now);
      done = ratio < 3;
    });
    CHECK(old.read() == 1);
    float first = 1, second = 0, quotient = 0;
    std::vector<float> values = {1, 2, 3, 2};
    std::int64_t iterations = 0;
    do {
      second = values[0] + values[1] + values[2] + values[3];
      for (float& value : values) value = 2 * first / second * value;
      quotient = second / first;
      std::swap(first, second);
      ++iterations;
    } while (!(quotient < 3) && iterations < 50);
    CHECK(loop.until(done, {.every = 1, .most = 50}) == iterations);
    CHECK(ratio.read() == quotient);
    CHECK(old.read() == first);
    CHECK(x.read() == values);
  });
}

TEST_CASE("a loop swaps scalars that have just been computed") {
  onEveryTarget([](sk::Device& device) {
    auto a = device.scalar<float>(1);
    sk::Scalar<float> b = a + 1;  // computed when the device begins to record
    sk::Loop loop = device.record([&] {
      a += 10;
      std::swap(a, b);
    });
    CHECK(a.read() == 1);
    CHECK(b.read() == 2);
    loop.repeat(3);
    CHECK(a.read() == 12);
    CHECK(b.read() == 21);
  });
}

TEST_CASE("a recording that is given up has swapped and computed no scalars") {
  onEveryTarget([](sk::Device& device) {
    auto a = device.scalar<float>(1), x = device.scalar<float>(5);
    sk::Scalar<float> b = a + 1, none;
    const auto giveUp = [&](auto&& calls) {
      const auto record = [&] {
        device.record([&] {
          calls();
          throw std::runtime_error("no more");
        });
      };
      CHECK_THROWS_AS(record(), std::runtime_error);
      CHECK(a.read() == 1);
      CHECK(b.read() == 2);
      CHECK(x.read() == 5);
    };
    giveUp([&] { std::swap(a, b); });
    giveUp([&] {
      a += 10;
      std::swap(a, b);
      std::swap(x, b);
    });
    giveUp([&] {
      sk::Scalar<float> c = a * 3;
      std::swap(a, c);
    });
    giveUp([&] {
      sk::Scalar<float> c = a * 3;
      scalars::weighted(c, x, x);  // carries out what has been computed
      std::swap(a, c);
      none = a + b;
      static_cast<void>(none.region());
    });
    CHECK_THAT(errorOf([&] { static_cast<void>(none.read()); }), Contains("lost"));
    a = b + x;
    CHECK(a.read() == 7);
  });
}

TEST_CASE("mistakes with scalars are refused") {
  sk::Device device = sk::Device::native(), other = sk::Device::native();
  auto a = device.scalar<float>(1), b = other.scalar<float>(2);
  CHECK_THAT(errorOf([&] { static_cast<void>(a + b); }), Contains("two devices"));
  CHECK_THAT(errorOf([&] { a.assign(b); }), Contains("another device"));
  CHECK(a.read() == 1);
  sk::Scalar<float> none;
  CHECK_THAT(errorOf([&] { static_cast<void>(none + a); }), Contains("holds no value"));
  CHECK_THAT(errorOf([&] { static_cast<void>(none.read()); }), Contains("no stream"));
  CHECK_THAT(errorOf([&] { none.assign(a); }), Contains("holds no value"));
  sk::Scalar<float> orphan, pending;
  {
    sk::Device brief = sk::Device::native();
    orphan = brief.scalar<float>(1);
    pending = orphan + 1;
  }
  CHECK_THAT(errorOf([&] { static_cast<void>(orphan + 1); }), Contains("device has been destroyed"));
  CHECK_THAT(errorOf([&] { static_cast<void>(orphan.read()); }), Contains("device"));
  CHECK_THAT(errorOf([&] { static_cast<void>(pending.read()); }), Contains("device has been destroyed"));
  CHECK_THAT(errorOf([&] { static_cast<void>(device.record([&] { static_cast<void>((a + 1).read()); })); }),
             Contains("record"));
  CHECK((a + 1).read() == 2);
}

}  // namespace
}  // namespace run_tests
