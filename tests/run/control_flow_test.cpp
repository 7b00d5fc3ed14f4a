// SPDX-License-Identifier: MIT
//
// Compares control flow with the same text compiled as C++.
#include "control_flow.sk.hpp"

#include <algorithm>
#include <limits>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"   // shadowing is part of the test
#include "shared/control_flow.hpp"
#pragma GCC diagnostic pop
#include "support/devices.hpp"
#include "support/shared_cases.hpp"

using namespace run_tests;

TEST_CASE("control flow means what it means in C++") {
  const Samples<int> samples = pairsOf(-6, 21);
  onGlAndNative([&](sk::Device& device) {
    SharedCases<int, int> cases(device, samples);
#define CHECK_CASE(name) cases.check(#name, control::run_##name, control::name);
    CONTROL_FLOW_CASES(CHECK_CASE)
  });
}

TEST_CASE("a kernel may return early, and its outputs are variables until then") {
  std::vector<int> x;
  for (int i = -3; i < 20; ++i) x.push_back(i);
  const auto count = static_cast<std::int64_t>(x.size());
  onGlAndNative([&](sk::Device& device) {
    const auto input = streamOf<int>(device, x);
    auto a = device.stream<int>({count});
    auto b = device.stream<int>({count});
    control::earlyExit(input, a, b);
    CHECK(difference(a.read(), [&](std::size_t i) { return x[i] < 0 ? 1 : x[i] < 8 ? x[i] : 100; }) == "");
    CHECK(difference(b.read(), [&](std::size_t i) {
            const int last = std::min(x[i], 7);
            return x[i] < 0 ? 2 : 2 + last * (last + 1) / 2;
          }) == "");

    control::outputsAsVariables(input, a, b);
    std::vector<int> low, high;
    for (int l : x) {
      int h = l;
      for (int i = 0; i < 3; ++i) {
        l = l * 2 - i;
        if (l > h) h = l;
      }
      h -= l++;
      l += h--;
      low.push_back(l);
      high.push_back(h);
    }
    CHECK(difference(a.read(), low) == "");
    CHECK(difference(b.read(), high) == "");
  });
}

TEST_CASE("an index outside an array takes the nearest element") {
  const int most = std::numeric_limits<int>::max(), least = std::numeric_limits<int>::min();
  const std::vector<int> x = {0, 1, 2, 3, 4, 5, 100, most, -1, -2, least};
  const auto count = static_cast<std::int64_t>(x.size());
  onGlAndNative([&](sk::Device& device) {
    auto written = device.stream<int>({count}), read = device.stream<int>({count});
    control::nearestElement(streamOf<int>(device, x), written, read);
    CHECK(difference(read.read(), [&](std::size_t i) {
            const int atUint = x[i] < 0 ? 4 : std::min(x[i], 4);   // as uint, -1 is beyond the end
            return (10 + std::clamp(x[i], 0, 4)) * 100 + 10 + atUint;
          }) == "");
    CHECK(difference(written.read(), [&](std::size_t i) {
            int own[3] = {1, 2, 3};
            own[std::clamp(x[i], 0, 2)] = 7;
            return own[0] * 100 + own[1] * 10 + own[2];
          }) == "");
  });
}
#undef CHECK_CASE
