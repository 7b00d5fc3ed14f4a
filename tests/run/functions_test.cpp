// SPDX-License-Identifier: MIT
//
// Compares helper functions and names with the same text compiled as C++.
#include "functions.sk.hpp"
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wparentheses"
#include "shared/functions.hpp"
#pragma GCC diagnostic pop
#include "support/shared_cases.hpp"

using namespace run_tests;

TEST_CASE("helper functions, templates, constants and names are those of C++") {
  const Samples<int> samples = pairsOf(-6, 12);
  onGlAndNative([&](sk::Device& device) {
    SharedCases<int, int> cases(device, samples);
#define CHECK_CASE(name) cases.check(#name, functions::run_##name, functions::name);
    FUNCTION_CASES(CHECK_CASE)
  });
}
#undef CHECK_CASE
