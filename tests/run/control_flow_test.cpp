// SPDX-License-Identifier: MIT
//
// Control flow against the C++ compiler's reading of the same text.
#include "control_flow.sk.hpp"
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"   // that names may be shadowed is part of what is tested
#include "shared/control_flow.hpp"
#pragma GCC diagnostic pop
#include "support/devices.hpp"
#include "support/shared_cases.hpp"

using namespace run_tests;

TEST_CASE("control flow means what it means in C++") {
  const Samples<int> samples = pairsOf(-6, 21);
  onEveryProfile([&](sk::Device& device) {
    SharedCases<int, int> cases(device, samples);
#define CHECK_CASE(name) cases.check(#name, control::run_##name, control::name);
    CONTROL_FLOW_CASES(CHECK_CASE)
  });
}

TEST_CASE("a kernel may return early, and its outputs are variables until then") {
  std::vector<int> x;
  for (int i = -3; i < 20; ++i) x.push_back(i);
  const auto count = static_cast<std::int64_t>(x.size());
  onEveryProfile([&](sk::Device& device) {
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
