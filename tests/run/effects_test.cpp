// SPDX-License-Identifier: MIT
//
// Compares expressions with side effects with the same text compiled as C++.
#include "effects.sk.hpp"
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wsequence-point"   // C++17 defines the orders that g++ warns about
#include "shared/effects.hpp"
#pragma GCC diagnostic pop
#include "support/shared_cases.hpp"

using namespace run_tests;

TEST_CASE("effects in expressions happen when and as often as in C++") {
  const Samples<int> samples = pairsOf(-6, 9);
  onGlAndNative([&](sk::Device& device) {
    SharedCases<int, int> cases(device, samples);
#define CHECK_CASE(name) cases.check(#name, effects::run_##name, effects::name);
    EFFECTS_CASES(CHECK_CASE)
  });
}
#undef CHECK_CASE
