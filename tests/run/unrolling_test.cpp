// SPDX-License-Identifier: MIT
//
// unrolling.sk: unrolling loops and recognizing neighbors changes no bit, for every boundary mode and shape. The expected results
// come from loops that stay loops because their bounds are arguments.
#include <algorithm>

#include "support/devices.hpp"
#include "support/values.hpp"
#include "unrolling.sk.hpp"

using namespace run_tests;
using sk::int4;

TEST_CASE("an unrolled blur has the bits of its loop") {
  for (const sk::Shape shape : {sk::Shape{13, 24}, sk::Shape{5, 7}}) {
    const std::vector<float> x = values<float>(shape.size());
    onGlAndNative([&](sk::Device& device) {
      auto a = device.stream<float>(shape), r = device.stream<float>(shape), s = device.stream<float>(shape);
      a.write(x);
      unrolling::unrolled_2(a, r);
      unrolling::rolled(2, a, s);
      CHECK(r.read() == s.read());
    });
  }
}

TEST_CASE("loops that a specialisation constant bounds have the bits of loops with arguments") {
  const std::vector<float> x = values<float>(11 * 24);
  onGlAndNative([&](sk::Device& device) {
    auto a = device.stream<float>({11, 24}), r = device.stream<float>({11, 24}),
         s = device.stream<float>({11, 24});
    a.write(x);
    for (const int radius : {-1, 0, 1, 2, 3, 9}) {
      INFO("radius " << radius);
      unrolling::bySpec(radius, a, r);
      unrolling::byUniform(radius, a, s);
      CHECK(r.read() == s.read());
    }
    auto line = streamOf<float>(device, x);
    auto t = device.stream<float>({11 * 24}), u = device.stream<float>({11 * 24});
    for (const unsigned taps : {0u, 5u, 8u, 9u}) {
      INFO("taps " << taps);
      unrolling::sumsByUniform(true, taps, line, line, u);
      unrolling::sums(true, taps, line, line, t);
      CHECK(t.read() == u.read());
      unrolling::sumsByUniform(false, taps, line, line, u);
      unrolling::sums(false, taps, sk::none, line, t);
      CHECK(t.read() == u.read());
    }
    sk::Loop loop = device.record([&] { unrolling::bySpec(1, a, r); });
    loop.repeat(2);
    unrolling::byUniform(1, a, s);
    CHECK(r.read() == s.read());
  });
}

TEST_CASE(
    "an index that is a neighbor's means the same for every boundary, and beside every shape of the gather") {
  for (const sk::Shape shape : {sk::Shape{9, 12}, sk::Shape{4, 5}, sk::Shape{20, 31}}) {
    const std::vector<int> x = values<int>(shape.size());
    onSomeLayouts([&](sk::Device& device) {
      auto a = device.stream<int>(shape);
      auto r = device.stream<int4>({9, 12}), s = device.stream<int4>({9, 12});
      a.write(x);
      unrolling::indices(a, a, a, a, r);
      unrolling::hidden(1, a, a, a, a, s);
      CHECK(r.read() == s.read());
    });
  }
}

TEST_CASE("iterations that are left early leave what they should") {
  const std::vector<float> x = values<float>(101);
  onGlAndNative([&](sk::Device& device) {
    auto a = streamOf<float>(device, x);
    auto r = device.stream<float>({101}), s = device.stream<float>({101});
    unrolling::leaving(a, r);
    unrolling::leavingSlowly(9, a, s);
    CHECK(r.read() == s.read());
  });
}

TEST_CASE("elements of local arrays keep their numbers") {
  const std::vector<float> x = values<float>(50);
  onGlAndNative([&](sk::Device& device) {
    auto r = device.stream<float>({50});
    unrolling::median(streamOf<float>(device, x), r);
    CHECK(difference(r.read(), [&](std::size_t i) {
            std::vector<float> v;
            for (int d = -2; d <= 2; ++d) {
              v.push_back(x[static_cast<std::size_t>(std::clamp(static_cast<int>(i) + d, 0, 49))]);
            }
            std::sort(v.begin(), v.end());
            return v[2];
          }) == "");
  });
}
